// Buffers and images with memory of their own, and the one copy that start-up needs. A handful of
// large allocations; meshes do not come from here (geometry_pool.hpp). Private to engine/render.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/core/surface_provider.hpp"
#include "engine/render/device.hpp"

namespace psygen::render {

struct Buffer {
  UniqueMemory memory;  // ends after the buffer
  UniqueBuffer buffer;
  std::byte* mapped = nullptr;
  std::uint64_t bytes = 0;
};

struct Image {
  UniqueMemory memory;
  UniqueImage image;
  UniqueImageView view;
};

enum class MemoryUse : std::uint8_t {
  kWrite,   // written by the CPU, read by the device: device-local where that is possible
  kRead,    // read back by the CPU: cached where that is possible
  kDevice,  // only the device's: not mapped
};

// A buffer, mapped and coherent unless it is the device's.
core::Result<Buffer> make_buffer(const Device& device, std::uint64_t bytes,
                                 VkBufferUsageFlags usage, MemoryUse use);

// Device-local memory for an image, bound to it.
core::Result<UniqueMemory> bind_image_memory(const Device& device, VkImage image);

struct ImageShape {
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  bool array = false;  // the view is of an array, even with one layer
  std::uint32_t layers = 1;
};
// A device-local 2-D image with one mip level.
core::Result<Image> make_image(const Device& device, core::Extent size, VkFormat format,
                               VkImageUsageFlags usage, VkImageAspectFlags aspect,
                               const ImageShape& shape = {});
// A view of one layer of it.
core::Result<UniqueImageView> make_layer_view(const Device& device, const Image& image,
                                              VkFormat format, VkImageAspectFlags aspect,
                                              std::uint32_t layer);

// Fills an image made with TRANSFER_DST and SAMPLED and leaves it readable by shaders. Waits.
core::Result<void> upload_image(const Device& device, const Image& image, core::Extent size,
                                std::span<const std::byte> pixels);

// Runs `record(commands)` on the queue and waits for it.
template <class Record>
core::Result<void> run_once(const Device& device, Record&& record);

// Everything before in `from` with its `from_access` happens before what follows in `to`.
void memory_barrier(const Device& device, VkCommandBuffer commands, VkPipelineStageFlags2 from,
                    VkAccessFlags2 from_access, VkPipelineStageFlags2 to, VkAccessFlags2 to_access);

// A semaphore that counts, from 0.
core::Result<UniqueSemaphore> make_timeline(const Device& device);

// Moves an image between layouts; one full barrier between the stages.
void image_barrier(const Device& device, VkCommandBuffer commands,
                   const VkImageMemoryBarrier2& barrier);
VkImageMemoryBarrier2 barrier_of(VkImage image, VkImageAspectFlags aspect);

// Implementation of run_once.
struct OneTimeCommands {
  UniqueCommandPool pool;
  VkCommandBuffer commands = VK_NULL_HANDLE;
};
core::Result<OneTimeCommands> begin_once(const Device& device);
core::Result<void> finish_once(const Device& device, OneTimeCommands& once);

template <class Record>
core::Result<void> run_once(const Device& device, Record&& record) {
  core::Result<OneTimeCommands> once = begin_once(device);
  if (!once) return tl::unexpected(once.error());
  record(once->commands);
  return finish_once(device, *once);
}

}  // namespace psygen::render
