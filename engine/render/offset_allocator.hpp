// Hands out ranges of a line of units: O(1) allocate and free with two levels of size bins and
// coalescing neighbours. It knows offsets, not memory. Not thread-safe.
// Source: two-level segregated fit (Masmano et al. 2004); bins are 3-bit floats of the size, so
// that at most 1/8 of a free range's size is overlooked.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace psygen::render {

class OffsetAllocator {
 public:
  struct Allocation {
    std::uint32_t offset = 0;  // in units
    std::uint32_t node = 0;    // names the range to free()
  };

  // A line of `size` units, all free. size >= 1.
  explicit OffsetAllocator(std::uint32_t size);

  // `size` >= 1 units, or nothing when no free range is found that is large enough.
  std::optional<Allocation> allocate(std::uint32_t size);
  // Gives a range back. `node` must be allocated.
  void free(std::uint32_t node);

  std::uint32_t size() const { return size_; }
  std::uint32_t free_units() const { return free_units_; }
  // A size up to which an allocation is certain to succeed now.
  std::uint32_t largest_certain() const;

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
  std::uint32_t tops_ = 0;                        // bit per top level that has a free range
  std::array<std::uint8_t, kTopCount> leaves_{};  // bit per leaf of each top level
  std::array<std::uint32_t, kTopCount * kLeavesPerTop> heads_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> spare_nodes_;
};

}  // namespace psygen::render
