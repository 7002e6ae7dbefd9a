#include "engine/render/memory/slot_buffer.hpp"

#include <cstring>

namespace psygen::render {

using core::Result;

Result<void> SlotBuffer::create(const Device& device, std::size_t slots, std::uint64_t bytes,
                                VkBufferUsageFlags usage) {
  usage_ = usage;
  buffers_.clear();
  for (std::size_t i = 0; i < slots; ++i) {
    Result<Buffer> made = make_buffer(device, bytes, usage, MemoryUse::kWrite);
    if (!made) return tl::unexpected(made.error());
    std::memset(made->mapped, 0, bytes);
    buffers_.push_back(std::move(*made));
  }
  return {};
}

Result<bool> SlotBuffer::write(const Device& device, std::size_t slot,
                               std::span<const std::byte> bytes) {
  Buffer& buffer = buffers_[slot];
  return grow(device, buffer, bytes.size(), usage_, MemoryUse::kWrite).map([&](bool replaced) {
    if (!bytes.empty()) std::memcpy(buffer.mapped, bytes.data(), bytes.size());
    return replaced;
  });
}

}  // namespace psygen::render
