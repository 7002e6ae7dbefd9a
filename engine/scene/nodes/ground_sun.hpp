// How much of the sun's light the ground of a node lets reach what stands on it: the light that is
// baked into its mesh, coarsely. Values.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>

#include "engine/core/vertex_layout.hpp"

namespace psygen::scene {

// Component of nodes: shares of 255 in cells of a square grid, row by row.
struct GroundSun {
  static constexpr std::size_t kSide = 16, kCells = kSide * kSide;
  std::array<std::uint8_t, kCells> share = full();

 private:
  static constexpr std::array<std::uint8_t, kCells> full() {
    std::array<std::uint8_t, kCells> all{};
    all.fill(255);
    return all;
  }
};
static_assert(sizeof(GroundSun) == 256);

// Means over the vertices of a mesh of n × n, at least 2 × 2, and its skirt.
GroundSun ground_sun(std::span<const core::TerrainVertex> vertices, std::size_t n);

// The share at a place, 0 … 1 along each side of the node (beyond: that of the border), between the
// middles of cells linearly. In [0, 1].
float sun_at(const GroundSun& sun, glm::vec2 place);

// The mean over a rectangle of such places, of all cells that it touches.
float sun_over(const GroundSun& sun, glm::vec2 from, glm::vec2 to);

}  // namespace psygen::scene
