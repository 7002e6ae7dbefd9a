// Occluder lines and tile heights of a node's ground: the input of horizon culling and of tile
// culling (models/terrain/grid.hpp). Values.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/core/vertex_layout.hpp"
#include "engine/models/terrain/grid.hpp"
#include "engine/visibility/horizon.hpp"

namespace psygen::scene {

// Component of nodes. For vertices that morph, lines use the lower height and tiles the higher one,
// so that both hold at any morph.
struct GroundOccluder {
  static constexpr std::size_t kMaxPoints = 22;
  static constexpr std::size_t kTiles = models::kMaxTilesPerSide * models::kMaxTilesPerSide;
  std::size_t points = 0;                 // of each line, and lines along each axis; 0: none
  std::array<float, kMaxPoints> place{};  // along a side, 0 … 1
  // Heights at the crossings of both families of lines, row by row. The ground is nowhere below the
  // straight segment between neighbours along either axis.
  std::array<float, kMaxPoints * kMaxPoints> height_m{};
  std::array<float, kTiles> top_m{};  // row by row, for each tile
};

// Finds the lines in the vertices of a mesh with this grid; the height of each is low_m + v / 65535
// · range_m. Lowers lines by `lower_by_m`: the maximum difference of another mesh that may replace
// it.
GroundOccluder ground_occluder(std::span<const core::TerrainVertex> vertices,
                               const models::TerrainGrid& grid, float low_m, float range_m,
                               float lower_by_m);

// Adds the lines of a node that lie across the direction from the camera to its middle. `corner` is
// relative to the camera.
void add_lines(const GroundOccluder& occluder, const glm::vec3& corner, float size_m,
               visibility::Horizon& horizon);

}  // namespace psygen::scene
