// The shadow of a mesh that fades in or out: only its share of pixels. With PSYGEN_PICTURE, of
// pictures only what is opaque.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "fading.glsl"
#include "pictures.glsl"

void main() {
#ifdef PSYGEN_PICTURE
  if (picture().a < 0.5) discard;
#endif
  leave_out_faded();
}
