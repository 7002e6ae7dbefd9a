#include "engine/render/memory/memory.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>
#include <vector>

namespace psygen::render {

using core::Result;

namespace {

constexpr VkMemoryPropertyFlags kMapped =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

}  // namespace

Result<Buffer> make_buffer(const Device& device, std::uint64_t bytes, VkBufferUsageFlags usage,
                           MemoryUse use) {
  const VkBufferCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = bytes, .usage = usage};
  Result<UniqueBuffer> buffer =
      device.make<UniqueBuffer>(&VolkDeviceTable::vkCreateBuffer, info, "creating a buffer");
  if (!buffer) return tl::unexpected(buffer.error());

  MemoryWish wish{};
  device.vk.vkGetBufferMemoryRequirements(device.handle, buffer->get(), &wish.needs);
  const VkMemoryPropertyFlags extra = use == MemoryUse::kWrite ? VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT
                                                               : VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
  const bool mapped_use = use != MemoryUse::kDevice;
  Result<MemoryRange> memory =
      mapped_use ? allocate(device, wish, {kMapped | extra, kMapped})
                 : allocate(device, wish, {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0});
  if (!memory) return tl::unexpected(memory.error());
  Buffer made{std::move(*memory), std::move(*buffer), nullptr, bytes};
  const VkResult result = device.vk.vkBindBufferMemory(device.handle, made.buffer.get(),
                                                       made.memory.memory(), made.memory.offset());
  if (result != VK_SUCCESS) return vulkan_failure(result, "binding a buffer to its memory");
  if (!mapped_use) return made;
  return made.memory.map(device).map([&](std::byte* mapped) {
    made.mapped = mapped;
    return std::move(made);
  });
}

Result<bool> grow(const Device& device, Buffer& buffer, std::uint64_t bytes,
                  VkBufferUsageFlags usage, MemoryUse use) {
  if (bytes <= buffer.bytes) return false;
  return make_buffer(device, std::bit_ceil(bytes), usage, use).map([&](Buffer larger) {
    buffer = std::move(larger);
    return true;
  });
}

Result<Image> make_image(const Device& device, core::Extent size, VkFormat format,
                         VkImageUsageFlags usage, VkImageAspectFlags aspect,
                         const ImageShape& shape) {
  const VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                               .imageType = VK_IMAGE_TYPE_2D,
                               .format = format,
                               .extent = {size.width, size.height, 1},
                               .mipLevels = shape.mips,
                               .arrayLayers = shape.layers,
                               .samples = shape.samples,
                               .tiling = VK_IMAGE_TILING_OPTIMAL,
                               .usage = usage};
  Result<UniqueImage> image =
      device.make<UniqueImage>(&VolkDeviceTable::vkCreateImage, info, "creating an image");
  if (!image) return tl::unexpected(image.error());
  MemoryWish wish{.image = true};
  device.vk.vkGetImageMemoryRequirements(device.handle, image->get(), &wish.needs);
  Result<MemoryRange> memory = allocate(device, wish, {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0});
  if (!memory) return tl::unexpected(memory.error());
  Image made{std::move(*memory), std::move(*image), {}};
  const VkResult result = device.vk.vkBindImageMemory(device.handle, made.image.get(),
                                                      made.memory.memory(), made.memory.offset());
  if (result != VK_SUCCESS) return vulkan_failure(result, "binding an image to its memory");
  return make_view(device, made.image.get(), format, {aspect, 0, shape.mips, 0, shape.layers},
                   shape.array)
      .map([&](UniqueImageView view) {
        made.view = std::move(view);
        return std::move(made);
      });
}

Result<UniqueImageView> make_view(const Device& device, VkImage image, VkFormat format,
                                  const VkImageSubresourceRange& part, bool array) {
  const VkImageViewCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
      .image = image,
      .viewType = array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D,
      .format = format,
      .subresourceRange = part};
  return device.make<UniqueImageView>(&VolkDeviceTable::vkCreateImageView, info,
                                      "creating an image view");
}

VkImageMemoryBarrier2 barrier_of(VkImage image, VkImageAspectFlags aspect, const ImageUse& from,
                                 const ImageUse& to) {
  return {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
          .srcStageMask = from.stages,
          .srcAccessMask = from.access,
          .dstStageMask = to.stages,
          .dstAccessMask = to.access,
          .oldLayout = from.layout,
          .newLayout = to.layout,
          .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
          .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
          .image = image,
          .subresourceRange = {aspect, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS}};
}

void image_barriers(const Device& device, VkCommandBuffer commands,
                    std::span<const VkImageMemoryBarrier2> barriers) {
  const VkDependencyInfo dependency{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
      .imageMemoryBarrierCount = static_cast<std::uint32_t>(barriers.size()),
      .pImageMemoryBarriers = barriers.data()};
  device.vk.vkCmdPipelineBarrier2(commands, &dependency);
}

