// The data of a draw for vertex shaders. With one draw per call it is in push constants. This is
// fastest on software devices, where an indexed load is a loop over lanes. Otherwise it is in a
// buffer, indexed by the first instance plus the number of the draw within a multi-draw.
#ifdef PSYGEN_DRAW_PUSHED
layout(push_constant, std430) uniform Pushed {
  DrawData pushed;
  uint pushed_cascade;
};
DrawData this_draw() { return pushed; }
#else
layout(push_constant, std430) uniform Pushed {
  layout(offset = 64) uint pushed_cascade;
};
layout(set = 0, binding = PSYGEN_BINDING_DRAWS, std430) readonly buffer Draws { DrawData draws[]; };
DrawData this_draw() { return draws[gl_BaseInstance + gl_DrawID]; }
#endif

// The matrix from positions relative to the camera to clip space, of the picture or of a cascade.
mat4 clip_matrix() {
#ifdef PSYGEN_SHADOW
  return frame.shadow_from_camera[pushed_cascade];
#else
  return frame.clip_from_camera;
#endif
}

// The unit normal of an octahedral pair `e` in [-1, 1], with the pole at +Y (vertex_layout.hpp).
vec3 octahedral_normal(vec2 e) {
  vec3 n = vec3(e.x, 1.0 - abs(e.x) - abs(e.y), e.y);
  float fold = max(-n.y, 0.0);
  n.x += n.x >= 0.0 ? -fold : fold;
  n.z += n.z >= 0.0 ? -fold : fold;
  return n * inversesqrt(dot(n, n));
}
