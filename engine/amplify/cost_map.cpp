#include "engine/amplify/cost_map.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/assert.hpp"
#include "engine/core/hash.hpp"
#include "engine/synthesis/cost_model.hpp"
#include "engine/world/placement.hpp"

namespace psygen::amplify {
namespace {

// The start of the k-th of n stretches. Their sizes differ by at most one block; the first are
// larger.
std::uint64_t stretch_begin(std::uint64_t blocks, std::uint64_t n, std::uint64_t k) {
  return k * (blocks / n) + std::min(k, blocks % n);
}

double priced(const synthesis::CostModel& model, const CostRates& rates,
              const world::Placement& placement) {
  const synthesis::Work work = model.work(placement.model, placement.parameters, 0);
  return model.predict_from(placement.model, 0, work) + rates.seconds_per_triangle * work.triangles;
}

double priced_block(const synthesis::CostModel& model, const world::World& world,
                    const models::Registry& registry, core::BlockCoord block,
                    const CostRates& rates, std::vector<world::Placement>& placements) {
  double seconds = rates.seconds_per_block;
  seconds += priced(model, rates,
                    {world.terrain_model, world::kTerrainIndex, glm::vec3(0.0F),
                     world::terrain_parameters(world, block)});
  world::place_models(world, registry, block, placements);
  for (const world::Placement& placement : placements)
    seconds += priced(model, rates, placement);
  return seconds;
}

}  // namespace

std::uint64_t sample_count(const Region& region) {
  const std::uint64_t blocks = region.block_count();
  return std::min(blocks, std::clamp(blocks / CostMap::kBlocksPerSample, CostMap::kMinSamples,
                                     CostMap::kMaxSamples));
}

std::vector<double> prices_of(const world::World& world, const models::Registry& registry,
                              const Region& region, const CostRates& rates, std::uint64_t first,
                              std::uint64_t end) {
  const std::uint64_t blocks = region.block_count(), samples = sample_count(region);
  const synthesis::CostModel model(registry);
  std::vector<world::Placement> placements;
  std::vector<double> seconds;
  for (std::uint64_t k = first; k < end; ++k) {
    const std::uint64_t from = stretch_begin(blocks, samples, k),
                        length = stretch_begin(blocks, samples, k + 1) - from;
    const core::BlockCoord block = region.block(from + core::mix64(k) % length);
    seconds.push_back(priced_block(model, world, registry, block, rates, placements));
  }
  return seconds;
}

CostMap CostMap::of(const world::World& world, const models::Registry& registry,
                    const Region& region, const CostRates& rates) {
  return from(region.block_count(),
              prices_of(world, registry, region, rates, 0, sample_count(region)));
}

CostMap CostMap::flat(std::uint64_t blocks) {
  return from(blocks, {1.0});
}

CostMap CostMap::from(std::uint64_t blocks, std::vector<double> seconds) {
  PSYGEN_ASSERT(!seconds.empty() && blocks >= seconds.size(), "a stretch must have a block");
  CostMap map;
  map.blocks_ = blocks;
  map.each_ = std::move(seconds);
  map.until_.push_back(0);
  for (std::size_t k = 0; k < map.each_.size(); ++k) {
    const auto length = static_cast<double>(map.stretch_begin(k + 1) - map.stretch_begin(k));
    map.until_.push_back(map.until_.back() + length * map.each_[k]);
  }
  return map;
}

CostMap CostMap::plus(double seconds_per_block) const {
  std::vector<double> more = each_;
  for (double& seconds : more)
    seconds += seconds_per_block;
  return from(blocks_, std::move(more));
}

std::uint64_t CostMap::stretch_begin(std::size_t stretch) const {
  return amplify::stretch_begin(blocks_, each_.size(), stretch);
}

std::size_t CostMap::stretch_of(std::uint64_t block) const {
  const std::uint64_t n = each_.size(), length = blocks_ / n, longer = blocks_ % n;
  const std::uint64_t k = block < longer * (length + 1)
                              ? block / (length + 1)
                              : longer + (block - longer * (length + 1)) / length;
  return static_cast<std::size_t>(std::min(k, n - 1));
}

double CostMap::seconds_before(std::uint64_t block) const {
  const std::size_t k = stretch_of(block);
  return until_[k] + static_cast<double>(block - stretch_begin(k)) * each_[k];
}

double CostMap::seconds_of(const BlockRanges& blocks) const {
  double seconds = 0;
  for (const BlockRun& run : blocks.runs())
    seconds += seconds_before(run.end) - seconds_before(run.first);
  return seconds;
}

std::uint64_t CostMap::block_at(double seconds) const {
  if (!(seconds < total_s())) return blocks_;
  const auto after = std::upper_bound(until_.begin(), until_.end(), seconds);
  if (after == until_.begin()) return 0;
  const auto k = static_cast<std::size_t>(after - until_.begin()) - 1;
  const std::uint64_t first = stretch_begin(k), end = stretch_begin(k + 1);
  const double steps = std::floor((seconds - until_[k]) / each_[k]);
  return first + std::min(end - first, static_cast<std::uint64_t>(std::max(0.0, steps)));
}

BlockRun shard_of(const CostMap& costs, std::uint64_t i, std::uint64_t n) {
  PSYGEN_ASSERT(i >= 1 && i <= n, "the index of a shard must be 1 to n");
  const auto border = [&](std::uint64_t shard) {
    if (shard == 0) return std::uint64_t{0};
    if (shard == n) return costs.block_count();
    return costs.block_at(costs.total_s() * static_cast<double>(shard) / static_cast<double>(n));
  };
  return {border(i - 1), border(i)};
}

}  // namespace psygen::amplify
