#include "engine/render/memory/shared_index_lists.hpp"

#include <cstring>
#include <utility>

namespace psygen::render {

core::Result<void> SharedIndexLists::create(const Device& device) {
  return make_buffer(device, kBytes,
                     VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                     MemoryUse::kWrite)
      .map([this](Buffer made) {
        buffer_ = std::move(made);
        std::memset(buffer_.mapped, 0, kBlankBytes);
      });
}

core::Result<std::uint32_t> SharedIndexLists::add(std::span<const std::uint16_t> indices) {
  if (indices.empty()) {
    return core::fail(core::ErrorCode::kInvalidArgument, "a shared index list is empty");
  }
  if (indices.size_bytes() > kBytes - used_bytes_) {
    return core::fail(core::ErrorCode::kOutOfMemory, "the buffer of shared index lists is full");
  }
  std::memcpy(buffer_.mapped + used_bytes_, indices.data(), indices.size_bytes());
  lists_.push_back({static_cast<std::uint32_t>(used_bytes_ / sizeof(std::uint16_t)),
                    static_cast<std::uint32_t>(indices.size())});
  used_bytes_ += indices.size_bytes();
  return static_cast<std::uint32_t>(lists_.size());
}

}  // namespace psygen::render
