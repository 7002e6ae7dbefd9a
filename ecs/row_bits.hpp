// One bit per row and one summary bit per 64 rows: the rows of a column that changed since a
// reader's last drain. Marking is O(1). Draining costs one summary word per 4096 rows plus the
// marked rows. Not synchronised: one thread writes a RowBits at a time.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace psygen::ecs::detail {

// The bits of one table for one reader. Row arguments are below the reserved count.
class RowBits {
 public:
  // Provides bits for rows [0, count). New bits are clear.
  void reserve_rows(std::size_t count) {
    if (count > words_.size() * 64) grow(count);
  }

  // Marks one row. O(1).
  void mark(std::uint32_t row) {
    words_[row / 64] |= bit(row % 64);
    summary_[row / 4096] |= bit(row / 64 % 64);
    any_ = true;
  }
  // Both set or clear rows [first, first + count). O(count / 64).
  void mark_range(std::uint32_t first, std::uint32_t count);
  void clear_range(std::uint32_t first, std::uint32_t count);
  // Copies the bit of row `from` of `source`, which may be this object, to row `to`.
  void copy_bit(std::uint32_t to, const RowBits& source, std::uint32_t from) {
    if (source.test(from)) {
      mark(to);
    } else {
      words_[to / 64] &= ~bit(to % 64);
    }
  }
  // True if the row is marked.
  bool test(std::uint32_t row) const { return (words_[row / 64] & bit(row % 64)) != 0; }
  // False only if every bit is clear; true may be out of date.
  bool any() const { return any_; }
  // Hints that mark(row) follows soon.
  void prefetch(std::uint32_t row) const { __builtin_prefetch(words_.data() + row / 64, 1); }

  // Clears every marked row and calls f(first, count) once per maximal run of them, ascending. `f`
  // may mark rows: this drain or the next one reports them.
  template <class F>
  void drain(F&& f);

 private:
  static constexpr std::uint64_t bit(std::uint32_t i) { return std::uint64_t{1} << i; }
  void grow(std::size_t count);

  std::vector<std::uint64_t> words_;
  std::vector<std::uint64_t> summary_;
  bool any_ = false;
};

template <class F>
void RowBits::drain(F&& f) {
  struct Run {
    std::uint32_t first;
    std::uint32_t end;
  };
  if (!any_) return;
  any_ = false;
  // Runs are collected before `f` sees them: two short loops instead of one long one. The last run
  // waits because the next word may continue it.
  std::array<Run, 256> runs;
  std::size_t last = 0;
  runs[0] = {UINT32_MAX, UINT32_MAX};  // empty, and no row continues it
  const auto hand_out = [&](std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      if (runs[i].first != runs[i].end) f(runs[i].first, runs[i].end - runs[i].first);
    }
  };
  for (std::uint32_t s = 0; s < summary_.size(); ++s) {
    for (std::uint64_t blocks = std::exchange(summary_[s], 0); blocks != 0; blocks &= blocks - 1) {
      const std::uint32_t w = s * 64 + static_cast<std::uint32_t>(std::countr_zero(blocks));
      std::uint64_t word = std::exchange(words_[w], 0);
      if (last + 32 >= runs.size()) {  // a word has at most 32 runs
        hand_out(last);
        runs[0] = runs[last];
        last = 0;
      }
      while (word != 0) {
        const std::uint64_t lowest = word & (~word + 1);
        const std::uint64_t carried = word + lowest;  // the lowest run becomes zeros and a one
        const std::uint32_t first = w * 64 + static_cast<std::uint32_t>(std::countr_zero(word));
        const std::uint32_t end = w * 64 + static_cast<std::uint32_t>(std::countr_zero(carried));
        if (first != runs[last].end) runs[++last].first = first;
        runs[last].end = end;
        word &= carried;
      }
    }
  }
  hand_out(last + 1);
}

}  // namespace psygen::ecs::detail
