// The share of a mesh's shadow that is there while the mesh comes or goes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "fading.glsl"

void main() { leave_out_faded(); }
