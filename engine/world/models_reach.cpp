#include "engine/world/models_reach.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>
#include <vector>

#include "engine/models/edits.hpp"
#include "engine/world/placement.hpp"

namespace psygen::world {

glm::vec2 models_reach_m(const World& world, const models::Registry& registry) {
  // Maximum number of ranged parameters whose ends are tried in all combinations.
  constexpr std::size_t kMaxVaried = 12;
  glm::vec2 reach_m(0.0F);
  for (const Scatter& scatter : world.scatter) {
    const models::ModelType& type = registry[scatter.model];
    const auto specs = type.parameters();
    std::vector<std::size_t> ranged;
    for (std::size_t i = 0; i < specs.size(); ++i) {
      if (scatter.ranges[i].low != scatter.ranges[i].high) ranged.push_back(i);
    }
    const std::size_t varied = std::min(ranged.size(), kMaxVaried);
    for (std::uint32_t corner = 0; corner < (1u << varied); ++corner) {
      models::Parameters p = scatter_parameters(registry, scatter);
      for (std::size_t k = 0; k < varied; ++k) {
        const ParameterRange& range = scatter.ranges[ranged[k]];
        set_parameter(type, p, ranged[k], (corner >> k & 1) != 0 ? range.high : range.low);
      }
      const auto steepest =
          static_cast<float>(std::tan(scatter.max_slope_deg * std::numbers::pi / 180));
      set_slope(type, slope_parameters(type), glm::vec2(steepest), p);
      const core::Bounds box = type.bounds(p);
      reach_m.x = std::max({reach_m.x, -box.min.x, -box.min.z, box.max.x, box.max.z});
      reach_m.y = std::max(reach_m.y, box.max.y);
    }
  }
  return reach_m;
}

glm::vec2 with_placed_models(glm::vec2 scattered, const World& world) {
  for (const models::EditLayer* layer : {world.edits.get(), world.places.by_block.get()}) {
    if (layer == nullptr || layer->blocks.empty()) continue;
    const glm::vec3& placed = layer->blocks.root()->summary.reach_m;
    scattered = glm::max(scattered, glm::vec2(placed.x, placed.y));
  }
  return scattered;
}

}  // namespace psygen::world
