// A buffer that the CPU writes anew for each frame, one for each frame in flight. Main thread.
// Private to engine/render.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/render/memory/memory.hpp"

namespace psygen::render {

// Empty until create(). The device must outlive it.
class SlotBuffer {
 public:
  // Creates `slots` buffers of `bytes` zero bytes each. Fails like make_buffer().
  core::Result<void> create(const Device& device, std::size_t slots, std::uint64_t bytes,
                            VkBufferUsageFlags usage);
  // Copies `bytes` to the start of a slot's buffer, whose last frame has finished. Returns true if
  // the buffer was too small and was replaced: the sets that name it must be written again.
  core::Result<bool> write(const Device& device, std::size_t slot,
                           std::span<const std::byte> bytes);
  const Buffer& at(std::size_t slot) const { return buffers_[slot]; }

 private:
  std::vector<Buffer> buffers_;
  VkBufferUsageFlags usage_ = 0;
};

}  // namespace psygen::render
