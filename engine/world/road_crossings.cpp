#include "engine/world/road_crossings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "engine/core/cancellation.hpp"
#include "engine/world/curve.hpp"
#include "engine/world/ground_below.hpp"
#include "engine/world/water.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {
namespace {

// The water of a world over the middle of a road.
class WaterOnRoads {
 public:
  WaterOnRoads(const World& world, const models::EditLayer& layer)
      : world_(world), layer_(layer), below_(world, layer), block_m_(world.block_size_m()) {}

  // The name of the water over a place of a road; empty: it is dry.
  std::string name_at(glm::dvec2 at_m) {
    const core::WorldPosition at = world_.position(at_m);
    enter(at.block);
    if (may_have_water_) {
      if (const auto water = below_.water_over(at_m)) return name_of(*water);
    }
    return is_below_sea(at) ? "the sea" : std::string();
  }

 private:
  // Looks at a block once, because most of them are dry.
  void enter(core::BlockCoord block) {
    if (block_ == block) return;
    block_ = block;
    may_have_water_ = layer_.ground.may_have_water(block, 0, block_m_);
    if (!world_.water.exists()) return;
    low_roads_ = layer_.ground.shapes.roads_in(models::QuadCoord::of(block), block_m_);
    std::erase_if(low_roads_, [this](const models::GroundEdit* edit) {
      return std::ranges::none_of(edit->road->segments, [this](const models::RoadSegment& s) {
        return std::min(s.from_height_m, s.to_height_m) < world_.water.level_m;
      });
    });
  }
  bool is_below_sea(const core::WorldPosition& at) const {
    const glm::dvec2 local_m{at.local.x, at.local.z};
    return std::ranges::any_of(low_roads_, [&](const models::GroundEdit* edit) {
      const models::RoadEffect road = models::effect_of(
          *edit->road, models::from_origin_m(edit->origin(), at.block, local_m, block_m_));
      return road.weight >= 1 && road.height_m < world_.water.level_m;
    });
  }
  std::string name_of(const models::BodySurface& water) const {
    if (water.is_of_network())
      return water.is_river() ? "a river of the network" : "a lake of the network";
    const std::size_t lakes = world_.shaped.lakes.size(), number = water.body - kSea;
    return water.is_river() ? fmt::format("river {}", number - lakes)
                            : fmt::format("lake {}", number);
  }

  const World& world_;
  const models::EditLayer& layer_;
  GroundBelow below_;
  double block_m_;
  std::optional<core::BlockCoord> block_;
  bool may_have_water_ = false;
  std::vector<const models::GroundEdit*> low_roads_;  // of the block, below the sea in part
};

// Neighbouring points of a road in the same water.
struct Stretch {
  std::string water;
  std::size_t first = 0, last = 0;
};

std::vector<Stretch> stretches_of(const std::vector<CurvePoint>& line, WaterOnRoads& water) {
  std::vector<Stretch> found;
  for (std::size_t i = 0; i < line.size(); ++i) {
    std::string name = water.name_at(line[i].at_m);
    if (name.empty()) continue;
    const bool goes_on = !found.empty() && found.back().last + 1 == i && found.back().water == name;
    if (goes_on)
      found.back().last = i;
    else
      found.push_back({std::move(name), i, i});
  }
  return found;
}

}  // namespace

std::vector<std::string> road_crossings(const World& world, const models::EditLayer& layer) {
  std::vector<std::string> sentences;
  WaterOnRoads water(world, layer);
  for (std::size_t i = 0; i < world.shaped.roads.size(); ++i) {
    if (!acts(world.shaped.roads[i])) continue;
    if (!core::check_cancelled()) return sentences;
    const auto line = curve_through(world.shaped.roads[i].points_m, kCrossingStepM);
    const std::vector<Stretch> found = stretches_of(line, water);
    for (std::size_t k = 0; k < std::min(found.size(), kMaxCrossings); ++k) {
      const Stretch& stretch = found[k];
      const bool crosses = stretch.first > 0 && stretch.last + 1 < line.size();
      const glm::dvec2 middle_m = line[(stretch.first + stretch.last) / 2].at_m;
      const double length_m =
          line[stretch.last].along_m - line[stretch.first].along_m + kCrossingStepM;
      sentences.push_back(
          fmt::format("road {}: it {} {} at {:.1f}, {:.1f} m, {:.0f} m long, and has no bridge "
                      "there",
                      i + 1, crosses ? "crosses" : "leads into", stretch.water, middle_m.x,
                      middle_m.y, std::max(length_m, 1.0)));
    }
    if (found.size() > kMaxCrossings)
      sentences.push_back(fmt::format("road {}: it meets water at {} more places, without a bridge",
                                      i + 1, found.size() - kMaxCrossings));
  }
  return sentences;
}

}  // namespace psygen::world
