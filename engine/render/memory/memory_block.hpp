// Device memory of buffers and images. Small ones share blocks, because drivers limit the number of
// allocations and round each up. A block is freed with its last range. Meshes have memory of their
// own (geometry_pool.hpp). Main thread. Private to engine/render.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <utility>

#include "engine/render/device/device.hpp"
#include "engine/render/memory/offset_allocator.hpp"

namespace psygen::render {

// An allocation of the driver.
struct MemoryBlock {
  UniqueMemory memory;
  std::uint32_t type = 0;  // index of the memory type
  bool images = false;     // of images, else of buffers, which must not share pages with images
  std::byte* mapped = nullptr;
  std::optional<OffsetAllocator> ranges;  // of a shared block, in units of kUnitBytes

  static constexpr std::uint64_t kUnitBytes = 256;
  static constexpr std::uint64_t kSharedBytes = std::uint64_t{4} << 20;  // of a shared block
  static constexpr std::uint64_t kSmallBytes = std::uint64_t{1} << 20;   // less shares a block
};

// An owned range of a block. Empty, or valid as long as the device. Move-only.
class MemoryRange {
 public:
  MemoryRange() = default;
  // `node`: of a shared block, which the range frees.
  MemoryRange(std::shared_ptr<MemoryBlock> block, std::uint32_t node, std::uint64_t offset)
      : block_(std::move(block)), node_(node), offset_(offset) {}
  MemoryRange(MemoryRange&& other) noexcept
      : block_(std::move(other.block_)), node_(other.node_), offset_(other.offset_) {}
  MemoryRange& operator=(MemoryRange&& other) noexcept {
    std::swap(block_, other.block_);
    std::swap(node_, other.node_);
    std::swap(offset_, other.offset_);
    return *this;
  }
  ~MemoryRange() {
    if (block_ && block_->ranges) block_->ranges->free(node_);
  }

  // The allocation of the driver, and the range's first byte in it.
  VkDeviceMemory memory() const { return block_->memory.get(); }
  std::uint64_t offset() const { return offset_; }
  // The first byte in the memory of the process; maps the block if necessary. The memory type must
  // be host-visible. Fails like vulkan_failure().
  core::Result<std::byte*> map(const Device& device) const;

 private:
  std::shared_ptr<MemoryBlock> block_;
  std::uint32_t node_ = 0;
  std::uint64_t offset_ = 0;
};

// The memory that a buffer or an image asks for.
struct MemoryWish {
  VkMemoryRequirements needs;
  bool image = false;
};

// Allocates memory of the first type with one of the sets of properties in `properties`, tried in
// order. Skips heaps smaller than four times the allocation. Fails with kOutOfMemory; the message
// has the bytes, and the driver's limit if they are more.
core::Result<MemoryRange> allocate(const Device& device, const MemoryWish& wish,
                                   std::initializer_list<VkMemoryPropertyFlags> properties);

}  // namespace psygen::render
