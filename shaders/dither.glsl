// Ordered noise of a place, 0 to 1, risen by `phase`. Places one apart have very different values,
// and those below any threshold are spread evenly.
float ordered_noise(vec2 place, float phase) {
  return fract(dot(place, vec2(0.7548777, 0.5698403)) + phase);
}

// That of the pixel.
float ordered_noise() {
  return ordered_noise(gl_FragCoord.xy, 0.0);
}

// Noise of ± half a step of 8 bits, which hides banding.
float dither() {
  return (ordered_noise() - 0.5) * (1.0 / 255.0);
}
