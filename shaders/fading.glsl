// Discards pixels of a mesh that fades in or out. A mesh that fades in has `fade` in (0, 1), its
// share of pixels. The mesh that it replaces has the negative of that value and covers the other
// pixels. So together they cover each pixel once, in any order, without blending.
// The pattern moves over the picture, so none is seen to stand still. All that fades takes the pixels
// from the least noise on, and noise rises with time, slower than shares do (scene/meshes/fading.hpp):
// whether a share reaches the noise of a pixel or the noise starts again from 0, the pixel changes
// once in a fade, and never back.
#ifdef PSYGEN_FADING
#include "frame.glsl"
#include "dither.glsl"
layout(location = 4) flat in float fade;

void leave_out_faded() {
  float noise = ordered_noise(gl_FragCoord.xy, frame.morph.z);
  if (fade > 0.0 ? noise >= fade : noise < -fade) discard;
}
#else
void leave_out_faded() {}
#endif
