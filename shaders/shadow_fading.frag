// The shadow of a mesh that fades in or out: only its share of pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "fading.glsl"

void main() { leave_out_faded(); }
