// Ordered noise of the pixel, 0 to 1: neighbouring pixels have numbers far apart, and each share of
// them is spread evenly.
float ordered_noise() {
  return fract(dot(gl_FragCoord.xy, vec2(0.7548777, 0.5698403)));
}

// Half a step of it hides the bands of 8 bits.
float dither() {
  return (ordered_noise() - 0.5) * (1.0 / 255.0);
}
