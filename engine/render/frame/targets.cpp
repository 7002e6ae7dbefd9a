#include "engine/render/frame/targets.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "engine/render/device/pipeline_build.hpp"

namespace psygen::render {

using core::Result;

namespace {

constexpr VkImageSubresourceLayers kColourLayer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};

// The image that the landscape gets its colours in, and the layout for that.
const Image& landscape_of(const Targets& targets) {
  return targets.is_low_resolution() ? targets.low_resolution : targets.colour;
}
VkImageLayout landscape_layout(const Targets& targets) {
  return targets.is_low_resolution() ? kLowResolutionLayout
                                     : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
}

// Returns true if the landscape is complete after this part of a frame, and water reflects it.
bool is_reflected(const Targets& targets, RenderingPart part) {
  return targets.reflects && (part == RenderingPart::kWhole || part == RenderingPart::kSecond);
}

// Makes a colour image an attachment that forgets what it had, after it was drawn to and read.
VkImageMemoryBarrier2 to_attachment(const Image& image, VkImageLayout layout,
                                    VkPipelineStageFlags2 read_in) {
  VkImageMemoryBarrier2 barrier = barrier_of(image.image.get(), VK_IMAGE_ASPECT_COLOR_BIT);
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT | read_in;
  barrier.srcAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  barrier.dstAccessMask =
      VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT;
  barrier.newLayout = layout;
  return barrier;
}

// Moves the targets to the layouts of attachments, after all previous uses.
void to_attachments(const Device& device, VkCommandBuffer commands, Targets& targets,
                    RenderingPart part) {
  VkImageLayout& layout =
      targets.is_low_resolution() ? targets.low_resolution_layout : targets.colour_layout;
  if (is_reflected(targets, part)) reflection_to_attachments(device, commands, targets.reflection);
  if (part == RenderingPart::kWater) reflection_to_textures(device, commands, targets.reflection);
  const VkImageLayout drawn_to = landscape_layout(targets);
  if (part == RenderingPart::kWhole && targets.host_ordered && layout == drawn_to) return;
  VkImageMemoryBarrier2 colour =
      to_attachment(landscape_of(targets), drawn_to,
                    targets.is_low_resolution() ? VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT
                                                : VK_PIPELINE_STAGE_2_COPY_BIT);
  VkImageMemoryBarrier2 depth = barrier_of(targets.depth.image.get(), VK_IMAGE_ASPECT_DEPTH_BIT);
  depth.srcStageMask = VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
  depth.srcAccessMask = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  depth.dstStageMask =
      VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
  depth.dstAccessMask = VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
                        VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
  depth.newLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  if (part == RenderingPart::kSecond) {
    colour.oldLayout = drawn_to;
    depth.oldLayout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
    depth.srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    depth.srcAccessMask = VK_ACCESS_2_NONE;
  }
  if (part == RenderingPart::kWater) {
    colour.oldLayout = drawn_to;
    depth.oldLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  }
  VkImageMemoryBarrier2 samples = colour;
  samples.image = targets.samples.image.get();
  samples.newLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  if (colour.oldLayout != VK_IMAGE_LAYOUT_UNDEFINED) samples.oldLayout = samples.newLayout;
  const std::array barriers{colour, depth, samples};
  image_barriers(device, commands, std::span(barriers).first(targets.has_samples() ? 3 : 2));
  layout = drawn_to;
}

void to_copy_source(const Device& device, VkCommandBuffer commands, Targets& targets) {
  if (targets.colour_layout == VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL) return;
  VkImageMemoryBarrier2 barrier = barrier_of(targets.colour.image.get(), VK_IMAGE_ASPECT_COLOR_BIT);
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  barrier.srcAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT;
  barrier.oldLayout = targets.colour_layout;
  barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  image_barrier(device, commands, barrier);
  targets.colour_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
}

// After a landscape of fewer pixels: shaders can read it, and the picture can be drawn to.
void to_scaling_up(const Device& device, VkCommandBuffer commands, Targets& targets) {
  VkImageMemoryBarrier2 from =
      barrier_of(targets.low_resolution.image.get(), VK_IMAGE_ASPECT_COLOR_BIT);
  from.srcStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
  from.srcAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
  from.dstStageMask = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  from.dstAccessMask = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
  from.oldLayout = from.newLayout = kLowResolutionLayout;
  const VkImageMemoryBarrier2 to = to_attachment(
      targets.colour, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_2_COPY_BIT);
  image_barriers(device, commands, std::array{from, to});
  targets.colour_layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
}

// The depth pyramid reads depth, if the device supports it.
VkImageUsageFlags depth_usage(const Device& device, VkSampleCountFlagBits samples) {
  const bool readable = (device.sampled_depth_counts & samples) != 0;
  VkImageUsageFlags usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  if (readable) usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
  return usage;
}

VkRenderingAttachmentInfo colour_of(const Targets& targets, RenderingPart part) {
  const bool loads = part == RenderingPart::kSecond || part == RenderingPart::kWater;
  VkRenderingAttachmentInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  info.imageView = landscape_of(targets).view.get();
  info.imageLayout = landscape_layout(targets);
  // Before the first rendering nothing is kept: the sky covers all other pixels.
  info.loadOp = loads ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  if (!targets.has_samples()) return info;
  info.imageView = targets.samples.view.get();
  info.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  if (part == RenderingPart::kFirst) return info;
  const bool reflected = is_reflected(targets, part);
  const Image& mean = reflected ? targets.reflection.colour : landscape_of(targets);
  if (!reflected) info.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  info.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
  info.resolveImageView = mean.view.get();
  info.resolveImageLayout =
      reflected ? VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL : landscape_layout(targets);
  return info;
}

VkRenderingAttachmentInfo depth_of(const Targets& targets, RenderingPart part) {
  const bool loads = part == RenderingPart::kSecond || part == RenderingPart::kWater;
  const bool reflected = is_reflected(targets, part);
  VkRenderingAttachmentInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  info.imageView = targets.depth.view.get();
  info.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  // Cleared to 0, infinitely far.
  info.loadOp = loads ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR;
  const bool read_later = reflected || part == RenderingPart::kFirst || targets.in_parts;
  info.storeOp = read_later ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE;
  if (!reflected) return info;
  info.resolveMode = VK_RESOLVE_MODE_SAMPLE_ZERO_BIT;
  info.resolveImageView = targets.reflection.depth.view.get();
  info.resolveImageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  return info;
}

VkRenderingInfo rendering_info(const VkRect2D& area, const VkRenderingAttachmentInfo& colour) {
  VkRenderingInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  info.renderArea = area;
  info.layerCount = 1;
  info.colorAttachmentCount = 1;
  info.pColorAttachments = &colour;
  return info;
}

void begin_on(const Device& device, VkCommandBuffer commands, const VkRenderingInfo& info) {
  device.vk.vkCmdBeginRendering(commands, &info);
  const VkRect2D& area = info.renderArea;
  const VkViewport viewport{
      0.0F, 0.0F, static_cast<float>(area.extent.width), static_cast<float>(area.extent.height),
      0.0F, 1.0F};
  device.vk.vkCmdSetViewport(commands, 0, 1, &viewport);
  device.vk.vkCmdSetScissor(commands, 0, 1, &area);
}

}  // namespace

