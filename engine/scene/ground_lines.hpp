// A few lines in the ground of a node, from its mesh: what hides what lies behind ridges. Values.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/core/vertex_layout.hpp"
#include "engine/visibility/horizon.hpp"

namespace psygen::scene {

// Heights on a lattice of 8 × 8 points of the mesh, row by row. Component of nodes.
struct GroundLines {
  static constexpr std::size_t kPoints = 8;  // along each side
  float lower_by_m = -1;  // how far lines between them lie above the mesh at most; < 0: unknown
  std::array<float, kPoints> place{};  // along a side, 0 … 1
  std::array<float, kPoints * kPoints> height_m{};
};

// From the vertices of a terrain mesh of n × n vertices, n² first (engine/models/terrain.hpp);
// `height_m(v)` of each is low_m + v / 65535 · range_m. `off_m` is how far the mesh is off itself.
GroundLines ground_lines(std::span<const core::TerrainVertex> vertices, float low_m, float range_m,
                         float off_m);

// Adds the lines of a node that lie across the direction from the camera to its middle. `corner` is
// relative to the camera.
void add_lines(const GroundLines& lines, const glm::vec3& corner, float size_m,
               visibility::Horizon& horizon);

}  // namespace psygen::scene
