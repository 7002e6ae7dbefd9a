// Allocates ranges of a line of units: O(1) allocate and free with two levels of size bins; free
// neighbours are merged. It knows offsets, not memory. Not thread-safe.
// Source: two-level segregated fit (Masmano et al. 2004). Bins are sizes as floats with a mantissa
// of 3 bits, so the search ignores at most 1/8 of a free range's size.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace psygen::render {

// One line of units.
class OffsetAllocator {
 public:
  // An allocated range.
  struct Allocation {
    std::uint32_t offset = 0;  // in units
    std::uint32_t node = 0;    // identifies the range for free()
  };

  // A line of `size` units, all free. size >= 1, which is checked.
  explicit OffsetAllocator(std::uint32_t size);

  // Allocates `size` >= 1 units. Nothing if no free range is found that is large enough.
  std::optional<Allocation> allocate(std::uint32_t size);
  // Frees a range. `node` must be allocated, which is checked in release too.
  void free(std::uint32_t node);

  // Units of the line, and free units.
  std::uint32_t size() const { return size_; }
  std::uint32_t free_units() const { return free_units_; }

 private:
  static constexpr std::uint32_t kNone = UINT32_MAX;
  static constexpr std::uint32_t kLeafBits = 3;
  static constexpr std::uint32_t kLeavesPerTop = 1u << kLeafBits;
  static constexpr std::uint32_t kTopCount = 32;

  struct Node {
    std::uint32_t offset = 0, size = 0;
    std::uint32_t left = kNone, right = kNone;         // neighbours on the line
    std::uint32_t bin_prev = kNone, bin_next = kNone;  // neighbours in the bin
    bool used = false;
  };

  static std::uint32_t bin_below(std::uint32_t size);  // largest bin whose floor is <= size
  static std::uint32_t bin_above(std::uint32_t size);  // smallest bin whose floor is >= size
  static std::uint32_t floor_of(std::uint32_t bin);

  std::uint32_t find_bin(std::uint32_t from) const;
  std::uint32_t make_node(std::uint32_t offset, std::uint32_t size);
  void insert_free(std::uint32_t node);
  void remove_free(std::uint32_t node);

  std::uint32_t size_;
  std::uint32_t free_units_;
  std::uint32_t tops_ = 0;                        // one bit per top level that has a free range
  std::array<std::uint8_t, kTopCount> leaves_{};  // one bit per leaf of each top level
  std::array<std::uint32_t, kTopCount * kLeavesPerTop> heads_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> spare_nodes_;
};

}  // namespace psygen::render