bool can_scale_up(const Device& device, VkFormat format) {
  VkFormatProperties properties{};
  vkGetPhysicalDeviceFormatProperties(device.physical, format, &properties);
  constexpr VkFormatFeatureFlags kNeeded =
      VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
  return (properties.optimalTilingFeatures & kNeeded) == kNeeded;
}

Result<void> add_low_resolution(const Device& device, VkFormat format, Targets& targets) {
  Result<Image> made = make_image(device, targets.extent, format,
                                  VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                  VK_IMAGE_ASPECT_COLOR_BIT);
  if (!made) return tl::unexpected(made.error());
  targets.low_resolution = std::move(*made);
  return {};
}

Result<Targets> make_targets(const Device& device, VkFormat format, core::Extent extent,
                             VkSampleCountFlagBits samples, bool reflections) {
  Targets targets;
  targets.extent = targets.drawn = extent;
  Result<Image> colour = make_image(
      device, extent, format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
      VK_IMAGE_ASPECT_COLOR_BIT);
  if (!colour) return tl::unexpected(colour.error());
  targets.colour = std::move(*colour);
  Result<Image> depth = make_image(device, extent, kDepthFormat, depth_usage(device, samples),
                                   VK_IMAGE_ASPECT_DEPTH_BIT, {.samples = samples});
  if (!depth) return tl::unexpected(depth.error());
  targets.depth = std::move(*depth);
  if (samples == VK_SAMPLE_COUNT_1_BIT) return targets;
  Result<Image> drawn = make_image(device, extent, format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                   VK_IMAGE_ASPECT_COLOR_BIT, {.samples = samples});
  if (!drawn) return tl::unexpected(drawn.error());
  targets.samples = std::move(*drawn);
  if (!reflections) return targets;
  Result<ReflectionTargets> reflection = make_reflection_targets(device, format, extent);
  if (!reflection) return tl::unexpected(reflection.error());
  targets.reflection = std::move(*reflection);
  return targets;
}

