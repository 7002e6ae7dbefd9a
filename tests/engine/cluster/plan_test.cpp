#include "engine/cluster/plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace psygen::cluster {
namespace {

using amplify::BlockRanges;
using amplify::BlockRun;
using amplify::CostMap;

BlockRanges all_of(const Plan& plan, unsigned ranks) {
  std::vector<BlockRun> runs;
  const auto add = [&runs](const BlockRanges& part) {
    runs.insert(runs.end(), part.runs().begin(), part.runs().end());
  };
  for (unsigned rank = 0; rank < ranks; ++rank)
    add(plan.own(rank));
  for (std::uint64_t i = 0; i < plan.chunk_count(); ++i)
    add(plan.chunk(i));
  std::ranges::sort(runs, {}, &BlockRun::first);
  BlockRanges all;  // aborts if two parts have a block in common
  for (const BlockRun& run : runs)
    all.append(run);
  return all;
}

TEST(Plan, AssignsEveryBlockOnce) {
  std::mt19937 random(5);
  for (int round = 0; round < 200; ++round) {
    const std::uint64_t blocks = 1 + random() % 500;
    std::vector<double> seconds(1 + random() % std::min<std::uint64_t>(blocks, 40));
    for (double& s : seconds)
      s = random() % 8 == 0 ? 1.0 : 0.01;
    BlockRanges done;
    for (std::uint64_t i = 0; i < blocks; ++i)
      if (random() % 4 == 0) done.append({i, i + 1});
    const BlockRanges todo = BlockRanges({0, blocks}).without(done);
    const unsigned ranks = 1 + static_cast<unsigned>(random() % 9);
    const Plan plan(todo, CostMap::from(blocks, seconds), ranks);
    EXPECT_EQ(all_of(plan, ranks), todo) << blocks << " blocks, " << ranks << " ranks";
  }
}

TEST(Plan, OneRankHasNothingToClaim) {
  const Plan plan(BlockRanges({0, 1000}), CostMap::flat(1000), 1);
  EXPECT_EQ(plan.own(0).count(), 1000u);
  EXPECT_EQ(plan.chunk_count(), 0u);
}

TEST(Plan, ChunksBecomeSmallerAndAreFew) {
  constexpr std::uint64_t kBlocks = 100'000;
  constexpr unsigned kRanks = 16;
  const Plan plan(BlockRanges({0, kBlocks}), CostMap::flat(kBlocks), kRanks);
  EXPECT_EQ(plan.own(3).count(), kBlocks / kRanks / 2);
  for (std::uint64_t i = 1; i < plan.chunk_count(); ++i)
    EXPECT_LE(plan.chunk(i).count(), plan.chunk(i - 1).count() + 1);
  EXPECT_LE(plan.chunk(plan.chunk_count() - 1).count(), kBlocks / kRanks / 300);
  // Counts one failed claim of each rank, and the messages at the start and the end.
  EXPECT_LT(static_cast<double>(plan.chunk_count() + kRanks), 0.0025 * kBlocks);
}

TEST(Plan, AssignsExpensiveGroundToMoreRanks) {
  const Plan plan(BlockRanges({0, 1000}), CostMap::from(1000, {100, 1, 1, 1}), 4);
  EXPECT_LT(plan.own(0).count(), 60u);
  EXPECT_LT(plan.own(2).count(), 60u);
  std::uint64_t cheap = 0;
  for (std::uint64_t i = 0; i < plan.chunk_count(); ++i)
    cheap = std::max(cheap, plan.chunk(i).count());
  EXPECT_GT(cheap, 80u);
}

TEST(Plan, OfNoBlocksIsEmpty) {
  const Plan plan(BlockRanges(), CostMap::flat(10), 3);
  EXPECT_EQ(all_of(plan, 3).count(), 0u);
}

}  // namespace
}  // namespace psygen::cluster
