#include "engine/amplify/block_ranges.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace psygen::amplify {
namespace {

BlockRanges ranges(std::initializer_list<BlockRun> runs) {
  BlockRanges all;
  for (const BlockRun& run : runs)
    all.append(run);
  return all;
}

std::set<std::uint64_t> numbers(const BlockRanges& blocks) {
  std::set<std::uint64_t> all;
  for (const BlockRun& run : blocks.runs())
    for (std::uint64_t i = run.first; i < run.end; ++i)
      all.insert(i);
  return all;
}

BlockRanges from(const std::set<std::uint64_t>& all) {
  BlockRanges blocks;
  for (const std::uint64_t i : all)
    blocks.append({i, i + 1});
  return blocks;
}

TEST(BlockRanges, AdjacentRunsAreOneRangeAndEmptyRunsAreDropped) {
  const BlockRanges blocks = ranges({{1, 4}, {4, 4}, {4, 6}, {9, 10}});
  ASSERT_EQ(blocks.runs().size(), 2u);
  EXPECT_EQ(blocks.runs()[0], (BlockRun{1, 6}));
  EXPECT_EQ(blocks.count(), 6u);
  EXPECT_EQ(blocks.at(4), 5u);
  EXPECT_EQ(blocks.at(5), 9u);
  EXPECT_EQ(blocks.text(), "1-5, 9");
  EXPECT_EQ(BlockRanges().count(), 0u);
  EXPECT_EQ(BlockRanges().text(), "");
}

TEST(BlockRanges, BehaveLikeSetsOfNumbers) {
  std::mt19937 random(1);  // the same numbers everywhere
  for (int round = 0; round < 300; ++round) {
    std::set<std::uint64_t> a, b;
    for (int k = 0; k < 20; ++k) {
      a.insert(random() % 32);
      b.insert(random() % 32);
    }
    std::set<std::uint64_t> rest;
    for (const std::uint64_t i : a)
      if (!b.contains(i)) rest.insert(i);
    EXPECT_EQ(numbers(from(a).without(from(b))), rest);
    const std::uint64_t first = random() % (a.size() + 1),
                        end = first + random() % (a.size() - first + 1);
    const std::set<std::uint64_t> part(std::next(a.begin(), static_cast<std::ptrdiff_t>(first)),
                                       std::next(a.begin(), static_cast<std::ptrdiff_t>(end)));
    EXPECT_EQ(numbers(from(a).sub(first, end)), part);
    std::uint64_t position = 0;
    for (const std::uint64_t i : a)
      EXPECT_EQ(from(a).at(position++), i);
  }
}

TEST(BlockRanges, HoldMoreBlocksThanThereIsMemory) {
  const BlockRanges all({0, UINT64_MAX});
  const BlockRanges rest = all.without(ranges({{5, 6}}));
  EXPECT_EQ(rest.count(), UINT64_MAX - 1);
  EXPECT_EQ(rest.at(UINT64_MAX - 2), UINT64_MAX - 1);
}

}  // namespace
}  // namespace psygen::amplify