void begin_rendering(const Device& device, VkCommandBuffer commands, Targets& targets,
                     RenderingPart part) {
  to_attachments(device, commands, targets, part);
  const VkRenderingAttachmentInfo colour = colour_of(targets, part);
  const VkRenderingAttachmentInfo depth = depth_of(targets, part);
  VkRenderingInfo info =
      rendering_info({{0, 0}, {targets.drawn.width, targets.drawn.height}}, colour);
  info.pDepthAttachment = &depth;
  begin_on(device, commands, info);
}

void split_rendering(const Device& device, VkCommandBuffer commands, const Targets& targets) {
  device.vk.vkCmdEndRendering(commands);
  // lavapipe would take a rendering on the same images for the same rendering.
  VkRenderingInfo other{};
  other.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  other.renderArea = {{0, 0}, {1, 1}};
  other.layerCount = 1;
  device.vk.vkCmdBeginRendering(commands, &other);
  device.vk.vkCmdEndRendering(commands);
  VkRenderingAttachmentInfo colour = colour_of(targets, RenderingPart::kWhole);
  VkRenderingAttachmentInfo depth = depth_of(targets, RenderingPart::kWhole);
  colour.loadOp = depth.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  VkRenderingInfo info =
      rendering_info({{0, 0}, {targets.drawn.width, targets.drawn.height}}, colour);
  info.pDepthAttachment = &depth;
  begin_on(device, commands, info);
}

void begin_upscale_rendering(const Device& device, VkCommandBuffer commands, Targets& targets) {
  to_scaling_up(device, commands, targets);
  VkRenderingAttachmentInfo colour{};
  colour.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  colour.imageView = targets.colour.view.get();
  colour.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  colour.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  colour.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  const VkRect2D area{{0, 0}, {targets.extent.width, targets.extent.height}};
  begin_on(device, commands, rendering_info(area, colour));
}

void record_copy_to_window(const Device& device, VkCommandBuffer commands, Targets& targets,
                           VkImage window, core::Extent window_extent) {
  to_copy_source(device, commands, targets);
  VkImageMemoryBarrier2 barrier = barrier_of(window, VK_IMAGE_ASPECT_COLOR_BIT);
  barrier.srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;  // the stage that waits for the image
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
  barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  image_barrier(device, commands, barrier);
  VkImageCopy copy{};
  copy.srcSubresource = kColourLayer;
  copy.dstSubresource = kColourLayer;
  copy.extent = {std::min(targets.extent.width, window_extent.width),
                 std::min(targets.extent.height, window_extent.height), 1};
  device.vk.vkCmdCopyImage(commands, targets.colour.image.get(),
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, window,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
  barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
  barrier.dstStageMask = VK_PIPELINE_STAGE_2_NONE;
  barrier.dstAccessMask = VK_ACCESS_2_NONE;
  barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  barrier.newLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
  image_barrier(device, commands, barrier);
}

void record_copy_to_buffer(const Device& device, VkCommandBuffer commands, Targets& targets,
                           VkBuffer buffer) {
  to_copy_source(device, commands, targets);
  VkBufferImageCopy copy{};
  copy.imageSubresource = kColourLayer;
  copy.imageExtent = {targets.extent.width, targets.extent.height, 1};
  device.vk.vkCmdCopyImageToBuffer(commands, targets.colour.image.get(),
                                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &copy);
  memory_barrier(device, commands, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                 VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
}

}  // namespace psygen::render
