// The limits for model files that a world file names.
#pragma once

#include "engine/gltf/read_file.hpp"
#include "engine/handmade/triangles.hpp"

namespace psygen::handmade {

inline gltf::Limits gltf_limits() {
  gltf::Limits most;
  most.bytes = std::uint64_t{128} << 20;
  most.vertices = kMaxVertices;
  most.indices = 6 * kMaxVertices;
  most.images = {4096, 4096, std::uint64_t{64} << 20, std::uint64_t{32} << 20};
  return most;
}

}  // namespace psygen::handmade
