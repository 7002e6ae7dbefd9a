// What the mesh of a node's ground says about what it hides and where it can be seen: a few lines
// that lie in it, and how high its tiles (models/terrain/grid.hpp) reach. Values.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/core/vertex_layout.hpp"
#include "engine/models/terrain/grid.hpp"
#include "engine/visibility/horizon.hpp"

namespace psygen::scene {

// Component of nodes. Of vertices that morph the lines have the lower height and the tiles the
// higher one, so that both hold however they are drawn.
struct GroundRelief {
  static constexpr std::size_t kMaxPoints = 22;
  static constexpr std::size_t kTiles = models::kMaxTilesPerSide * models::kMaxTilesPerSide;
  std::size_t points = 0;  // along each line, and as many lines along each axis; 0: no lines
  std::array<float, kMaxPoints> place{};  // along a side, 0 … 1
  // Heights where the lines of both families meet, row by row: straight from one to the next along
  // either axis the ground is nowhere lower.
  std::array<float, kMaxPoints * kMaxPoints> height_m{};
  std::array<float, kTiles> top_m{};  // row by row, of as many tiles as there are
};

// From the vertices of a mesh with this grid; the height of each is low_m + v / 65535 · range_m.
// Lines are `lower_by_m` lower: as far as another mesh, which may take its place, could be.
GroundRelief ground_relief(std::span<const core::TerrainVertex> vertices,
                           const models::TerrainGrid& grid, float low_m, float range_m,
                           float lower_by_m);

// Adds the lines of a node that lie across the direction from the camera to its middle. `corner` is
// relative to the camera.
void add_lines(const GroundRelief& relief, const glm::vec3& corner, float size_m,
               visibility::Horizon& horizon);

}  // namespace psygen::scene
