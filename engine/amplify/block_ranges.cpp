#include "engine/amplify/block_ranges.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/assert.hpp"

namespace psygen::amplify {

void BlockRanges::append(BlockRun run) {
  PSYGEN_ASSERT(run.first <= run.end, "a run must not end before it begins");
  PSYGEN_ASSERT(runs_.empty() || run.first >= runs_.back().end, "runs must be in ascending order");
  if (run.first == run.end) return;
  const std::uint64_t total = count() + run.count();
  if (!runs_.empty() && runs_.back().end == run.first) {
    runs_.back().end = run.end;
    ends_.back() = total;
    return;
  }
  runs_.push_back(run);
  ends_.push_back(total);
}

std::uint64_t BlockRanges::at(std::uint64_t position) const {
  PSYGEN_ASSERT(position < count(), "the position must be below count()");
  const auto after = std::ranges::upper_bound(ends_, position);
  const auto i = static_cast<std::size_t>(after - ends_.begin());
  return runs_[i].end - (ends_[i] - position);
}

BlockRanges BlockRanges::sub(std::uint64_t first, std::uint64_t end) const {
  BlockRanges part;
  const auto start = std::ranges::upper_bound(ends_, first);
  for (auto i = static_cast<std::size_t>(start - ends_.begin()); i < runs_.size(); ++i) {
    const std::uint64_t from = ends_[i] - runs_[i].count();
    if (from >= end) break;
    const std::uint64_t low = std::max(first, from), high = std::min(end, ends_[i]);
    part.append({runs_[i].first + (low - from), runs_[i].first + (high - from)});
  }
  return part;
}

BlockRanges BlockRanges::without(const BlockRanges& others) const {
  BlockRanges rest;
  auto other = others.runs_.begin();
  for (BlockRun run : runs_) {
    while (other != others.runs_.end() && other->end <= run.first)
      ++other;
    for (auto cut = other; cut != others.runs_.end() && cut->first < run.end; ++cut) {
      rest.append({run.first, std::max(run.first, cut->first)});
      run.first = std::min(run.end, cut->end);
    }
    rest.append(run);
  }
  return rest;
}

std::string BlockRanges::text() const {
  constexpr std::size_t kMaxShown = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMaxShown, runs_.size()); ++i) {
    const BlockRun& run = runs_[i];
    text += fmt::format("{}{}", i == 0 ? "" : ", ", run.first);
    if (run.count() > 1) text += fmt::format("-{}", run.end - 1);
  }
  if (runs_.size() > kMaxShown) text += ", …";
  return text;
}

}  // namespace psygen::amplify