void image_barrier(const Device& device, VkCommandBuffer commands,
                   const VkImageMemoryBarrier2& barrier) {
  image_barriers(device, commands, {&barrier, 1});
}

void memory_barrier(const Device& device, VkCommandBuffer commands, VkPipelineStageFlags2 from,
                    VkAccessFlags2 from_access, VkPipelineStageFlags2 to,
                    VkAccessFlags2 to_access) {
  const VkMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                 .srcStageMask = from,
                                 .srcAccessMask = from_access,
                                 .dstStageMask = to,
                                 .dstAccessMask = to_access};
  const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                    .memoryBarrierCount = 1,
                                    .pMemoryBarriers = &barrier};
  device.vk.vkCmdPipelineBarrier2(commands, &dependency);
}

namespace {

Result<UniqueSemaphore> make_semaphore(const Device& device, VkSemaphoreType kind) {
  VkSemaphoreTypeCreateInfo type{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                 .semaphoreType = kind};
  const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO,
                                   .pNext = &type};
  return device.make<UniqueSemaphore>(&VolkDeviceTable::vkCreateSemaphore, info,
                                      "creating a semaphore");
}

}  // namespace

Result<UniqueSemaphore> make_timeline(const Device& device) {
  return make_semaphore(device, VK_SEMAPHORE_TYPE_TIMELINE);
}

Result<UniqueSemaphore> make_semaphore(const Device& device) {
  return make_semaphore(device, VK_SEMAPHORE_TYPE_BINARY);
}

Result<void> Commands::create(const Device& device, std::uint32_t queue_family) {
  const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                     .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                     .queueFamilyIndex = queue_family};
  const Result<void> made = device
                                .make<UniqueCommandPool>(&VolkDeviceTable::vkCreateCommandPool,
                                                         pool, "creating a command pool")
                                .map(into(pool_));
  if (!made) return made;
  const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                         .commandPool = pool_.get(),
                                         .commandBufferCount = 1};
  const VkResult result = device.vk.vkAllocateCommandBuffers(device.handle, &info, &commands_);
  if (result != VK_SUCCESS) return vulkan_failure(result, "allocating a command buffer");
  return {};
}

Result<void> Commands::begin(const Device& device) {
  VkResult result = device.vk.vkResetCommandPool(device.handle, pool_.get(), 0);
  if (result != VK_SUCCESS) return vulkan_failure(result, "resetting a command pool");
  const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  result = device.vk.vkBeginCommandBuffer(commands_, &info);
  if (result != VK_SUCCESS) return vulkan_failure(result, "beginning a command buffer");
  return {};
}

Result<void> Commands::end(const Device& device) {
  const VkResult result = device.vk.vkEndCommandBuffer(commands_);
  if (result != VK_SUCCESS) return vulkan_failure(result, "ending a command buffer");
  return {};
}

Result<void> run_once(const Device& device, const std::function<void(VkCommandBuffer)>& record) {
  Commands commands;
  UniqueSemaphore done;
  return commands.create(device, device.queue_family)
      .and_then([&] { return make_timeline(device); })
      .map(into(done))
      .and_then([&] { return commands.begin(device); })
      .and_then([&] {
        record(commands.get());
        return commands.end(device);
      })
      .and_then([&] {
        const std::array signals{
            semaphore_info(done.get(), 1, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT)};
        return device.submit(device.queue, commands.get(), {}, signals, "submitting commands");
      })
      .and_then([&] { return device.wait(done.get(), 1, "waiting for the device"); });
}

Result<UniqueSampler> make_sampler(const Device& device, VkFilter filter, VkSamplerAddressMode mode,
                                   VkSamplerCreateInfo info) {
  info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  info.magFilter = info.minFilter = filter;
  info.addressModeU = info.addressModeV = info.addressModeW = mode;
  return device.make<UniqueSampler>(&VolkDeviceTable::vkCreateSampler, info, "creating a sampler");
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
    VkBufferImageCopy copy{
        .bufferOffset = at,
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, i, first_layer, layers},
        .imageExtent = {std::max(size.width >> i, 1U), std::max(size.height >> i, 1U), 1}};
    copies.push_back(copy);
    at += levels[i].size();
  }
  return run_once(device, [&](VkCommandBuffer commands) {
    constexpr ImageUse kFilled{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
    constexpr ImageUse kRead{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                             VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    const auto change = [&](const ImageUse& from, const ImageUse& to) {
      VkImageMemoryBarrier2 barrier =
          barrier_of(image.image.get(), VK_IMAGE_ASPECT_COLOR_BIT, from, to);
      barrier.subresourceRange.baseArrayLayer = first_layer;
      barrier.subresourceRange.layerCount = layers;
      image_barrier(device, commands, barrier);
    };
    change({}, kFilled);
    device.vk.vkCmdCopyBufferToImage(commands, staging->buffer.get(), image.image.get(),
                                     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                     static_cast<std::uint32_t>(copies.size()), copies.data());
    change(kFilled, kRead);
  });
}

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
