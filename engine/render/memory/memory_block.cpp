#include "engine/render/memory/memory_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

namespace psygen::render {

using core::Result;

namespace {

// The error for an allocation that no memory type of the driver allows; nothing: it is allowed.
std::optional<core::Error> too_large(const Device& device, const VkMemoryRequirements& needs) {
  const auto refuse = [&needs](std::string_view what, std::uint64_t bytes) {
    return core::Error{core::ErrorCode::kOutOfMemory,
                       fmt::format("allocating {} bytes of device memory failed: {} {} bytes at "
                                   "once",
                                   needs.size, what, bytes)};
  };
  if (device.info.max_allocation_bytes < needs.size)
    return refuse("the driver allows", device.info.max_allocation_bytes);
  std::uint64_t largest = 0;
  for (std::uint32_t i = 0; i < device.memory.memoryTypeCount; ++i) {
    const std::uint32_t heap = device.memory.memoryTypes[i].heapIndex;
    if ((needs.memoryTypeBits >> i & 1u) != 0)
      largest = std::max(largest, device.memory.memoryHeaps[heap].size / 4);
  }
  if (largest < needs.size) return refuse("a quarter of the driver's largest heap allows", largest);
  return std::nullopt;
}

std::uint64_t aligned(std::uint64_t bytes, std::uint64_t alignment) {
  return (bytes + alignment - 1) / alignment * alignment;
}

// A range of a shared block; nothing: the block is full.
std::optional<MemoryRange> take(const std::shared_ptr<MemoryBlock>& block,
                                const VkMemoryRequirements& needs) {
  constexpr std::uint64_t kUnit = MemoryBlock::kUnitBytes;
  // Every range starts at a multiple of the unit. A larger alignment may skip units.
  const std::uint64_t skipped = std::max(needs.alignment, kUnit) - kUnit;
  const std::uint64_t units = aligned(needs.size + skipped, kUnit) / kUnit;
  const auto range = block->ranges->allocate(static_cast<std::uint32_t>(units));
  if (!range) return std::nullopt;
  return MemoryRange(block, range->node, aligned(range->offset * kUnit, needs.alignment));
}

// Memory of one type: of a shared block if it is small.
Result<MemoryRange> allocate_of(const Device& device, const MemoryWish& wish, std::uint32_t type) {
  const bool small = wish.needs.size < MemoryBlock::kSmallBytes;
  std::erase_if(device.shared_blocks, [](const auto& block) { return block.expired(); });
  for (const auto& shared : device.shared_blocks) {
    const std::shared_ptr<MemoryBlock> block = shared.lock();
    if (!small || block->type != type || block->images != wish.image) continue;
    if (auto range = take(block, wish.needs)) return *std::move(range);
  }
  const std::uint64_t bytes = small ? MemoryBlock::kSharedBytes : wish.needs.size;
  const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                  .allocationSize = bytes,
                                  .memoryTypeIndex = type};
  VkDeviceMemory memory = VK_NULL_HANDLE;
  const VkResult result = device.vk.vkAllocateMemory(device.handle, &info, nullptr, &memory);
  if (result != VK_SUCCESS)
    return vulkan_failure(result,
                          fmt::format("allocating {} bytes of device memory", bytes).c_str());
  auto block = std::make_shared<MemoryBlock>();
  block->memory = UniqueMemory(device.vk, device.handle, memory, bytes);
  block->type = type;
  block->images = wish.image;
  if (!small) return MemoryRange(block, 0, 0);
  block->ranges.emplace(static_cast<std::uint32_t>(bytes / MemoryBlock::kUnitBytes));
  device.shared_blocks.push_back(block);
  return *take(block, wish.needs);
}

}  // namespace

Result<std::byte*> MemoryRange::map(const Device& device) const {
  if (block_->mapped == nullptr) {
    void* mapped = nullptr;
    const VkResult result =
        device.vk.vkMapMemory(device.handle, memory(), 0, VK_WHOLE_SIZE, 0, &mapped);
    if (result != VK_SUCCESS) return vulkan_failure(result, "mapping device memory");
    block_->mapped = static_cast<std::byte*>(mapped);
  }
  return block_->mapped + offset_;
}

Result<MemoryRange> allocate(const Device& device, const MemoryWish& wish,
                             std::initializer_list<VkMemoryPropertyFlags> properties) {
  const VkMemoryRequirements& needs = wish.needs;
  if (auto error = too_large(device, needs)) return tl::unexpected(*std::move(error));
  Result<MemoryRange> made = core::fail(core::ErrorCode::kOutOfMemory, "no memory type fits");
  for (const VkMemoryPropertyFlags wanted : properties) {
    for (std::uint32_t i = 0; i < device.memory.memoryTypeCount && !made; ++i) {
      const VkMemoryType& type = device.memory.memoryTypes[i];
      if ((needs.memoryTypeBits >> i & 1u) == 0 || (type.propertyFlags & wanted) != wanted)
        continue;
      if (device.memory.memoryHeaps[type.heapIndex].size / 4 < needs.size) continue;
      made = allocate_of(device, wish, i);
    }
  }
  return made;
}

}  // namespace psygen::render
