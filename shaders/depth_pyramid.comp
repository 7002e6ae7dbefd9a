// Computes one level of the depth pyramid: each texel is the furthest of up to 2 x 2 source texels.
// Depth is reversed, so the furthest is the smallest.
#version 460
#ifdef PSYGEN_SAMPLES
#extension GL_ARB_shader_texture_image_samples : require
#endif

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant, std430) uniform Pushed { ivec2 source_size; };
#ifdef PSYGEN_FROM_DEPTH
layout(set = 0, binding = 0) uniform sampler2D source;
float at(ivec2 p) { return texelFetch(source, min(p, source_size - 1), 0).r; }
#elif defined(PSYGEN_SAMPLES)
layout(set = 0, binding = 0) uniform sampler2DMS source;
float at(ivec2 p) {
  float furthest = 1.0;
  for (int i = 0; i < textureSamples(source); ++i)
    furthest = min(furthest, texelFetch(source, min(p, source_size - 1), i).r);
  return furthest;
}
#else
layout(set = 0, binding = 0, r32f) uniform readonly image2D source;
float at(ivec2 p) { return imageLoad(source, min(p, source_size - 1)).r; }
#endif
layout(set = 0, binding = 1, r32f) uniform writeonly image2D target;

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(p, (source_size + 1) / 2))) return;
  ivec2 q = 2 * p;
  float furthest = min(min(at(q), at(q + ivec2(1, 0))), min(at(q + ivec2(0, 1)), at(q + 1)));
  imageStore(target, p, vec4(furthest));
}
