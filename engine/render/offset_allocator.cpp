#include "engine/render/offset_allocator.hpp"

#include <bit>

#include "engine/core/assert.hpp"

namespace psygen::render {

OffsetAllocator::OffsetAllocator(std::uint32_t size) : size_(size), free_units_(size) {
  PSYGEN_CHECK(size >= 1, "an allocator needs at least one unit");
  heads_.fill(kNone);
  insert_free(make_node(0, size));
}

// Sizes below 8 have their own bins. Above, a bin is the exponent and the three bits after the
// leading one.
std::uint32_t OffsetAllocator::bin_below(std::uint32_t size) {
  if (size < kLeavesPerTop) return size;
  const auto high = static_cast<std::uint32_t>(std::bit_width(size)) - 1;
  const std::uint32_t shift = high - kLeafBits;
  return ((shift + 1) << kLeafBits) | ((size >> shift) & (kLeavesPerTop - 1));
}

std::uint32_t OffsetAllocator::bin_above(std::uint32_t size) {
  const std::uint32_t below = bin_below(size);
  return floor_of(below) == size ? below : below + 1;
}

std::uint32_t OffsetAllocator::floor_of(std::uint32_t bin) {
  if (bin < kLeavesPerTop) return bin;
  const std::uint32_t shift = (bin >> kLeafBits) - 1;
  return (kLeavesPerTop | (bin & (kLeavesPerTop - 1))) << shift;
}

std::uint32_t OffsetAllocator::find_bin(std::uint32_t from) const {
  const std::uint32_t top = from >> kLeafBits;
  if (top >= kTopCount) return kNone;
  const std::uint32_t first_leaf = from & (kLeavesPerTop - 1);
  const std::uint32_t leaves = leaves_[top] & (0xFFu << first_leaf);
  if (leaves != 0) {
    return (top << kLeafBits) | static_cast<std::uint32_t>(std::countr_zero(leaves));
  }
  if (top + 1 >= kTopCount) return kNone;
  const std::uint32_t tops = tops_ & (UINT32_MAX << (top + 1));
  if (tops == 0) return kNone;
  const auto found = static_cast<std::uint32_t>(std::countr_zero(tops));
  return (found << kLeafBits) |
         static_cast<std::uint32_t>(std::countr_zero(std::uint32_t{leaves_[found]}));
}

std::uint32_t OffsetAllocator::make_node(std::uint32_t offset, std::uint32_t size) {
  std::uint32_t index = static_cast<std::uint32_t>(nodes_.size());
  if (spare_nodes_.empty()) {
    nodes_.emplace_back();
  } else {
    index = spare_nodes_.back();
    spare_nodes_.pop_back();
  }
  nodes_[index] = Node{};
  nodes_[index].offset = offset;
  nodes_[index].size = size;
  return index;
}

void OffsetAllocator::insert_free(std::uint32_t node) {
  const std::uint32_t bin = bin_below(nodes_[node].size);
  nodes_[node].used = false;
  nodes_[node].bin_prev = kNone;
  nodes_[node].bin_next = heads_[bin];
  if (heads_[bin] != kNone) nodes_[heads_[bin]].bin_prev = node;
  heads_[bin] = node;
  leaves_[bin >> kLeafBits] |= static_cast<std::uint8_t>(1u << (bin & (kLeavesPerTop - 1)));
  tops_ |= 1u << (bin >> kLeafBits);
}

void OffsetAllocator::remove_free(std::uint32_t node) {
  const Node& n = nodes_[node];
  const std::uint32_t bin = bin_below(n.size);
  if (n.bin_next != kNone) nodes_[n.bin_next].bin_prev = n.bin_prev;
  if (n.bin_prev != kNone) {
    nodes_[n.bin_prev].bin_next = n.bin_next;
    return;
  }
  heads_[bin] = n.bin_next;
  if (heads_[bin] != kNone) return;
  std::uint8_t& leaves = leaves_[bin >> kLeafBits];
  leaves = static_cast<std::uint8_t>(leaves & ~(1u << (bin & (kLeavesPerTop - 1))));
  if (leaves == 0) tops_ &= ~(1u << (bin >> kLeafBits));
}

std::optional<OffsetAllocator::Allocation> OffsetAllocator::allocate(std::uint32_t size) {
  PSYGEN_ASSERT(size >= 1, "an allocation has at least one unit");
  const std::uint32_t bin = find_bin(bin_above(size));
  // If no bin fits for certain, the first range of the bin below may still be large enough.
  const std::uint32_t node = bin != kNone ? heads_[bin] : heads_[bin_below(size)];
  if (node == kNone || nodes_[node].size < size) return std::nullopt;
  remove_free(node);
  nodes_[node].used = true;
  const std::uint32_t rest = nodes_[node].size - size;
  if (rest > 0) {
    const std::uint32_t tail = make_node(nodes_[node].offset + size, rest);
    nodes_[node].size = size;
    nodes_[tail].left = node;
    nodes_[tail].right = nodes_[node].right;
    if (nodes_[node].right != kNone) nodes_[nodes_[node].right].left = tail;
    nodes_[node].right = tail;
    insert_free(tail);
  }
  free_units_ -= size;
  return Allocation{nodes_[node].offset, node};
}

void OffsetAllocator::free(std::uint32_t node) {
  PSYGEN_CHECK(node < nodes_.size() && nodes_[node].used, "free of a range that is not allocated");
  free_units_ += nodes_[node].size;
  const std::uint32_t left = nodes_[node].left;
  if (left != kNone && !nodes_[left].used) {
    remove_free(left);
    nodes_[node].offset = nodes_[left].offset;
    nodes_[node].size += nodes_[left].size;
    nodes_[node].left = nodes_[left].left;
    if (nodes_[node].left != kNone) nodes_[nodes_[node].left].right = node;
    spare_nodes_.push_back(left);
  }
  const std::uint32_t right = nodes_[node].right;
  if (right != kNone && !nodes_[right].used) {
    remove_free(right);
    nodes_[node].size += nodes_[right].size;
    nodes_[node].right = nodes_[right].right;
    if (nodes_[node].right != kNone) nodes_[nodes_[node].right].left = node;
    spare_nodes_.push_back(right);
  }
  insert_free(node);
}

}  // namespace psygen::render
