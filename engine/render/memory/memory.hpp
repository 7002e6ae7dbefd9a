// Buffers and images with their memory, barriers, and commands that are run once. Meshes use
// geometry_pool.hpp. Main thread. Errors are those of
// vulkan_error(). Private to engine/render.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "engine/core/surface_provider.hpp"
#include "engine/render/device/device.hpp"
#include "engine/render/memory/memory_block.hpp"

namespace psygen::render {

// A buffer bound to its memory.
struct Buffer {
  MemoryRange memory;  // destroyed after the buffer
  UniqueBuffer buffer;
  std::byte* mapped = nullptr;  // null for MemoryUse::kDevice
  std::uint64_t bytes = 0;
};

// An image bound to its memory, and a view of it.
struct Image {
  MemoryRange memory;
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

// Replaces a buffer of fewer bytes by one of the next power of two, without its content, and
// returns true then.
core::Result<bool> grow(const Device& device, Buffer& buffer, std::uint64_t bytes,
                        VkBufferUsageFlags usage, MemoryUse use);

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
// Creates a view of a part of an image; `array`: of all its layers.
core::Result<UniqueImageView> make_view(const Device& device, VkImage image, VkFormat format,
                                        const VkImageSubresourceRange& part, bool array = false);

// A sampler with one filter, and one address mode for all directions. `info` has what else differs
// from 0. Fails with kOutOfMemory or kDeviceLost.
core::Result<UniqueSampler> make_sampler(const Device& device, VkFilter filter,
                                         VkSamplerAddressMode mode, VkSamplerCreateInfo info = {});

// Fills an image with usage TRANSFER_DST and SAMPLED, and makes it readable by fragment shaders.
// `levels` are its mip levels, the first of `size`: layer by layer, rows without padding. Fills
// `layers` layers from `first_layer` on, which no unfinished commands read. Waits for the device.
core::Result<void> upload_image(const Device& device, const Image& image, core::Extent size,
                                std::span<const std::span<const std::byte>> levels,
                                std::uint32_t layers = 1, std::uint32_t first_layer = 0);

// A command pool with its one command buffer. Empty until create(). The device must outlive it.
class Commands {
 public:
  core::Result<void> create(const Device& device, std::uint32_t queue_family);
  // begin() resets the command buffer and starts recording; end() makes it ready to submit.
  core::Result<void> begin(const Device& device);
  core::Result<void> end(const Device& device);
  VkCommandBuffer get() const { return commands_; }

 private:
  UniqueCommandPool pool_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
};

// Calls `record(commands)`, submits the commands and waits for them.
core::Result<void> run_once(const Device& device,
                            const std::function<void(VkCommandBuffer)>& record);

// Records a global memory barrier between the stages `from` and `to` with these accesses.
void memory_barrier(const Device& device, VkCommandBuffer commands, VkPipelineStageFlags2 from,
                    VkAccessFlags2 from_access, VkPipelineStageFlags2 to, VkAccessFlags2 to_access);

// Creates a timeline semaphore with the value 0, and a binary one.
core::Result<UniqueSemaphore> make_timeline(const Device& device);
core::Result<UniqueSemaphore> make_semaphore(const Device& device);

// A use of an image. As the use before a barrier, an undefined layout discards the content.
struct ImageUse {
  VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_NONE;
  VkAccessFlags2 access = VK_ACCESS_2_NONE;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};
// Written as an attachment of colour, or tested and written as one of depth.
inline constexpr ImageUse kColourAttachment{
    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
    VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
    VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
inline constexpr ImageUse kDepthAttachment{
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
    VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};

// A barrier between two uses of all of an image.
VkImageMemoryBarrier2 barrier_of(VkImage image, VkImageAspectFlags aspect, const ImageUse& from,
                                 const ImageUse& to);
// Record such barriers.
void image_barriers(const Device& device, VkCommandBuffer commands,
                    std::span<const VkImageMemoryBarrier2> barriers);
void image_barrier(const Device& device, VkCommandBuffer commands,
                   const VkImageMemoryBarrier2& barrier);

// A buffer that the CPU writes anew for each frame, one for each frame in flight. Empty until
// create(). The device must outlive it.
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
