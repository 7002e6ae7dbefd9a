#include "engine/models/terrain/road_marks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "engine/core/vertex_layout.hpp"

namespace psygen::models {
namespace {

// The vertices of a mesh along one axis, in metres from a point of the world.
struct Axis {
  double first_m, step_m;
  std::int64_t count;
  // The vertices within a distance of a coordinate: the first, and the one after the last.
  std::int64_t begin(double at_m) const { return limited(std::ceil((at_m - first_m) / step_m)); }
  std::int64_t end(double at_m) const { return limited(std::floor((at_m - first_m) / step_m) + 1); }
  double at(std::int64_t i) const { return first_m + static_cast<double>(i) * step_m; }

 private:
  std::int64_t limited(double i) const {
    return static_cast<std::int64_t>(std::clamp(i, 0.0, static_cast<double>(count)));
  }
};

Axis axis_from(const TerrainShape& shape, const TerrainGrid& grid, std::int64_t node,
               std::int32_t origin_block, double origin_local_m) {
  const double cell_m = std::ldexp(shape.cell_m, -shape.node_level);
  const std::int64_t cells =
      shape.world_of(node, 0) - std::int64_t{origin_block} * (shape.size - 1);
  return {static_cast<double>(cells) * cell_m - origin_local_m, shape.cell_m * grid.stride, grid.n};
}

}  // namespace

void mark_roads(const TerrainShape& shape, const TerrainGrid& grid, core::BlockCoord node,
                std::byte* vertices) {
  if (shape.edits == nullptr) return;
  const double block_m = (shape.size - 1) * std::ldexp(shape.cell_m, -shape.node_level);
  const auto roads = shape.edits->roads_in(
      QuadCoord::of(node, static_cast<std::uint32_t>(shape.node_level)), block_m);
  if (roads.empty()) return;
  std::vector<std::uint8_t> marks(grid.surface_vertices());
  for (const GroundEdit* edit : roads) {
    const core::WorldPosition& centre = edit->centre;
    const core::WorldPosition& origin = edit->road->origin;
    const Axis near_x = axis_from(shape, grid, node.x, centre.block.x, centre.local.x);
    const Axis near_z = axis_from(shape, grid, node.z, centre.block.z, centre.local.z);
    const Axis x = axis_from(shape, grid, node.x, origin.block.x, origin.local.x);
    const Axis z = axis_from(shape, grid, node.z, origin.block.z, origin.local.z);
    for (std::int64_t k = near_z.begin(-edit->radius_m); k < near_z.end(edit->radius_m); ++k) {
      for (std::int64_t i = near_x.begin(-edit->radius_m); i < near_x.end(edit->radius_m); ++i) {
        std::uint8_t& mark = marks[static_cast<std::size_t>(k * grid.n + i)];
        const double share = road_share(*edit->road, {x.at(i), z.at(k)});
        mark = std::max(mark, static_cast<std::uint8_t>(share * 255 + 0.5));
      }
    }
  }
  for (std::size_t i = 0; i < marks.size(); ++i)
    vertices[i * sizeof(core::TerrainVertex) + offsetof(core::TerrainVertex, road)] =
        static_cast<std::byte>(marks[i]);
}

}  // namespace psygen::models
