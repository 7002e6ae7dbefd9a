// Which pixels a mesh that comes or goes leaves out. One that comes has `fade` in (0, 1), the share
// of pixels it has; one that goes has −fade of what comes in its place, and just the others. So
// together they cover each pixel once, in any order, without blending.
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
