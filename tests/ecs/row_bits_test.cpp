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

TEST(RowBits, runs_join_across_words_and_summary_words) {
  RowBits bits;
  bits.reserve_rows(20000);
  bits.mark_range(60, 10);
  bits.mark_range(4000, 5000);
  bits.mark(19999);
  EXPECT_EQ(drain(bits), (Runs{{60, 10}, {4000, 5000}, {19999, 1}}));
  EXPECT_FALSE(bits.any());
  EXPECT_EQ(drain(bits), Runs{});
}

TEST(RowBits, the_first_row_and_whole_words_are_runs_of_their_own) {
  RowBits bits;
  bits.reserve_rows(256);
  bits.mark(0);
  bits.mark_range(64, 64);
  EXPECT_EQ(drain(bits), (Runs{{0, 1}, {64, 64}}));
}

TEST(RowBits, rows_marked_behind_the_current_run_wait_for_the_next_drain) {
  RowBits bits;
  bits.reserve_rows(1000);
  bits.mark(10);
  bits.mark(500);
  Runs seen;
  bits.drain([&](std::uint32_t first, std::uint32_t count) {
    seen.emplace_back(first, count);
    bits.mark(3);
  });
  EXPECT_EQ(seen, (Runs{{10, 1}, {500, 1}}));
  EXPECT_EQ(drain(bits), (Runs{{3, 1}}));
}

TEST(RowBits, random_marks_and_clears_agree_with_a_set) {
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
