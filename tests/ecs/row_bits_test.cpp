#include "ecs/row_bits.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace psygen::ecs::detail {
namespace {

using Runs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Runs drain(RowBits& bits) {
  Runs runs;
  bits.drain([&](std::uint32_t first, std::uint32_t count) { runs.emplace_back(first, count); });
  return runs;
}

TEST(RowBits, RunsJoinAcrossWordsAndSummaryWords) {
  RowBits bits;
  bits.reserve_rows(20000);
  bits.mark_range(60, 10);
  bits.mark_range(4000, 5000);
  bits.mark(19999);
  EXPECT_EQ(drain(bits), (Runs{{60, 10}, {4000, 5000}, {19999, 1}}));
  EXPECT_FALSE(bits.any());
  EXPECT_EQ(drain(bits), Runs{});
}

TEST(RowBits, TheFirstRowAndWholeWordsAreSeparateRuns) {
  RowBits bits;
  bits.reserve_rows(256);
  bits.mark(0);
  bits.mark_range(64, 64);
  EXPECT_EQ(drain(bits), (Runs{{0, 1}, {64, 64}}));
}

TEST(RowBits, RowsMarkedWhileDrainingAreNotLost) {
  RowBits bits;
  bits.reserve_rows(100000);
  for (std::uint32_t row = 0; row < 100000; row += 100)
    bits.mark(row);
  std::set<std::uint32_t> seen;
  const auto note = [&](std::uint32_t first, std::uint32_t count) {
    EXPECT_EQ(count, 1U);
    EXPECT_TRUE(seen.insert(first).second) << "each mark is seen once";
    if (first % 100 == 0) bits.mark((first * 7 + 50) % 100000);
  };
  bits.drain(note);
  EXPECT_GE(seen.size(), 1000U);
  bits.drain(note);
  EXPECT_EQ(seen.size(), 2000U);
  EXPECT_EQ(drain(bits), Runs{});
}

TEST(RowBits, EveryPatternOfRunsWithinAWordIsDrained) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 2000; ++round) {
    const std::uint64_t word = round == 0 ? ~std::uint64_t{0} : random() | (random() & random());
    RowBits bits;
    bits.reserve_rows(256);
    std::uint64_t seen = 0;
    for (std::uint32_t i = 0; i < 64; ++i) {
      if (((word >> i) & 1) != 0) bits.mark(64 + i);
    }
    for (const auto& [first, count] : drain(bits)) {
      for (std::uint32_t row = first; row < first + count; ++row) {
        seen |= std::uint64_t{1} << (row - 64);
      }
    }
    ASSERT_EQ(seen, word);
  }
}

TEST(RowBits, RandomMarksAndClearsAgreeWithASet) {
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    std::mt19937 engine(seed);
    const auto random = [&] { return static_cast<std::uint32_t>(engine()); };
    RowBits bits;
    std::set<std::uint32_t> model;
    for (int step = 0; step < 3000; ++step) {
      const std::uint32_t rows = 1000 + static_cast<std::uint32_t>(step);
      bits.reserve_rows(rows);
      const std::uint32_t first = random() % rows;
      const std::uint32_t count = random() % std::min(rows - first, 200U);
      const std::uint32_t action = random() % 100;
      if (action < 60) {
        bits.mark(first);
        model.insert(first);
      } else if (action < 75) {
        bits.mark_range(first, count);
        for (std::uint32_t r = first; r < first + count; ++r)
          model.insert(r);
      } else if (action < 90) {
        bits.clear_range(first, count);
        for (std::uint32_t r = first; r < first + count; ++r)
          model.erase(r);
      } else if (action < 95) {
        const std::uint32_t from = random() % rows;
        bits.copy_bit(first, bits, from);
        if (model.contains(from)) {
          model.insert(first);
        } else {
          model.erase(first);
        }
      } else {
        std::set<std::uint32_t> drained;
        std::uint32_t previous_end = UINT32_MAX;
        for (const auto& [begin, length] : drain(bits)) {
          EXPECT_NE(begin, previous_end) << "two runs that touch should be one";
          previous_end = begin + length;
          for (std::uint32_t r = begin; r < begin + length; ++r)
            drained.insert(r);
        }
        ASSERT_EQ(drained, model);
        model.clear();
      }
    }
  }
}

}  // namespace
}  // namespace psygen::ecs::detail
