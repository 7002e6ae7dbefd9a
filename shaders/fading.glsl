// Discards pixels of a mesh that fades in or out. A mesh that fades in has `fade` in (0, 1), its
// share of pixels. The mesh that it replaces has the negative of that value and covers the other
// pixels. So together they cover each pixel once, in any order, without blending.
#ifdef PSYGEN_FADING
#include "dither.glsl"
layout(location = 4) flat in float fade;

void leave_out_faded() {
  float noise = ordered_noise();
  if (fade > 0.0 ? noise >= fade : noise < -fade) discard;
}
#else
void leave_out_faded() {}
#endif
