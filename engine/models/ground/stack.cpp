#include "engine/models/ground/stack.hpp"

#include <algorithm>
#include <cmath>

namespace psygen::models {

std::uint64_t GroundStack::hash_of(const QuadCoord& node, double margin, double block_m) const {
  return edits.hash_of(node, margin, block_m,
                       shapes.hash_of(node, margin, block_m, fixed_identity()));
}

std::uint64_t GroundStack::fixed_identity() const {
  const std::uint64_t eroded = erosion == nullptr ? 0 : erosion->identity();
  return network == nullptr ? eroded : core::combine(network->identity(), eroded);
}

bool GroundStack::same_in(const GroundStack& a, const GroundStack& b, const QuadCoord& node,
                          double margin) {
  return same_fixed_part(a, b) && GroundEdits::same_in(a.edits, b.edits, node, margin) &&
         GroundEdits::same_in(a.shapes, b.shapes, node, margin);
}

bool GroundStack::reaches(const QuadCoord& node, double block_m) const {
  return has_fixed_part() || edits.reaches(node, block_m) || shapes.reaches(node, block_m);
}

std::vector<const GroundEdit*> GroundStack::roads_in(const QuadCoord& node, double block_m,
                                                     double margin) const {
  std::vector<const GroundEdit*> roads = shapes.roads_in(node, block_m, margin);
  const std::vector<const GroundEdit*> own = edits.roads_in(node, block_m, margin);
  roads.insert(roads.end(), own.begin(), own.end());
  return roads;
}

std::vector<const GroundEdit*> GroundStack::water_in(const QuadCoord& node, double block_m) const {
  std::vector<const GroundEdit*> water = shapes.water_in(node, block_m);
  const std::vector<const GroundEdit*> own = edits.water_in(node, block_m);
  water.insert(water.end(), own.begin(), own.end());
  return water;
}

std::optional<BodySurface> GroundStack::water_over(core::BlockCoord block, glm::dvec2 local_m,
                                                   double block_m) const {
  const auto a = shapes.water_over(block, local_m, block_m);
  const auto b = edits.water_over(block, local_m, block_m);
  if (a && b) return a->owns_before(*b) ? a : b;
  if (a) return a;
  if (b || network == nullptr) return b;
  // The sea of the world is no body of its ground.
  const auto found = network->inland_water_at({block, {local_m.x, 0, local_m.y}});
  if (!found) return std::nullopt;
  BodySurface surface;
  surface.surface_m = double{found->water.surface_m};
  surface.flow_m_s = glm::dvec2(found->water.flow_m_s);
  surface.body = kFirstNetworkBody | (found->water.body & ~kFirstNetworkBody);
  if (found->channel) {
    surface.discharge_m3_s = found->channel->discharge_m3_s;
    surface.width_m = found->channel->width_m;
  }
  return surface;
}

bool GroundStack::may_have_water(core::BlockCoord block, double margin_m, double block_m) const {
  const QuadCoord node = QuadCoord::of(block);
  const double room_m = margin_m + 0.01;  // for rounding
  const auto has_pieces = [&](const GroundEdits& layer) {
    return !layer.water_in(node, block_m, room_m / block_m).empty();
  };
  if (has_pieces(shapes) || has_pieces(edits)) return true;
  if (network == nullptr) return false;
  const auto cells = static_cast<std::int64_t>(std::ceil(room_m / network->frame().cell_m));
  return network->may_have_water(network->square_of(block, 0).grown(cells));
}

bool GroundStack::may_have_network_water(core::BlockCoord block, glm::dvec2 local_m,
                                         double margin_m) const {
  if (network == nullptr) return false;
  const double cell_m = network->frame().cell_m;
  const auto corner = network->square_of(block, 0);
  const auto cell = glm::i64vec2(glm::floor(local_m / cell_m));
  const auto cells = static_cast<std::int64_t>(std::ceil((margin_m + 0.01) / cell_m));
  return network->may_have_water(
      RiverNetwork::Cells{corner.x + cell.x, corner.z + cell.y, 1}.grown(cells));
}

double GroundStack::error_m(const QuadCoord& node, double spacing_m, double block_m) const {
  const GroundEdits::Change a = shapes.max_change_in(node, block_m);
  const GroundEdits::Change b = edits.max_change_in(node, block_m);
  return std::min(a.change_m + b.change_m, (a.steepness + b.steepness) * spacing_m);
}

HeightWork GroundStack::work_per_height(const GroundScale& scale, LatticeSpan x,
                                        LatticeSpan z) const {
  const HeightWork a = shapes.work_per_height(scale, x, z), b = edits.work_per_height(scale, x, z);
  return {a.edits + b.edits, a.guide_reads + b.guide_reads};
}

void GroundStack::apply(const GroundScale& scale, std::span<const std::int64_t> x,
                        std::span<const std::int64_t> z, std::span<float> values,
                        std::size_t stride, GroundDetail detail, const ErosionGuide& guide) const {
  // Narrower edits would be missed or hit by chance, like narrower octaves.
  const double narrowest_m = detail.light ? detail.spacing_cells() * scale.cell_m : 0;
  shapes.apply(scale, x, z, values, stride, narrowest_m, &guide);
  edits.apply(scale, x, z, values, stride, narrowest_m, &guide);
}

}  // namespace psygen::models
