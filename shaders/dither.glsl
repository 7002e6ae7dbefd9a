// Half a step of ordered noise hides the bands of 8 bits.
float dither() {
  return (fract(dot(gl_FragCoord.xy, vec2(0.7548777, 0.5698403))) - 0.5) * (1.0 / 255.0);
}
