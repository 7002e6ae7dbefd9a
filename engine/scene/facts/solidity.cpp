#include "engine/scene/facts/solidity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/core/assert.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/spacing.hpp"

namespace psygen::scene {
namespace {

// Height in metres above a node's lowest ground through which things behind it can be visible.
constexpr float kBandM = 80.0F;
// Fraction of light through a model's bounds that the model stops.
constexpr float kModelDensity = 0.4F;
// The height range between five samples is somewhat larger than at the samples.
constexpr double kReliefFactor = 1.2;

models::Parameters middle_parameters(const models::Registry& registry,
                                     const world::Scatter& scatter) {
  models::Parameters p = world::scatter_parameters(registry, scatter);
  for (std::size_t i = 0; i < scatter.ranges.size(); ++i) {
    const world::ParameterRange& range = scatter.ranges[i];
    if (range.low != range.high)
      world::set_parameter(registry[scatter.model], p, i, (range.low + range.high) / 2);
  }
  return p;
}

double relief_m(const world::World& world, const visibility::NodeCoord& node) {
  const double side_m = std::ldexp(world.block_size_m(), node.level);
  constexpr std::array<std::array<double, 2>, 5> kPlaces{
      {{0, 0}, {1, 0}, {0, 1}, {1, 1}, {0.5, 0.5}}};
  std::array<double, kPlaces.size()> heights_m{};
  std::ranges::transform(kPlaces, heights_m.begin(), [&](const auto& place) {
    return models::ground_height_m(world.terrain, visibility::corner_block(node), place[0] * side_m,
                                   place[1] * side_m);
  });
  const auto [low, high] = std::ranges::minmax(heights_m);
  return kReliefFactor * (high - low);
}

// Mean over heights h in [0, band] of the fraction of the ground that is higher than h.
float ground_share(float relief_m, float band_m) {
  if (relief_m <= 0) return 0;
  return band_m <= relief_m ? 1 - band_m / (2 * relief_m) : relief_m / (2 * band_m);
}

float standing_share(const Standing& kind, float side_m, float band_m) {
  const float met = std::numbers::pi_v<float> / 4 * kind.count * kind.width_m / side_m;
  return (1 - std::exp(-met * std::min(kind.density, 1.0F))) *
         std::min(kind.height_m / band_m, 1.0F);
}

}  // namespace

float estimate_solidity(float side_m, float relief_m, std::span<const Standing> standing,
                        float band_m) {
  PSYGEN_ASSERT(side_m > 0 && band_m > 0, "side and band must be positive");
  float passes = 1 - ground_share(relief_m, band_m);
  for (const Standing& kind : standing)
    passes *= 1 - standing_share(kind, side_m, band_m);
  return std::clamp(1 - passes, 0.0F, 1.0F);
}

std::vector<Standing> obstacles_on_block(const world::World& world,
                                         const models::Registry& registry) {
  std::vector<Standing> standing;
  for (const world::Scatter& scatter : world.scatter) {
    const core::Bounds box = registry[scatter.model].bounds(middle_parameters(registry, scatter));
    const glm::vec3 size = box.max - box.min;
    const double block_m2 = world.block_size_m() * world.block_size_m();
    const double share = world::kept_share(scatter.count / block_m2, scatter.spacing_m);
    standing.push_back({static_cast<float>(scatter.count * share), (size.x + size.z) / 2,
                        std::max(box.max.y, 0.0F), kModelDensity});
  }
  return standing;
}

float node_solidity(const world::World& world, std::span<const Standing> on_block,
                    const visibility::NodeCoord& node) {
  std::vector<Standing> standing(on_block.begin(), on_block.end());
  for (Standing& kind : standing)
    kind.count = std::ldexp(kind.count, 2 * node.level);
  return estimate_solidity(static_cast<float>(std::ldexp(world.block_size_m(), node.level)),
                           static_cast<float>(relief_m(world, node)), standing, kBandM);
}

}  // namespace psygen::scene
