// Tests how evenly ranks finish, under a virtual clock that takes the predicted cost of each block
// as its time.
#include <gtest/gtest.h>

#include "engine/cluster/simulate.hpp"
#include "engine/core/hash.hpp"
#include "tests/engine/amplify/forest_world.hpp"

namespace psygen::cluster {
namespace {

using amplify::BlockRanges;
using amplify::BlockRun;
using amplify::CostMap;
using amplify::Region;
using world::testing::forest_in_a_desert;
using world::testing::registry;

// The predicted cost of each block of a region, and a plan made from a sample of the blocks.
struct Forest {
  world::World world = forest_in_a_desert(64);
  Region region = *amplify::whole(world);
  CostMap sampled = CostMap::of(world, registry(), region, {});
  std::vector<double> exact = amplify::prices_of(world, registry(), region, {}, 0, 0);

  Forest() {
    for (std::uint64_t i = 0; i < region.block_count(); ++i) {
      const core::BlockCoord at = region.block(i);
      const Region block{at.x, at.z, at.x + 1, at.z + 1};
      exact.push_back(amplify::prices_of(world, registry(), block, {}, 0, 1).front());
    }
  }
  // Simulates a job in which each block takes up to the fraction `error` more or less than
  // predicted.
  VirtualReport run(const Plan& plan, unsigned ranks, double error) const {
    VirtualJob job;
    job.ranks = ranks;
    job.threads = 2;
    job.limits.claim_latency_s = 2e-6;
    job.seconds_of = [&](const BlockRun& run) {
      double seconds = 0;
      for (std::uint64_t i = run.first; i < run.end; ++i) {
        const auto random = static_cast<double>(core::mix64(i) >> 11) * 0x1p-53;
        seconds += exact[i] * (1 + error * (2 * random - 1));
      }
      return seconds;
    };
    return simulate(plan, job);
  }
};

TEST(Balance, AForestInTheCornerOfADesertLeavesRanksIdleForLessThanATwentieth) {
  const Forest forest;
  const auto [least, most] = std::ranges::minmax_element(forest.exact);
  EXPECT_GT(*most, 100 * *least);
  const BlockRanges all({0, forest.region.block_count()});
  for (const unsigned ranks : {2u, 4u, 8u}) {
    for (const double error : {0.0, 0.3}) {
      const VirtualReport report = forest.run(Plan(all, forest.sampled, ranks), ranks, error);
      EXPECT_LE(report.worst_rank_idle, 0.05) << ranks << " ranks, error " << error;
      EXPECT_GE(report.efficiency, 0.95) << ranks << " ranks, error " << error;
    }
  }
}

// Shows that the measure distinguishes: with equal counts of blocks most ranks have no work.
TEST(Balance, EqualCountsOfBlocksBalanceBadly) {
  const Forest forest;
  const BlockRanges all({0, forest.region.block_count()});
  const CostMap flat = CostMap::flat(forest.region.block_count());
  const VirtualReport fixed = forest.run(Plan(all, flat, 8, {1.0, 0.0025}), 8, 0);
  EXPECT_GT(fixed.worst_rank_idle, 0.9);
  EXPECT_LT(fixed.efficiency, 0.6);
}

TEST(Balance, CompensatesForASlowRank) {
  const std::uint64_t blocks = 50'000;
  const Plan plan(BlockRanges({0, blocks}), CostMap::flat(blocks), 8);
  VirtualJob job;
  job.ranks = 8;
  const BlockRanges slow = plan.own(3);
  job.seconds_of = [&](const BlockRun& run) {
    const bool is_slow = run.first >= slow.at(0) && run.end <= slow.at(slow.count() - 1) + 1;
    return static_cast<double>(run.count()) * (is_slow ? 1.9e-3 : 1e-3);
  };
  EXPECT_LE(simulate(plan, job).worst_rank_idle, 0.02);
}

TEST(Balance, IsDeterministic) {
  const Forest forest;
  const Plan plan(BlockRanges({0, forest.region.block_count()}), forest.sampled, 4);
  const VirtualReport one = forest.run(plan, 4, 0.3), two = forest.run(plan, 4, 0.3);
  EXPECT_EQ(one.makespan_s, two.makespan_s);
  EXPECT_EQ(one.rank_end_s, two.rank_end_s);
}

// Known limits determine the makespan: it equals the time of the slowest resource.
TEST(Simulation, MeetsTheLimitsOfStorageMetadataLinksAndClaims) {
  const std::uint64_t blocks = 10'000;
  const Plan plan(BlockRanges({0, blocks}), CostMap::flat(blocks), 4);
  VirtualJob job;
  job.ranks = 4;
  job.threads = 8;
  job.seconds_of = [](const BlockRun& run) { return 1e-3 * static_cast<double>(run.count()); };
  job.bytes_of = [](const BlockRun& run) { return 1e6 * static_cast<double>(run.count()); };
  const double free_s = simulate(plan, job).makespan_s;
  EXPECT_NEAR(free_s, 10'000 * 1e-3 / 32, 0.04);
  job.limits.storage_bytes_per_second = 1e9;
  VirtualReport report = simulate(plan, job);
  EXPECT_NEAR(report.makespan_s, 10, 0.3);
  EXPECT_GT(report.storage_busy, 0.97);
  job.limits = {};
  job.limits.storage_files_per_second = 500;
  report = simulate(plan, job);
  EXPECT_NEAR(report.makespan_s, 20, 0.6);
  EXPECT_GT(report.metadata_busy, 0.97);
  job.limits = {};
  job.limits.rank_bytes_per_second = 1e8;
  report = simulate(plan, job);
  EXPECT_NEAR(report.makespan_s, 25, 1.0);
  EXPECT_GT(report.link_busy, 0.95);
  job.limits = {};
  job.limits.claims_per_second = 1;
  report = simulate(plan, job);
  EXPECT_GT(report.claims_busy, 0.9);
}

}  // namespace
}  // namespace psygen::cluster
