// The shadow of a textured object that fades or has holes: only its share of pixels, without those
// of too little opacity.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "fading.glsl"
#include "materials.glsl"

layout(location = 5) in vec2 uv;
layout(location = 6) flat in uint material_number;

void main() {
  leave_out_faded();
  MaterialData m = materials[material_number];
  if (m.base.a * texture(base_map, uv).a < m.emissive.w) discard;
}
