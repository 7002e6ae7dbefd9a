#include "engine/render/ground_image.hpp"

#include <cstring>
#include <vector>

#include "engine/render/ground_textures.hpp"
#include "shaders/shared.h"

static_assert(PSYGEN_GROUND_SIDE == psygen::render::kPatternSide);
static_assert(PSYGEN_GROUND_REACH_M == psygen::render::kNearGroundM);

namespace psygen::render {

using core::Result;

namespace {

// Fills all layers of all levels, and makes the image readable.
Result<void> upload_array(const Device& device, const Image& image, const GroundLevels& levels,
                          std::uint32_t layers) {
  std::size_t bytes = 0;
  for (const auto& level : levels)
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
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, i, 0, layers};
    copy.imageExtent = {std::uint32_t{kPatternSide} >> i, std::uint32_t{kPatternSide} >> i, 1};
    copies.push_back(copy);
    at += levels[i].size();
  }
  return run_once(device, [&](VkCommandBuffer commands) {
    VkImageMemoryBarrier2 barrier = barrier_of(image.image.get(), VK_IMAGE_ASPECT_COLOR_BIT);
    barrier.subresourceRange.levelCount = static_cast<std::uint32_t>(levels.size());
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

}  // namespace

Result<void> GroundImage::create(const Device& device, const PresetTraits& traits,
                                 std::span<const GroundPicture> pictures) {
  VkSamplerCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  info.magFilter = VK_FILTER_LINEAR;
  info.minFilter = VK_FILTER_LINEAR;
  // Two levels at once would cost software devices twice as much.
  info.mipmapMode =
      traits.fine_grain ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.maxLod = VK_LOD_CLAMP_NONE;
  VkSampler sampler = VK_NULL_HANDLE;
  const VkResult result = device.vk.vkCreateSampler(device.handle, &info, nullptr, &sampler);
  if (result != VK_SUCCESS) return vulkan_failure(result, "creating a sampler");
  sampler_ = UniqueSampler(device.vk, device.handle, sampler);

  const GroundLevels levels =
      traits.pixel_light ? make_ground_layers(pictures) : make_ground_detail(pictures);
  const std::uint32_t layers = traits.pixel_light ? kGroundLayers : 1;
  Result<Image> image = make_image(
      device, {kPatternSide, kPatternSide}, VK_FORMAT_R8G8B8A8_UNORM,
      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_IMAGE_ASPECT_COLOR_BIT,
      {.array = true, .layers = layers, .mips = static_cast<std::uint32_t>(levels.size())});
  if (!image) return tl::unexpected(image.error());
  image_ = std::move(*image);
  return upload_array(device, image_, levels, layers);
}

}  // namespace psygen::render
