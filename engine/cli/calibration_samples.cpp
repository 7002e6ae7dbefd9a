#include "engine/cli/calibration_samples.hpp"

#include <algorithm>

#include "engine/models/terrain/terrain.hpp"
#include "engine/world/placement.hpp"

namespace psygen::cli {
namespace {
constexpr std::int64_t kEndlessSide = std::int64_t{1} << 16;
// For rare types, times the number of blocks of other types.
constexpr std::size_t kBlocksForRareTypes = 8;
constexpr std::size_t kNodeLevels = 10;  // of 64 vertices, 1 m apart, up to 32 km a side

// Cycles through all levels, for even and odd nodes alike.
int node_level_of(std::size_t i) {
  return static_cast<int>((i + i / kNodeLevels) % kNodeLevels);
}
}  // namespace

std::vector<core::BlockCoord> sample_blocks(const world::World& world, int half, std::size_t most) {
  const std::int64_t width = world.blocks_x > 0 ? world.blocks_x : kEndlessSide;
  const std::int64_t depth = world.blocks_z > 0 ? world.blocks_z : kEndlessSide;
  const std::int64_t all = width * depth, middle = all / 2;
  const std::int64_t first = half == 0 ? 0 : middle;
  const std::int64_t end = half == 0 ? std::max<std::int64_t>(middle, 1) : all;
  std::vector<core::BlockCoord> blocks;
  for (std::int64_t i = first; i < end && blocks.size() < most; ++i)
    blocks.push_back({static_cast<std::int32_t>(i % width), static_cast<std::int32_t>(i / width)});
  return blocks;
}

std::vector<synthesis::CostSample> world_samples(const world::World& world,
                                                 const models::Registry& registry, int half,
                                                 std::size_t count) {
  std::vector<synthesis::CostSample> samples;
  std::vector<std::size_t> taken(registry.size(), 0);
  std::vector<world::Placement> placements;
  const auto take = [&](models::ModelIndex model, const models::Parameters& parameters) {
    if (taken[model]++ < count) samples.push_back({model, parameters});
  };
  const auto rare = [&] {
    return std::any_of(world.scatter.begin(), world.scatter.end(), [&](const world::Scatter& s) {
      return s.count > 0 && taken[s.model] < count;
    });
  };
  const auto blocks = sample_blocks(world, half, kBlocksForRareTypes * count);
  for (std::size_t i = 0; i < blocks.size() && (i < count || rare()); ++i) {
    models::Parameters terrain = world::terrain_parameters(world, blocks[i]);
    terrain.set_integer(models::kTerrainNodeLevel, node_level_of(i));
    take(world.terrain_model, terrain);
    world::place_models(world, registry, blocks[i], placements);
    for (const world::Placement& placement : placements)
      take(placement.model, placement.parameters);
  }
  return samples;
}

}  // namespace psygen::cli
