// The surface of rivers and lakes made by hand: strips along rivers, and tiles of lakes.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/models/water/surface_writer.hpp"

namespace psygen::models {
namespace {

constexpr int kMinBorderCells = 4, kMaxTileCells = 8;
constexpr double kTileCellM = 8;  // of lakes at node level 0

// True for the one node of its level that has a point, in metres from a position.
bool owns(const WaterNode& node, const core::WorldPosition& origin, glm::dvec2 from_m) {
  const auto inside = [&](std::int32_t first, std::int32_t from, double local_m) {
    const auto away = static_cast<std::int64_t>(std::floor(local_m / node.block_m)) + from - first;
    return away >= 0 && away < std::int64_t{1} << node.level;
  };
  return inside(node.block.x, origin.block.x, origin.local.x + from_m.x) &&
         inside(node.block.z, origin.block.z, origin.local.z + from_m.y);
}

// From the node's corner to a position.
glm::dvec2 corner_to_m(const WaterNode& node, const core::WorldPosition& origin) {
  return -from_origin_m(origin, node.block, {0.0, 0.0}, node.block_m);
}

double width_m(const RiverPiece& river) {
  double half_m = 0;
  for (const RiverPoint& point : river.points)
    half_m = std::max(half_m, point.half_width_m);
  return 2 * half_m;
}

// True where another body of water owns the middle of a river: it flows into it there.
bool is_foreign(const WaterNode& node, const RiverPiece& river, const RiverPoint& point) {
  core::WorldPosition at = river.origin;
  at.local.x += point.at_m.x;
  at.local.z += point.at_m.y;
  at = core::normalised(at, node.block_m);
  const auto owner = node.ground->water_over(at.block, {at.local.x, at.local.z}, node.block_m);
  return owner && owner->body != river.body;
}

CrossSection section_of(const WaterNode& node, const RiverPiece& river, const RiverPoint& point) {
  return {.middle_m = corner_to_m(node, river.origin) + point.at_m,
          .direction = point.direction,
          .half_width_m = point.half_width_m,
          .edge_m = river.edge_m,
          .surface_m = point.surface_m,
          .middle_depth_m = point.surface_m - point.bed_m,
          .middle_m_s = 1.25 * point.speed_m_s,  // as surface_of() has it
          .fall = point.fall,
          .foam = point.foam};
}

// Adds the strips of a river whose middle the node owns, between points 2^level apart.
void add(const WaterNode& node, const RiverPiece& river, SurfaceWriter& to) {
  if (!node.shows(width_m(river))) return;
  const std::size_t stride = std::size_t{1} << std::min(node.level, 16);
  for (std::size_t first = 0; first + 1 < river.points.size() && !to.is_full(); first += stride) {
    const RiverPoint& upper = river.points[first];
    const RiverPoint& lower = river.points[std::min(first + stride, river.points.size() - 1)];
    if (!owns(node, river.origin, (upper.at_m + lower.at_m) / 2.0)) continue;
    if (is_foreign(node, river, upper) && is_foreign(node, river, lower)) continue;
    const std::uint32_t row = to.add(section_of(node, river, upper), node.level);
    to.join(row, to.add(section_of(node, river, lower), node.level), node.level);
  }
}

// Adds the part of a tile within the lake: each square of its cells, cut by the border of the
// water.
void add(const WaterNode& node, const LakePiece& lake, SurfaceWriter& to) {
  const bool has_border = !lake.segments.empty();
  if (!owns(node, lake.origin, (lake.low_m + lake.high_m) / 2.0) || to.is_full()) return;
  if (!has_border && !lake.inside) return;
  const glm::dvec2 size_m = lake.high_m - lake.low_m;
  const auto wanted = static_cast<int>(
      std::ceil(std::max(size_m.x, size_m.y) / std::ldexp(kTileCellM, node.level)));
  const int cells = std::clamp(wanted, has_border ? kMinBorderCells : 1, kMaxTileCells);
  const glm::dvec2 corner_m = corner_to_m(node, lake.origin);
  const glm::dvec2 cell_m = size_m / static_cast<double>(cells);
  const auto side = static_cast<std::size_t>(cells) + 1;
  std::array<double, (kMaxTileCells + 1) * (kMaxTileCells + 1)> outside;
  const auto place_m = [&](std::size_t x, std::size_t z) {
    return lake.low_m + cell_m * glm::dvec2(static_cast<double>(x), static_cast<double>(z));
  };
  for (std::size_t z = 0; z < side; ++z) {
    for (std::size_t x = 0; x < side; ++x)
      outside[z * side + x] = outside_m(lake, place_m(x, z)) - lake.edge_m;
  }
  for (std::size_t z = 0; z + 1 < side; ++z) {
    for (std::size_t x = 0; x + 1 < side; ++x) {
      std::array<double, 4> beyond;
      std::array<glm::dvec2, 4> places;
      for (std::size_t c = 0; c < 4; ++c) {
        const auto [right, down] = SurfaceWriter::kCorners[c];
        beyond[c] = outside[(z + down) * side + x + right];
        places[c] = place_m(x + right, z + down);
      }
      to.add_ring(beyond, [&](std::size_t i, std::size_t j, double share) {
        const glm::dvec2 at_m = corner_m + places[i] + (places[j] - places[i]) * share;
        const double out_m = beyond[i] + (beyond[j] - beyond[i]) * share + lake.edge_m;
        return to.add({.at_m = {at_m.x, lake.level_m, at_m.y}, .depth_m = depth_of(lake, out_m)});
      });
    }
  }
}

}  // namespace

void add_pieces(const WaterNode& node, SurfaceWriter& to) {
  std::vector<const GroundEdit*> pieces = node.ground->water_in(node.at, node.block_m);
  std::ranges::sort(pieces, {}, &GroundEdit::order);
  for (const GroundEdit* piece : pieces) {
    if (piece->river) add(node, *piece->river, to);
  }
  for (const GroundEdit* piece : pieces) {
    if (piece->lake) add(node, *piece->lake, to);
  }
}

}  // namespace psygen::models
