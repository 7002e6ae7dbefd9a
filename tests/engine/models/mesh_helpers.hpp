// Meshes for tests: synthesised between canary bytes that reveal any write beyond the destination,
// with their shared indices, legal random parameters, and the last block. Knows no particular
// model.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "engine/models/model_type.hpp"

namespace psygen::models::test {

// The index of the last block along either axis.
inline constexpr std::int64_t kFar = std::numeric_limits<std::int32_t>::max();

struct Mesh {
  MeshSize size;
  std::vector<std::byte> vertex_bytes;
  std::vector<std::uint16_t> indices;
  core::Bounds box;

  template <class Vertex>
  std::vector<Vertex> vertices() const {
    std::vector<Vertex> result(vertex_bytes.size() / sizeof(Vertex));
    std::memcpy(result.data(), vertex_bytes.data(), vertex_bytes.size());
    return result;
  }
};

inline Mesh synthesise(const ModelType& type, const Parameters& p, int level) {
  constexpr std::size_t kGuard = 256;
  constexpr std::byte kCanary{0xC5};
  Mesh mesh;
  mesh.size = type.mesh_size(p, level);
  const std::size_t bytes = mesh.size.vertex_count * core::vertex_stride_bytes(mesh.size.layout);
  const std::size_t own = mesh.size.shared_indices == 0 ? mesh.size.index_count : 0;
  std::vector<std::byte> vertices(bytes + 2 * kGuard, kCanary);
  std::vector<std::uint16_t> indices(own + 2 * kGuard, 0xC5C5);
  mesh.box = type.synthesise(
      p, level,
      {std::span(vertices).subspan(kGuard, bytes), std::span(indices).subspan(kGuard, own)});
  for (std::size_t i = 0; i < kGuard; ++i) {
    EXPECT_EQ(vertices[i], kCanary);
    EXPECT_EQ(vertices[kGuard + bytes + i], kCanary);
    EXPECT_EQ(indices[i], 0xC5C5);
    EXPECT_EQ(indices[kGuard + own + i], 0xC5C5);
  }
  mesh.vertex_bytes.assign(vertices.begin() + kGuard,
                           vertices.begin() + static_cast<std::ptrdiff_t>(kGuard + bytes));
  mesh.indices.assign(indices.begin() + kGuard,
                      indices.begin() + static_cast<std::ptrdiff_t>(kGuard + own));
  if (mesh.size.shared_indices != 0) {
    mesh.indices.resize(mesh.size.index_count);
    type.write_shared_indices(mesh.size.shared_indices, mesh.indices);
  }
  return mesh;
}

// Uniform within the soft ranges; placed parameters (seeds, coordinates) within their hard ranges.
inline Parameters random_parameters(const ModelType& type, core::RandomStream& random) {
  Parameters p = default_parameters(type);
  const std::span<const ParameterSpec> specs = type.parameters();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const ParameterSpec& s = specs[i];
    if (s.type == ParameterType::kReal) {
      p.set_real(i, random.next_real(s.soft_min, s.soft_max));
    } else if (s.hard_max > 0x1.0p62) {
      p.set_integer(i, static_cast<std::int64_t>(random.next_u64()));
    } else if (s.source == ParameterSource::kPlaced) {
      p.set_integer(i, random.next_integer(static_cast<std::int64_t>(s.hard_min),
                                           static_cast<std::int64_t>(s.hard_max)));
    } else {
      p.set_integer(i, random.next_integer(static_cast<std::int64_t>(s.soft_min),
                                           static_cast<std::int64_t>(s.soft_max)));
    }
  }
  return p;
}

// True if every edge of the triangles belongs to exactly two of them, once in each direction.
// `place` maps a vertex to a number that is equal for vertices at the same position.
template <class Place>
bool is_watertight(const std::vector<std::uint16_t>& indices, const Place& place) {
  std::map<std::pair<std::uint64_t, std::uint64_t>, int> directed;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k)
      ++directed[{place(indices[i + k]), place(indices[i + (k + 1) % 3])}];
  }
  return std::all_of(directed.begin(), directed.end(), [&](const auto& edge) {
    const auto back = directed.find({edge.first.second, edge.first.first});
    return edge.second == 1 && back != directed.end() && back->second == 1;
  });
}

}  // namespace psygen::models::test
