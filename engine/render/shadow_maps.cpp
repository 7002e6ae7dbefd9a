#include "engine/render/shadow_maps.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "engine/render/pipeline_build.hpp"

namespace psygen::render {

using core::Result;

namespace {

// Largest distance outside a cascade, towards and away from the sun, of meshes that cast shadows
// into it.
constexpr float kCasterReachM = 1500;
constexpr float kMinElevation = 0.02F;  // of the sun, as a sine

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

// The camera's position along `axis` modulo `step` metres.
float within_step(const FrameInput& input, glm::dvec3 axis, double step) {
  const core::WorldPosition& at = input.pose.position;
  const glm::dvec3 world{at.block.x * input.block_size_m + at.local.x, at.local.y,
                         at.block.z * input.block_size_m + at.local.z};
  return static_cast<float>(std::fmod(glm::dot(world, axis), step));
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

void set_shadows(const FrameInput& input, const PresetTraits& traits, shaders::FrameData& out) {
  const glm::vec3 sun(out.sun_direction);
  const bool lit = sun.y > kMinElevation;
  out.shadow = {1.0F / static_cast<float>(traits.shadow_size),
                lit ? static_cast<float>(traits.cascades) : 0.0F, 0.0F, 0.0F};
  out.shadow_reach = {traits.reach_m[0], traits.reach_m[1], traits.reach_m[2], 0.0F};
  const glm::vec3 across = glm::normalize(
      std::abs(sun.y) < 0.99F ? glm::cross(sun, glm::vec3(0, 1, 0)) : glm::vec3(1, 0, 0));
  const glm::vec3 along = glm::cross(across, sun);
  for (std::uint32_t i = 0; i < traits.cascades; ++i) {
    const float reach = traits.reach_m[i], depth = reach + kCasterReachM;
    const double texel = 2.0 * reach / traits.shadow_size;
    glm::mat4& m = out.shadow_from_camera[i];
    m = glm::mat4(0.0F);
    for (int c = 0; c < 3; ++c) {
      m[c][0] = across[c] / reach;
      m[c][1] = along[c] / reach;
      m[c][2] = -sun[c] / (2.0F * depth);
    }
    m[3] = {within_step(input, across, texel) / reach, within_step(input, along, texel) / reach,
            0.5F, 1.0F};
  }
}

}  // namespace psygen::render
