#include "engine/render/frame/shadow_maps.hpp"

#include <algorithm>

#include "engine/render/device/pipeline_build.hpp"

namespace psygen::render {

using core::Result;

namespace {

Result<UniqueSampler> make_comparing_sampler(const Device& device) {
  VkSamplerCreateInfo info{};
  info.addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  info.compareEnable = VK_TRUE;
  info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  VkFormatProperties format{};
  vkGetPhysicalDeviceFormatProperties(device.physical, kDepthFormat, &format);
  if ((format.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0) {
    info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  }
  return make_sampler(device, info);
}

}  // namespace

Result<void> ShadowMaps::create(const Device& device, const PresetTraits& traits) {
  cascades_ = traits.cascades;
  size_ = std::min(traits.shadow_size, device.max_image_side);
  const std::uint32_t layer_count = std::max(cascades_, 1U);
  Result<UniqueSampler> sampler = make_comparing_sampler(device);
  if (!sampler) return tl::unexpected(sampler.error());
  sampler_ = std::move(*sampler);
  Result<Image> image =
      make_image(device, {size_, size_}, kDepthFormat,
                 VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                 VK_IMAGE_ASPECT_DEPTH_BIT, {.array = true, .layers = layer_count});
  if (!image) return tl::unexpected(image.error());
  image_ = std::move(*image);
  for (std::uint32_t i = 0; i < cascades_; ++i) {
    Result<UniqueImageView> view =
        make_layer_view(device, image_, kDepthFormat, VK_IMAGE_ASPECT_DEPTH_BIT, i);
    if (!view) return tl::unexpected(view.error());
    layers_[i] = std::move(*view);
  }
  return run_once(device, [&](VkCommandBuffer commands) { record(device, commands, {}); });
}

void ShadowMaps::record(const Device& device, VkCommandBuffer commands,
                        const std::function<void(std::uint32_t)>& draw) const {
  VkImageMemoryBarrier2 barrier = barrier_of(image_.image.get(), VK_IMAGE_ASPECT_DEPTH_BIT);
  barrier.subresourceRange.layerCount = VK_REMAINING_ARRAY_LAYERS;
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  barrier.dstStageMask =
      VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
                          VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
  barrier.newLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  image_barrier(device, commands, barrier);
  const VkRect2D area{{0, 0}, {size_, size_}};
  const VkViewport viewport{0.0F, 0.0F, static_cast<float>(size_), static_cast<float>(size_),
                            0.0F, 1.0F};
  for (std::uint32_t i = 0; i < cascades_ && draw; ++i) {
    VkRenderingAttachmentInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    depth.imageView = layers_[i].get();
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    depth.clearValue.depthStencil.depth = 1.0F;
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea = area;
    info.layerCount = 1;
    info.pDepthAttachment = &depth;
    device.vk.vkCmdBeginRendering(commands, &info);
    device.vk.vkCmdSetViewport(commands, 0, 1, &viewport);
    device.vk.vkCmdSetScissor(commands, 0, 1, &area);
    draw(i);
    device.vk.vkCmdEndRendering(commands);
  }
  barrier.srcStageMask = barrier.dstStageMask;
  barrier.srcAccessMask = barrier.dstAccessMask;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
  barrier.oldLayout = barrier.newLayout;
  barrier.newLayout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
  image_barrier(device, commands, barrier);
}

}  // namespace psygen::render
