// The fraction of sunlight that the ground of a node lets through to models on it: a coarse copy of
// the light baked into its mesh. Values.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>

#include "engine/core/coordinates.hpp"
#include "engine/core/vertex_layout.hpp"

namespace psygen::scene {

// Component of nodes: fractions of 255 in the cells of a square grid, row by row.
struct GroundSunlight {
  static constexpr std::size_t kSide = 16, kCells = kSide * kSide;
  std::array<std::uint8_t, kCells> share = full();

 private:
  static constexpr std::array<std::uint8_t, kCells> full() {
    std::array<std::uint8_t, kCells> all{};
    all.fill(255);
    return all;
  }
};
static_assert(sizeof(GroundSunlight) == 256);

// Means over the vertices of a mesh of n × n, at least 2 × 2, and its skirt.
GroundSunlight ground_sunlight(std::span<const core::TerrainVertex> vertices, std::size_t n);

// The fraction at a position, 0 … 1 along each side of the node (beyond: that of the border),
// interpolated between cell centres. In [0, 1].
float sun_at(const GroundSunlight& sun, glm::vec2 place);

// The mean over all cells that a rectangle of such positions touches.
float sun_over(const GroundSunlight& sun, glm::vec2 from, glm::vec2 to);

}  // namespace psygen::scene
