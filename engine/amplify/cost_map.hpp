// Predicts the costs of a region's blocks, to divide them fairly, without synthesis. The region is
// divided into stretches of equally many blocks; one block of each, chosen by a hash, is placed and
// priced. Prices come from the uncalibrated cost model (synthesis/cost_model.hpp) with exact sizes,
// so every machine and every process gets the same map. Pure; any thread; needs the stack of
// world::place_models().
#pragma once

#include <cstdint>
#include <vector>

#include "engine/amplify/block_ranges.hpp"
#include "engine/amplify/region.hpp"
#include "engine/models/registry.hpp"
#include "engine/world/world.hpp"

namespace psygen::amplify {

// The cost of writing a triangle as a .glb, in addition to its synthesis: unpacking, encoding and
// writing, measured on one core of a Xeon with a local disk (docs/cluster.md).
inline constexpr double kGlbSecondsPerTriangle = 0.2e-6;

// The fixed cost of a file until it is on the disk, measured like that.
inline constexpr double kSecondsPerFile = 3e-3;
// Bytes of a .glb per triangle, including its part of the vertices, in the paper's world.
inline constexpr double kGlbBytesPerTriangle = 42;

// Costs in addition to synthesis.
struct CostRates {
  double seconds_per_triangle = 0;  // without synthesis
  double seconds_per_block = 0;
  // The rates of blocks that are written as files, or only made.
  static constexpr CostRates with_files(bool files) {
    return files ? CostRates{kGlbSecondsPerTriangle, kSecondsPerFile} : CostRates{};
  }
};

// The number of priced blocks of a region, and the prices of the samples first … end − 1. The
// prices of all parts, concatenated, are the argument of CostMap::from().
std::uint64_t sample_count(const Region& region);
std::vector<double> prices_of(const world::World& world, const models::Registry& registry,
                              const Region& region, const CostRates& rates, std::uint64_t first,
                              std::uint64_t end);

// The costs of a region's blocks by index.
class CostMap {
 public:
  // At most this many blocks are priced, and at most one in eight of regions with more than 512
  // blocks: about 1 % of the synthesis time.
  static constexpr std::uint64_t kMaxSamples = 4096;
  static constexpr std::uint64_t kBlocksPerSample = 8, kMinSamples = 64;

  // Prices a region, which check_region() has accepted.
  static CostMap of(const world::World& world, const models::Registry& registry,
                    const Region& region, const CostRates& rates);
  // Every block costs the same: 1 second.
  static CostMap flat(std::uint64_t blocks);
  // Known costs: `seconds[k]` for each block of the k-th of equally large stretches.
  static CostMap from(std::uint64_t blocks, std::vector<double> seconds);

  // The same map with this much more for each block.
  CostMap plus(double seconds_per_block) const;

  std::uint64_t block_count() const { return blocks_; }
  double total_s() const { return until_.back(); }
  // The cost of blocks 0 … block − 1. Requires block <= block_count().
  double seconds_before(std::uint64_t block) const;
  double seconds_of(const BlockRanges& blocks) const;
  // The block at which this cost is reached: the largest b <= block_count() with seconds_before(b)
  // <= seconds.
  std::uint64_t block_at(double seconds) const;

 private:
  std::uint64_t stretch_begin(std::size_t stretch) const;
  std::size_t stretch_of(std::uint64_t block) const;

  std::uint64_t blocks_ = 0;
  std::vector<double> each_;   // seconds per block, by stretch
  std::vector<double> until_;  // seconds before each stretch, and in total
};

// Shard `i` of `n`, 1 … n: consecutive blocks that cost an n-th of the map. Shards are disjoint and
// together have every block; some are empty if there are fewer blocks.
BlockRun shard_of(const CostMap& costs, std::uint64_t i, std::uint64_t n);

}  // namespace psygen::amplify
