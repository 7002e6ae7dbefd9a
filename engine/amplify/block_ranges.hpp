// Indices of blocks of a region (Region::block) as sorted, disjoint, half-open ranges, so that a
// part of billions of blocks is a few numbers. Plain values and pure functions, any thread;
// O(number of ranges) each, at() and sub() O(log). It knows no blocks and no meshes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace psygen::amplify {

// Blocks first … end − 1.
struct BlockRun {
  std::uint64_t first = 0, end = 0;
  std::uint64_t count() const { return end - first; }
  friend bool operator==(const BlockRun&, const BlockRun&) = default;
};

// A set of block numbers. The k-th of them in ascending order is at position k.
class BlockRanges {
 public:
  // No blocks, or those of one run.
  BlockRanges() = default;
  explicit BlockRanges(BlockRun run) { append(run); }

  // Appends a run that begins at or after the end of the last one. Adjacent runs become one range.
  void append(BlockRun run);
  std::uint64_t count() const { return ends_.empty() ? 0 : ends_.back(); }
  std::span<const BlockRun> runs() const& { return runs_; }
  std::span<const BlockRun> runs() && = delete;
  // The block index at a position. Requires position < count().
  std::uint64_t at(std::uint64_t position) const;
  // The blocks at positions first … end − 1. Requires first <= end <= count().
  BlockRanges sub(std::uint64_t first, std::uint64_t end) const;
  // These blocks without those of `others`.
  BlockRanges without(const BlockRanges& others) const;
  // For messages: "0-7, 12, 20-31", truncated after the first few.
  std::string text() const;
  friend bool operator==(const BlockRanges&, const BlockRanges&) = default;

 private:
  std::vector<BlockRun> runs_;
  std::vector<std::uint64_t> ends_;  // number of blocks up to the end of each run
};

}  // namespace psygen::amplify
