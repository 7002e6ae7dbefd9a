#include "engine/render/frame/shadow_maps.hpp"

#include <algorithm>

#include "engine/render/device/pipeline_build.hpp"

namespace psygen::render {

using core::Result;

namespace {

Result<UniqueSampler> make_comparing_sampler(const Device& device) {
  VkFormatProperties format{};
  vkGetPhysicalDeviceFormatProperties(device.physical, kDepthFormat, &format);
  const bool smooth =
      (format.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0;
  return make_sampler(device, smooth ? VK_FILTER_LINEAR : VK_FILTER_NEAREST,
                      VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                      {.compareEnable = VK_TRUE, .compareOp = VK_COMPARE_OP_LESS_OR_EQUAL});
}

}  // namespace

Result<void> ShadowMaps::create(const Device& device, const PresetTraits& traits) {
  cascades_ = traits.cascades;
  size_ = std::min(traits.shadow_size, device.info.max_image_side);
  const std::uint32_t layer_count = std::max(cascades_, 1U);
  Result<void> made =
      make_comparing_sampler(device)
          .map(into(sampler_))
          .and_then([&] {
            return make_image(
                device, {size_, size_}, kDepthFormat,
                VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                VK_IMAGE_ASPECT_DEPTH_BIT, {.array = true, .layers = layer_count});
          })
          .map(into(image_));
  for (std::uint32_t i = 0; made && i < cascades_; ++i) {
    made =
        make_view(device, image_.image.get(), kDepthFormat, {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, i, 1})
            .map(into(layers_[i]));
  }
  if (!made) return made;
  return run_once(device, [&](VkCommandBuffer commands) { record(device, commands, {}); });
}

void ShadowMaps::record(const Device& device, VkCommandBuffer commands,
                        const std::function<void(std::uint32_t)>& draw) const {
  constexpr ImageUse kForgotten{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT},
      kRead{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
            VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL};
  const auto change = [&](const ImageUse& from, const ImageUse& to) {
    image_barrier(device, commands,
                  barrier_of(image_.image.get(), VK_IMAGE_ASPECT_DEPTH_BIT, from, to));
  };
  change(kForgotten, kDepthAttachment);
  const VkRect2D area{{0, 0}, {size_, size_}};
  const VkViewport viewport{0.0F, 0.0F, static_cast<float>(size_), static_cast<float>(size_),
                            0.0F, 1.0F};
  for (std::uint32_t i = 0; i < cascades_ && draw; ++i) {
    VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                    .imageView = layers_[i].get(),
                                    .imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                    .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                    .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
    depth.clearValue.depthStencil.depth = 1.0F;
    const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                               .renderArea = area,
                               .layerCount = 1,
                               .pDepthAttachment = &depth};
    device.vk.vkCmdBeginRendering(commands, &info);
    device.vk.vkCmdSetViewport(commands, 0, 1, &viewport);
    device.vk.vkCmdSetScissor(commands, 0, 1, &area);
    draw(i);
    device.vk.vkCmdEndRendering(commands);
  }
  change(kDepthAttachment, kRead);
}

}  // namespace psygen::render
