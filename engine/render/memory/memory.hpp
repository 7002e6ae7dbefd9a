// Buffers and images with their own memory, barriers, and commands that are run once. Only for a
// few large allocations; meshes use geometry_pool.hpp. Main thread. Errors are those of
// vulkan_error(). Private to engine/render.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/core/surface_provider.hpp"
#include "engine/render/device/device.hpp"

namespace psygen::render {

// A buffer bound to its own memory.
struct Buffer {
  UniqueMemory memory;  // destroyed after the buffer
  UniqueBuffer buffer;
  std::byte* mapped = nullptr;  // null for MemoryUse::kDevice
  std::uint64_t bytes = 0;
};

// An image bound to its own memory, and a view of it.
struct Image {
  UniqueMemory memory;
  UniqueImage image;
  UniqueImageView view;
};

// Use of a buffer's memory.
enum class MemoryUse : std::uint8_t {
  kWrite,   // written by the CPU, read by the device: device-local if possible
  kRead,    // read by the CPU: cached if possible
  kDevice,  // used only by the device: not mapped
};

// Creates a buffer. Its memory is mapped and coherent, except for MemoryUse::kDevice.
core::Result<Buffer> make_buffer(const Device& device, std::uint64_t bytes,
                                 VkBufferUsageFlags usage, MemoryUse use);

// Allocates device-local memory for an image and binds it.
core::Result<UniqueMemory> bind_image_memory(const Device& device, VkImage image);

// Optional properties of an image.
struct ImageShape {
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  bool array = false;  // the view is of an array, even with one layer
  std::uint32_t layers = 1;
  std::uint32_t mips = 1;  // levels, each half as large as the one before
};
// Creates a device-local 2-D image.
core::Result<Image> make_image(const Device& device, core::Extent size, VkFormat format,
                               VkImageUsageFlags usage, VkImageAspectFlags aspect,
                               const ImageShape& shape = {});
// Creates a view of one layer of an image.
core::Result<UniqueImageView> make_layer_view(const Device& device, const Image& image,
                                              VkFormat format, VkImageAspectFlags aspect,
                                              std::uint32_t layer);

// A sampler; `info` without its type. Fails with kOutOfMemory or kDeviceLost.
core::Result<UniqueSampler> make_sampler(const Device& device, VkSamplerCreateInfo info);

// Fills an image with usage TRANSFER_DST and SAMPLED, and makes it readable by fragment shaders.
// `levels` are its mip levels, the first of `size`: layer by layer, rows without padding. Fills
// `layers` layers from `first_layer` on, which no unfinished commands read. Waits for the device.
core::Result<void> upload_image(const Device& device, const Image& image, core::Extent size,
                                std::span<const std::span<const std::byte>> levels,
                                std::uint32_t layers = 1, std::uint32_t first_layer = 0);

// Calls `record(commands)`, submits the commands and waits for them.
template <class Record>
core::Result<void> run_once(const Device& device, Record&& record);

// Records a global memory barrier between the stages `from` and `to` with these accesses.
void memory_barrier(const Device& device, VkCommandBuffer commands, VkPipelineStageFlags2 from,
                    VkAccessFlags2 from_access, VkPipelineStageFlags2 to, VkAccessFlags2 to_access);

// Creates a timeline semaphore with the value 0.
core::Result<UniqueSemaphore> make_timeline(const Device& device);

// Records a barrier, which may change an image's layout. barrier_of() is a barrier of the first mip
// level and layer, to be completed by the caller.
void image_barriers(const Device& device, VkCommandBuffer commands,
                    std::span<const VkImageMemoryBarrier2> barriers);
void image_barrier(const Device& device, VkCommandBuffer commands,
                   const VkImageMemoryBarrier2& barrier);
VkImageMemoryBarrier2 barrier_of(VkImage image, VkImageAspectFlags aspect);

// Implementation of run_once: a command buffer in recording, and its submission with a wait.
struct OneTimeCommands {
  UniqueCommandPool pool;
  VkCommandBuffer commands = VK_NULL_HANDLE;
};
// Starts recording; ends it, submits and waits.
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
