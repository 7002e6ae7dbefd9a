// What the blocks of a region are predicted to cost, to share them out: nothing is synthesised. The
// region is cut into stretches of equally many blocks; one block of each is placed and priced, at a
// place in it that a hash chooses. Prices are those of the uncalibrated cost model
// (synthesis/cost_model.hpp) over exact sizes, so that every machine and every process gets the
// same map. Pure; any thread; needs the stack of world::place_models().
#pragma once

#include <cstdint>
#include <vector>

#include "engine/amplify/block_ranges.hpp"
#include "engine/amplify/region.hpp"
#include "engine/models/registry.hpp"
#include "engine/world/world.hpp"

namespace psygen::amplify {

// What a triangle costs beside its synthesis when it is written as a .glb: unpacking, encoding and
// writing, measured on one core of a Xeon with a local disk (docs/cluster.md).
inline constexpr double kGlbSecondsPerTriangle = 0.2e-6;

// What a file costs whatever is in it: until it is on the disk, measured like that.
inline constexpr double kSecondsPerFile = 3e-3;
// Bytes of a .glb for each triangle, with its share of vertices, in the paper's world.
inline constexpr double kGlbBytesPerTriangle = 42;

// How to price blocks.
struct CostRates {
  double seconds_per_triangle = 0;  // beside synthesis
  double seconds_per_block = 0;
  // Of blocks that are written as files, or only made.
  static constexpr CostRates with_files(bool files) {
    return files ? CostRates{kGlbSecondsPerTriangle, kSecondsPerFile} : CostRates{};
  }
};

// The predicted seconds of one core for a block at full detail.
double predicted_block_seconds(const world::World& world, const models::Registry& registry,
                               core::BlockCoord block, const CostRates& rates);

// How many blocks of a region are priced, and the prices of the samples first … end − 1 of them: of
// the whole region, the prices of all parts one behind the other, as CostMap::from() takes them.
std::uint64_t sample_count(const Region& region);
std::vector<double> prices_of(const world::World& world, const models::Registry& registry,
                              const Region& region, const CostRates& rates, std::uint64_t first,
                              std::uint64_t end);

// The costs of a region's blocks by their numbers.
class CostMap {
 public:
  // At most this many blocks are priced, and at most one in eight of regions with more than 512
  // blocks: together about 1 % of what synthesis takes.
  static constexpr std::uint64_t kMaxSamples = 4096;
  static constexpr std::uint64_t kBlocksPerSample = 8, kMinSamples = 64;

  // Prices a region, which check_region() has accepted.
  static CostMap of(const world::World& world, const models::Registry& registry,
                    const Region& region, const CostRates& rates);
  // Every block costs the same: 1 second.
  static CostMap flat(std::uint64_t blocks);
  // Known costs: `seconds[k]` for each block of the k-th of equally many stretches.
  static CostMap from(std::uint64_t blocks, std::vector<double> seconds);

  // The same with so much more for each block.
  CostMap plus(double seconds_per_block) const;

  std::uint64_t block_count() const { return blocks_; }
  double total_s() const { return until_.back(); }
  // The cost of blocks 0 … block − 1. Requires block <= block_count().
  double seconds_before(std::uint64_t block) const;
  double seconds_of(const BlockRanges& blocks) const;
  // The block at which this much of the cost is reached: the largest b <= block_count() with
  // seconds_before(b) <= seconds.
  std::uint64_t block_at(double seconds) const;

 private:
  std::uint64_t stretch_begin(std::size_t stretch) const;
  std::size_t stretch_of(std::uint64_t block) const;

  std::uint64_t blocks_ = 0;
  std::vector<double> each_;   // seconds per block, by stretch
  std::vector<double> until_;  // seconds before each stretch, and of all of them
};

// The share of shard `i` of `n`, 1 … n: consecutive blocks that cost an n-th of the map. Shares are
// disjoint and together hold every block; some may be empty where there are fewer blocks.
BlockRun shard_of(const CostMap& costs, std::uint64_t i, std::uint64_t n);

}  // namespace psygen::amplify
