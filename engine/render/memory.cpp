#include "engine/render/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <vector>

namespace psygen::render {

using core::Result;

namespace {

// Allocates memory of the first type with one of the sets of properties in `wishes`, tried in
// order. Skips heaps that are smaller than four times the allocation.
Result<UniqueMemory> allocate(const Device& device, const VkMemoryRequirements& needs,
                              std::initializer_list<VkMemoryPropertyFlags> wishes) {
  VkResult result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
  for (const VkMemoryPropertyFlags wish : wishes) {
    for (std::uint32_t i = 0; i < device.memory.memoryTypeCount; ++i) {
      const VkMemoryType& type = device.memory.memoryTypes[i];
      if ((needs.memoryTypeBits >> i & 1u) == 0 || (type.propertyFlags & wish) != wish) continue;
      if (device.memory.memoryHeaps[type.heapIndex].size / 4 < needs.size) continue;
      VkMemoryAllocateInfo info{};
      info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
      info.allocationSize = needs.size;
      info.memoryTypeIndex = i;
      VkDeviceMemory memory = VK_NULL_HANDLE;
      result = device.vk.vkAllocateMemory(device.handle, &info, nullptr, &memory);
      if (result == VK_SUCCESS) return UniqueMemory(device.vk, device.handle, memory);
    }
  }
  return vulkan_failure(result,
                        fmt::format("allocating {} bytes of device memory", needs.size).c_str());
}

constexpr VkMemoryPropertyFlags kMapped =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

}  // namespace

Result<Buffer> make_buffer(const Device& device, std::uint64_t bytes, VkBufferUsageFlags usage,
                           MemoryUse use) {
  Buffer made;
  made.bytes = bytes;
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = bytes;
  info.usage = usage;
  VkBuffer buffer = VK_NULL_HANDLE;
  VkResult result = device.vk.vkCreateBuffer(device.handle, &info, nullptr, &buffer);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a buffer");
  made.buffer = UniqueBuffer(device.vk, device.handle, buffer);

  VkMemoryRequirements needs{};
  device.vk.vkGetBufferMemoryRequirements(device.handle, buffer, &needs);
  const VkMemoryPropertyFlags extra = use == MemoryUse::kWrite ? VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT
                                                               : VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
  const bool mapped_use = use != MemoryUse::kDevice;
  Result<UniqueMemory> memory =
      mapped_use ? allocate(device, needs, {kMapped | extra, kMapped})
                 : allocate(device, needs, {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0});
  if (!memory) return tl::unexpected(memory.error());
  made.memory = std::move(*memory);
  result = device.vk.vkBindBufferMemory(device.handle, buffer, made.memory.get(), 0);
  if (result != VK_SUCCESS) return vulkan_failure(result, "binding a buffer to its memory");
  if (!mapped_use) return made;
  void* mapped = nullptr;
  result = device.vk.vkMapMemory(device.handle, made.memory.get(), 0, VK_WHOLE_SIZE, 0, &mapped);
  if (result != VK_SUCCESS) return vulkan_failure(result, "mapping device memory");
  made.mapped = static_cast<std::byte*>(mapped);
  return made;
}

Result<UniqueMemory> bind_image_memory(const Device& device, VkImage image) {
  VkMemoryRequirements needs{};
  device.vk.vkGetImageMemoryRequirements(device.handle, image, &needs);
  Result<UniqueMemory> memory = allocate(device, needs, {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0});
  if (!memory) return memory;
  const VkResult result = device.vk.vkBindImageMemory(device.handle, image, memory->get(), 0);
  if (result != VK_SUCCESS) return vulkan_failure(result, "binding an image to its memory");
  return memory;
}

Result<Image> make_image(const Device& device, core::Extent size, VkFormat format,
                         VkImageUsageFlags usage, VkImageAspectFlags aspect,
                         const ImageShape& shape) {
  Image made;
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {size.width, size.height, 1};
  info.mipLevels = shape.mips;
  info.arrayLayers = shape.layers;
  info.samples = shape.samples;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = usage;
  VkImage image = VK_NULL_HANDLE;
  VkResult result = device.vk.vkCreateImage(device.handle, &info, nullptr, &image);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating an image");
  made.image = UniqueImage(device.vk, device.handle, image);

  Result<UniqueMemory> memory = bind_image_memory(device, image);
  if (!memory) return tl::unexpected(memory.error());
  made.memory = std::move(*memory);

  VkImageViewCreateInfo view_info{};
  view_info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  view_info.image = image;
  view_info.viewType = shape.array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  view_info.format = format;
  view_info.subresourceRange = {aspect, 0, shape.mips, 0, shape.layers};
  VkImageView view = VK_NULL_HANDLE;
  result = device.vk.vkCreateImageView(device.handle, &view_info, nullptr, &view);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating an image view");
  made.view = UniqueImageView(device.vk, device.handle, view);
  return made;
}

Result<UniqueImageView> make_layer_view(const Device& device, const Image& image, VkFormat format,
                                        VkImageAspectFlags aspect, std::uint32_t layer) {
  VkImageViewCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  info.image = image.image.get();
  info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  info.format = format;
  info.subresourceRange = {aspect, 0, 1, layer, 1};
  VkImageView view = VK_NULL_HANDLE;
  const VkResult result = device.vk.vkCreateImageView(device.handle, &info, nullptr, &view);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating an image view");
  return UniqueImageView(device.vk, device.handle, view);
}

VkImageMemoryBarrier2 barrier_of(VkImage image, VkImageAspectFlags aspect) {
  VkImageMemoryBarrier2 barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
  barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {aspect, 0, 1, 0, 1};
  return barrier;
}

void image_barriers(const Device& device, VkCommandBuffer commands,
                    std::span<const VkImageMemoryBarrier2> barriers) {
  VkDependencyInfo dependency{};
  dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  dependency.imageMemoryBarrierCount = static_cast<std::uint32_t>(barriers.size());
  dependency.pImageMemoryBarriers = barriers.data();
  device.vk.vkCmdPipelineBarrier2(commands, &dependency);
}

void image_barrier(const Device& device, VkCommandBuffer commands,
                   const VkImageMemoryBarrier2& barrier) {
  image_barriers(device, commands, {&barrier, 1});
}

void memory_barrier(const Device& device, VkCommandBuffer commands, VkPipelineStageFlags2 from,
                    VkAccessFlags2 from_access, VkPipelineStageFlags2 to,
                    VkAccessFlags2 to_access) {
  VkMemoryBarrier2 barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
  barrier.srcStageMask = from;
  barrier.srcAccessMask = from_access;
  barrier.dstStageMask = to;
  barrier.dstAccessMask = to_access;
  VkDependencyInfo dependency{};
  dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  dependency.memoryBarrierCount = 1;
  dependency.pMemoryBarriers = &barrier;
  device.vk.vkCmdPipelineBarrier2(commands, &dependency);
}

Result<UniqueSemaphore> make_timeline(const Device& device) {
  VkSemaphoreTypeCreateInfo type{};
  type.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO;
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  VkSemaphoreCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
  info.pNext = &type;
  VkSemaphore made = VK_NULL_HANDLE;
  const VkResult result = device.vk.vkCreateSemaphore(device.handle, &info, nullptr, &made);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a semaphore");
  return UniqueSemaphore(device.vk, device.handle, made);
}

Result<OneTimeCommands> begin_once(const Device& device) {
  OneTimeCommands once;
  VkCommandPoolCreateInfo pool_info{};
  pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool_info.queueFamilyIndex = device.queue_family;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkResult result = device.vk.vkCreateCommandPool(device.handle, &pool_info, nullptr, &pool);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a command pool");
  once.pool = UniqueCommandPool(device.vk, device.handle, pool);
  VkCommandBufferAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  info.commandPool = pool;
  info.commandBufferCount = 1;
  result = device.vk.vkAllocateCommandBuffers(device.handle, &info, &once.commands);
  if (result != VK_SUCCESS) return vulkan_failure(result, "allocating a command buffer");
  VkCommandBufferBeginInfo begin{};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  result = device.vk.vkBeginCommandBuffer(once.commands, &begin);
  if (result != VK_SUCCESS) return vulkan_failure(result, "beginning a command buffer");
  return once;
}

Result<void> finish_once(const Device& device, OneTimeCommands& once) {
  VkResult result = device.vk.vkEndCommandBuffer(once.commands);
  if (result != VK_SUCCESS) return vulkan_failure(result, "ending a command buffer");
  VkSemaphoreTypeCreateInfo type{};
  type.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO;
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  VkSemaphoreCreateInfo semaphore_info{};
  semaphore_info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
  semaphore_info.pNext = &type;
  VkSemaphore semaphore = VK_NULL_HANDLE;
  result = device.vk.vkCreateSemaphore(device.handle, &semaphore_info, nullptr, &semaphore);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a semaphore");
  const UniqueSemaphore owner(device.vk, device.handle, semaphore);

  VkCommandBufferSubmitInfo commands{};
  commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO;
  commands.commandBuffer = once.commands;
  VkSemaphoreSubmitInfo signal{};
  signal.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO;
  signal.semaphore = semaphore;
  signal.value = 1;
  signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  VkSubmitInfo2 submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
  submit.commandBufferInfoCount = 1;
  submit.pCommandBufferInfos = &commands;
  submit.signalSemaphoreInfoCount = 1;
  submit.pSignalSemaphoreInfos = &signal;
  return device.submit(device.queue, submit, "submitting commands").and_then([&] {
    return device.wait(semaphore, signal.value, "waiting for the device");
  });
}

Result<UniqueSampler> make_sampler(const Device& device, VkSamplerCreateInfo info) {
  info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  VkSampler sampler = VK_NULL_HANDLE;
  const VkResult result = device.vk.vkCreateSampler(device.handle, &info, nullptr, &sampler);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a sampler");
  return UniqueSampler(device.vk, device.handle, sampler);
}

Result<void> upload_image(const Device& device, const Image& image, core::Extent size,
                          std::span<const std::span<const std::byte>> levels, std::uint32_t layers,
                          std::uint32_t first_layer) {
  std::size_t bytes = 0;
  for (const std::span<const std::byte> level : levels)
    bytes += level.size();
  const Result<Buffer> staging =
      make_buffer(device, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::kWrite);
  if (!staging) return tl::unexpected(staging.error());
  std::vector<VkBufferImageCopy> copies;
  std::size_t at = 0;
  for (std::uint32_t i = 0; i < levels.size(); ++i) {
    std::memcpy(staging->mapped + at, levels[i].data(), levels[i].size());
    VkBufferImageCopy copy{};
    copy.bufferOffset = at;
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, i, first_layer, layers};
    copy.imageExtent = {std::max(size.width >> i, 1U), std::max(size.height >> i, 1U), 1};
    copies.push_back(copy);
    at += levels[i].size();
  }
  return run_once(device, [&](VkCommandBuffer commands) {
    VkImageMemoryBarrier2 barrier = barrier_of(image.image.get(), VK_IMAGE_ASPECT_COLOR_BIT);
    barrier.subresourceRange.levelCount = static_cast<std::uint32_t>(levels.size());
    barrier.subresourceRange.baseArrayLayer = first_layer;
    barrier.subresourceRange.layerCount = layers;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    image_barrier(device, commands, barrier);
    device.vk.vkCmdCopyBufferToImage(commands, staging->buffer.get(), image.image.get(),
                                     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                     static_cast<std::uint32_t>(copies.size()), copies.data());
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    image_barrier(device, commands, barrier);
  });
}

}  // namespace psygen::render
