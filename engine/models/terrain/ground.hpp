// The ground of one block for many questions, such as where everything on it stands. Where they pay
// for it, the heights of all vertices of the block are evaluated at once, in the time of ten single
// points. The answers have the same bits either way, and are those of sample_ground()
// (terrain.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>

#include "engine/models/terrain/grid.hpp"
#include "engine/models/terrain/shape.hpp"
#include "engine/models/terrain/terrain.hpp"

namespace psygen::models {

// 66 KiB, of which nothing is on the heap. Immutable once it is made; any thread.
class BlockGround {
 public:
  // `questions` is about how often at() will be called. The block coordinates in `terrain` are
  // ignored. Needs 256 KiB of stack.
  BlockGround(const Parameters& terrain, core::BlockCoord block, std::size_t questions);

  // Reads the heights from the block's mesh of level 0, which must outlive it unchanged.
  BlockGround(const Parameters& terrain, core::BlockCoord block, std::span<const std::byte> mesh);

  // The ground under a point in metres from the block's corner, which may lie outside of the block
  // (within 10^6 cells). About 20 ns inside of a block whose heights are there, else 1 µs.
  // Or, with the stride of a coarser level (terrain_strides()), the ground as that level has it.
  GroundPoint at(glm::dvec2 local_xz, int stride = 1) const;

 private:
  // Quantised heights at (x, z), (x + step, z), (x, z + step), (x + step, z + step).
  using Corners = std::array<std::uint16_t, 4>;

  void evaluate_vertices();
  void world_of(std::int32_t block_index, std::int64_t first, std::span<std::int64_t> out) const;
  bool is_inside(double x, double z, int step) const;
  Corners corners_of(double x, double z, int step) const;

  TerrainShape shape_;
  core::BlockCoord block_;
  std::size_t vertices_ = 0;         // per side whose heights are there; 0: none
  std::span<const std::byte> mesh_;  // empty: they are in noise_
  std::array<float, std::size_t{kMaxTerrainSize} * kMaxTerrainSize> noise_;  // of the vertices
};

}  // namespace psygen::models
