// The renderer's geometry memory: a few large blocks, each a buffer with vertices and indices and
// an offset allocator. The CPU writes that buffer, mapped, or its mirror on the heap
// (staged_geometry.hpp). Blocks are created when first needed and kept. Their sum never exceeds the
// budget; if no more can be created, the capacity is the sum of the existing ones. A released range
// is reused only after the device has finished the last frame submitted before the release. Main
// thread. Knows no Vulkan: a BlockSource creates the blocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "engine/core/geometry_memory.hpp"
#include "engine/render/memory/offset_allocator.hpp"

namespace psygen::render {

// The pool. reserve() is O(blocks), release() O(1).
class GeometryPool : public core::GeometryMemory {
 public:
  static constexpr std::uint64_t kBlockBytes = 64ull << 20;
  // If there is no memory for a whole block, smaller ones are tried, down to this size.
  static constexpr std::uint64_t kMinBlockBytes = 4ull << 20;
  static constexpr std::uint32_t kUnitBytes = 16;  // unit of allocation

  // Creates the next block of `bytes` and returns the memory to write, 16-byte aligned. The pool's
  // owner frees it, after the pool.
  using BlockSource = std::function<core::Result<std::byte*>(std::uint64_t bytes)>;

  // `budget_bytes` is rounded down to a multiple of 16.
  GeometryPool(std::uint64_t budget_bytes, BlockSource source);
  // Creates the first block in advance. Fails with the error of the source; then there is no
  // geometry memory at all.
  core::Result<void> make_first_block() { return add_block(kUnitBytes); }

  // core::GeometryMemory.
  core::Result<core::GeometryReservation> reserve(core::VertexLayout layout,
                                                  std::uint32_t vertex_count,
                                                  std::uint32_t index_count) override;
  void commit(const core::GeometryRange& range) override;
  void release(const core::GeometryRange& range) override;
  std::uint32_t charged_bytes(core::VertexLayout layout, std::uint32_t vertex_count,
                              std::uint32_t index_count) const override;
  std::uint64_t used_bytes() const override { return used_bytes_; }
  std::uint64_t capacity_bytes() const override {
    return no_more_blocks_ ? block_bytes_total_ : budget_bytes_;
  }
  bool zero_copy() const override { return true; }
  std::span<const std::byte> vertex_bytes(const core::GeometryRange& range) const override;
  std::span<const std::uint16_t> indices(const core::GeometryRange& range) const override;

  // Call it after a submission: the frame signals `value` and may read every committed range.
  void frame_submitted(std::uint64_t value) { submitted_ = value; }
  // Call it when the device has passed `value`. Ranges released before the next frame become free.
  void frames_finished(std::uint64_t value);

  // True if a range may be drawn; the number of blocks, and their sum in bytes.
  bool is_committed(const core::GeometryRange& range) const;
  std::size_t block_count() const { return blocks_.size(); }
  std::uint64_t block_bytes_total() const { return block_bytes_total_; }

 private:
  enum class SlotState : std::uint8_t { kFree, kReserved, kCommitted, kReleased };
  struct Slot {
    std::uint32_t block = 0, node = 0;
    std::uint32_t offset_bytes = 0, vertex_bytes = 0, index_count = 0, bytes = 0;
    SlotState state = SlotState::kFree;
  };
  struct Block {
    std::byte* mapped;
    OffsetAllocator allocator;
  };
  struct Pending {
    std::uint64_t value;
    std::uint32_t id;
  };

  core::Result<std::uint32_t> allocate_slot(std::uint32_t bytes);
  core::Result<void> add_block(std::uint32_t min_bytes);
  void free_slot(std::uint32_t id);

  std::uint64_t budget_bytes_;
  BlockSource source_;
  std::uint64_t used_bytes_ = 0;
  std::uint64_t block_bytes_total_ = 0;
  bool no_more_blocks_ = false;  // the last call of the source failed
  std::uint64_t submitted_ = 0;
  std::uint64_t finished_ = 0;
  std::vector<Block> blocks_;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> spare_slots_;
  std::deque<Pending> pending_;  // released ranges, in order of value
};

}  // namespace psygen::render
