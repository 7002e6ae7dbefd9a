// The input of the culling shader, declared once for GLSL and C++ like shared.h. Positions are in
// metres, relative to the camera. engine/render/passes/gpu_culling.cpp writes it.
#ifndef PSYGEN_SHADERS_CULL_SHARED_H
#define PSYGEN_SHADERS_CULL_SHARED_H

#include "shared.h"

#ifdef __cplusplus
#include <glm/ext/vector_uint4.hpp>
namespace psygen::shaders {
using glm::uvec4;
#endif

// Bindings of the descriptor set.
#define PSYGEN_CULL_FRAME 0
#define PSYGEN_CULL_CANDIDATES 1
#define PSYGEN_CULL_GROUPS 2
#define PSYGEN_CULL_COMMANDS 3
#define PSYGEN_CULL_DRAWS 4
#define PSYGEN_CULL_COUNTS 5
#define PSYGEN_CULL_SEEN_BEFORE 6
#define PSYGEN_CULL_SEEN_NOW 7
#define PSYGEN_CULL_PYRAMID 8

#define PSYGEN_CULL_THREADS 64  // per workgroup

// The candidates in view that a dispatch draws.
#define PSYGEN_CULL_ALL 0         // all of them
#define PSYGEN_CULL_SEEN 1        // those that were visible in the last frame
#define PSYGEN_CULL_NEWLY_SEEN 2  // the others that the depth pyramid does not hide

// The frame.
struct CullFrame {
  vec4 planes[5];  // of the view, inwards: normal, offset
  mat4 clip_from_camera;
  vec4 near;      // x: near plane of the projection, in metres
  uvec4 counts;   // candidates; groups; commands of a phase; levels of the pyramid
  uvec4 picture;  // width, height of the landscape in pixels
};

// A draw of the frame's lists.
struct CullCandidate {
  vec4 least;  // corners of its box
  vec4 greatest;
  DrawData data;
  uvec4 draw;  // first index, index count, vertex offset (as bits), group
  uvec4 name;  // x: its bit
};

#ifdef __cplusplus
static_assert(sizeof(CullFrame) == 5 * 16 + 64 + 3 * 16);
static_assert(sizeof(CullCandidate) == 128);
}  // namespace psygen::shaders
#endif
#endif
