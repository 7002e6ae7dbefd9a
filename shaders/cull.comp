// Selects the candidates of a frame to draw, and writes the commands of indirect draws. One thread
// per candidate. The test of the view is that of engine/render/meshes/view_volume.cpp, with the same
// operations in the same order, so both find the same.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "cull_shared.h"

layout(local_size_x = PSYGEN_CULL_THREADS) in;
layout(push_constant, std430) uniform Pushed { uint phase; };
layout(set = 0, binding = PSYGEN_CULL_FRAME, std140) uniform Frame { CullFrame frame; };
layout(set = 0, binding = PSYGEN_CULL_CANDIDATES, std430) readonly buffer Candidates { CullCandidate candidates[]; };
layout(set = 0, binding = PSYGEN_CULL_GROUPS, std430) readonly buffer Groups { uint first_commands[]; };
layout(set = 0, binding = PSYGEN_CULL_COMMANDS, std430) writeonly buffer Commands { uint commands[]; };
layout(set = 0, binding = PSYGEN_CULL_DRAWS, std430) writeonly buffer Draws { DrawData draws[]; };
// Number of draws of each group in the first phase, then in the second; then triangles of each
// phase.
layout(set = 0, binding = PSYGEN_CULL_COUNTS, std430) buffer Counts { uint counts[]; };
layout(set = 0, binding = PSYGEN_CULL_SEEN_BEFORE, std430) readonly buffer Before { uint before[]; };
layout(set = 0, binding = PSYGEN_CULL_SEEN_NOW, std430) buffer Now { uint now[]; };
layout(set = 0, binding = PSYGEN_CULL_PYRAMID) uniform sampler2D pyramid;

shared uint triangles;

bool in_view(vec3 least, vec3 greatest) {
  precise float slack = 1e-6 * (abs(least.x) + abs(least.y) + abs(least.z) + abs(greatest.x) +
                                abs(greatest.y) + abs(greatest.z));
  for (int i = 0; i < 5; ++i) {
    vec4 plane = frame.planes[i];
    float x = plane.x > 0.0 ? greatest.x : least.x;
    float y = plane.y > 0.0 ? greatest.y : least.y;
    float z = plane.z > 0.0 ? greatest.z : least.z;
    precise float inside = plane.x * x + plane.y * y + plane.z * z + plane.w;
    if (inside < -slack) return false;
  }
  return true;
}

// False only if the whole box lies behind the depth in the pyramid.
bool unhidden(vec3 least, vec3 greatest) {
  vec2 low = vec2(1e30), high = vec2(-1e30);
  float nearest = 0.0;
  for (int i = 0; i < 8; ++i) {
    vec3 corner = vec3((i & 1) != 0 ? greatest.x : least.x, (i & 2) != 0 ? greatest.y : least.y,
                       (i & 4) != 0 ? greatest.z : least.z);
    vec4 clip = frame.clip_from_camera * vec4(corner, 1.0);
    if (!(clip.w > frame.near.x)) return true;
    vec2 at = clip.xy / clip.w;
    low = min(low, at);
    high = max(high, at);
    nearest = max(nearest, clip.z / clip.w);
  }
  vec2 size = vec2(frame.picture.xy);
  // One more pixel on each side for rounding.
  ivec2 first = ivec2(clamp((low * 0.5 + 0.5) * size - 1.0, vec2(0.0), size - 1.0));
  ivec2 last = ivec2(clamp((high * 0.5 + 0.5) * size + 1.0, vec2(0.0), size - 1.0));
  int level = 0;
  while (level + 1 < int(frame.counts.w) &&
         any(greaterThan((last >> (level + 1)) - (first >> (level + 1)), ivec2(2))))
    ++level;
  first >>= level + 1;
  last >>= level + 1;
  float furthest = 1.0;
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x)
      furthest = min(furthest, texelFetch(pyramid, ivec2(x, y), level).r);
  }
  return nearest * 1.0001 >= furthest;  // depth is reversed
}

bool passes(CullCandidate candidate) {
  if (!in_view(candidate.least.xyz, candidate.greatest.xyz)) return false;
  if (phase == PSYGEN_CULL_ALL) return true;
  uint word = candidate.name.x >> 5;
  uint bit = 1u << (candidate.name.x & 31u);
  bool seen = (before[word] & bit) != 0u;
  if (phase == PSYGEN_CULL_SEEN) return seen;
  if (!unhidden(candidate.least.xyz, candidate.greatest.xyz)) return false;
  atomicOr(now[word], bit);
  return !seen;
}

void draw(CullCandidate candidate) {
  uint half_index = phase == PSYGEN_CULL_NEWLY_SEEN ? 1u : 0u;
  uint group = candidate.draw.w;
  uint start = half_index * frame.counts.z + first_commands[group];
  uint place = start + atomicAdd(counts[half_index * frame.counts.y + group], 1u);
  draws[place] = candidate.data;
  // The vertex shader reads its data at the first instance plus the number of the draw.
  commands[5u * place] = candidate.draw.y;
  commands[5u * place + 1u] = 1u;
  commands[5u * place + 2u] = candidate.draw.x;
  commands[5u * place + 3u] = candidate.draw.z;
  commands[5u * place + 4u] = start;
  atomicAdd(triangles, candidate.draw.y / 3u);
}

void main() {
  if (gl_LocalInvocationIndex == 0u) triangles = 0u;
  barrier();
  if (gl_GlobalInvocationID.x < frame.counts.x) {
    CullCandidate candidate = candidates[gl_GlobalInvocationID.x];
    if (passes(candidate)) draw(candidate);
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u && triangles > 0u) {
    uint half_index = phase == PSYGEN_CULL_NEWLY_SEEN ? 1u : 0u;
    atomicAdd(counts[2u * frame.counts.y + half_index], triangles);
  }
}
