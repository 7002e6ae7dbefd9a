// Ordered noise of the pixel, 0 to 1. Neighbouring pixels have very different values, and the
// pixels below any threshold are spread evenly.
float ordered_noise() {
  return fract(dot(gl_FragCoord.xy, vec2(0.7548777, 0.5698403)));
}

// Noise of ± half a step of 8 bits, which hides banding.
float dither() {
  return (ordered_noise() - 0.5) * (1.0 / 255.0);
}
