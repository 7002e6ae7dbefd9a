#include "engine/exchange/water_object.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/core/rounding.hpp"
#include "engine/models/terrain/ground.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/water.hpp"

namespace psygen::exchange {
namespace {

// A vertex of the node's ground: the surface over it, and whether it is wet.
struct Corner {
  std::optional<world::WaterSurface> water;
  bool wet = false;
};

void add_cell(const std::array<Corner, 4>& corners, glm::dvec2 at_m, double side_m, Part& part) {
  double sum = 0;
  int known = 0;
  for (const Corner& corner : corners)
    if (corner.water) sum += corner.water->surface_m, ++known;
  const auto first = static_cast<std::uint32_t>(part.positions.size());
  for (std::size_t i = 0; i < 4; ++i) {
    const Corner& corner = corners[i];
    const double height_m = corner.water ? corner.water->surface_m : sum / known;
    part.positions.emplace_back(at_m.x + static_cast<double>(i & 1) * side_m, height_m,
                                at_m.y + static_cast<double>(i >> 1) * side_m);
    part.normals.push_back(corner.water ? corner.water->normal : glm::vec3(0, 1, 0));
  }
  for (const std::uint32_t i : {0U, 2U, 1U, 1U, 2U, 3U})
    part.indices.push_back(first + i);
}

}  // namespace

std::optional<Object> water_object(const world::World& world, core::BlockCoord node,
                                   int node_level) {
  const core::RoundToNearest rounding;
  if (!world::has_water(world)) return std::nullopt;
  const auto cells = static_cast<std::size_t>(world.terrain.integer(models::kTerrainSize) - 1);
  const std::size_t side = cells + 1;
  const double cell_m = std::ldexp(world.cell_m(), node_level);
  const models::BlockGround ground(world::terrain_parameters(world, node, node_level), node,
                                   side * side);
  const auto block_of = [node_level](std::int32_t index) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(index) << node_level);
  };
  const core::BlockCoord block{block_of(node.x), block_of(node.z)};
  std::vector<Corner> corners;
  std::size_t wet = 0, sea = 0;
  for (std::size_t i = 0; i < side * side; ++i) {
    const glm::dvec2 at_m =
        glm::dvec2(static_cast<double>(i % side), static_cast<double>(i / side)) * cell_m;
    Corner corner{world::water_surface(world, {block, {at_m.x, 0, at_m.y}})};
    corner.wet = corner.water && corner.water->depth_over(ground.at(at_m).height_m) > 0;
    wet += corner.wet ? 1 : 0;
    sea += corner.wet && corner.water->body == world::kSea ? 1 : 0;
    corners.push_back(corner);
  }
  if (wet == 0) return std::nullopt;
  Part part;
  part.material = kWater;
  if (sea == corners.size()) {
    add_cell({corners.front(), corners.front(), corners.front(), corners.front()}, {0, 0},
             static_cast<double>(cells) * cell_m, part);
  } else {
    for (std::size_t z = 0; z < cells; ++z) {
      for (std::size_t x = 0; x < cells; ++x) {
        const std::size_t at = z * side + x;
        const std::array<Corner, 4> of{corners[at], corners[at + 1], corners[at + side],
                                       corners[at + side + 1]};
        if (std::ranges::any_of(of, &Corner::wet))
          add_cell(of, glm::dvec2(static_cast<double>(x), static_cast<double>(z)) * cell_m, cell_m,
                   part);
      }
    }
  }
  part.colours.assign(part.positions.size(), world.water.colour);
  Object object;
  object.name = "water";
  object.parts.push_back(std::move(part));
  return object;
}

}  // namespace psygen::exchange
