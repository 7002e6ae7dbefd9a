// The ground of one block for many queries, such as the base points of all models on it. If there
// are enough queries, it evaluates the heights of all vertices of the block together, in the time
// of ten single points; or finds them in the cache of the ground (GroundStack::heights). The
// results have the same bits either way, and equal those of sample_ground() (terrain.hpp). It makes
// no mesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "engine/models/terrain/grid.hpp"
#include "engine/models/terrain/shape.hpp"
#include "engine/models/terrain/terrain.hpp"

namespace psygen::models {

// Returns the upward unit normal of a plane with these slopes along x and z.
glm::vec3 unit_normal(double slope_x, double slope_z);

// The heights of one block. Immutable after construction; any thread.
class BlockGround {
 public:
  // `questions` is the approximate number of calls of at(). The block coordinates in `terrain` are
  // ignored. Throws std::bad_alloc.
  BlockGround(const Parameters& terrain, core::BlockCoord block, std::size_t questions);

  // Reads the heights from `mesh`, the vertices of the block's mesh of level 0, which must outlive
  // it unchanged. A mesh with too few vertices fails an assertion, also in release.
  BlockGround(const Parameters& terrain, core::BlockCoord block, std::span<const std::byte> mesh);

  // 0: the ground of a block; else of a node of that level, of coarser vertices.
  int node_level() const { return shape_.node_level; }
  // Returns the ground under a point, in metres from the block's corner. The point may be outside
  // the block (within 10^6 cells). About 20 ns inside a block whose heights were evaluated or read,
  // else 1 µs, or 30 µs with a river network and erosion. With the stride of a coarser level
  // (terrain_strides()): the ground of that level.
  GroundPoint at(glm::dvec2 local_xz, int stride = 1) const;

  // Returns the lowest height in a square. Some nanoseconds for each vertex below it inside a block
  // with known heights, else as at() and an evaluation of each vertex.
  double lowest_m(glm::dvec2 middle_m, double half_m, int stride = 1) const;

  // Writes the quantised heights of all vertices, row by row (z outer, x inner), as the mesh of
  // level 0 has them (core::TerrainVertex::height). `out` has size² elements. The heights must have
  // been evaluated (`questions` >= size² / 128) or read; otherwise an assertion fails, also in
  // release.
  void heights(std::span<std::uint16_t> out) const;

 private:
  // Quantised heights at (x, z), (x + step, z), (x, z + step), (x + step, z + step).
  using Corners = std::array<std::uint16_t, 4>;

  std::vector<std::uint16_t> quantised_vertices() const;
  std::uint16_t known(std::size_t vertex) const;  // its height
  std::vector<double> vertices_in(glm::i64vec2 first, glm::ivec2 size, int stride) const;
  double metres(std::uint16_t height) const;
  void world_of(std::int32_t block_index, std::int64_t first, std::span<std::int64_t> out) const;
  bool is_inside(double x, double z, int step) const;
  Corners corners_of(double x, double z, int step) const;

  TerrainShape shape_;
  core::BlockCoord block_;
  std::size_t vertices_ = 0;         // per side, with known heights; 0: none
  std::span<const std::byte> mesh_;  // empty: the heights are in heights_
  std::shared_ptr<const std::vector<std::uint16_t>> heights_;  // if they were evaluated
};

}  // namespace psygen::models
