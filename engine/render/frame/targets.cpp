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

// Makes both images of the reflection attachments, after water has read them, or textures, after
// the rendering that filled them. Attachments are resolved, depth too, in the stage and with the
// access of colours.
void change_reflection(const Device& device, VkCommandBuffer commands,
                       const ReflectionTargets& reflection, bool to_textures) {
  constexpr ImageUse kForgotten{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT},
      kRead{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
            VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const auto barrier = [&](const Image& image, VkImageAspectFlags aspect, VkImageLayout layout) {
    const ImageUse resolved{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                            VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, layout};
    return to_textures ? barrier_of(image.image.get(), aspect, resolved, kRead)
                       : barrier_of(image.image.get(), aspect, kForgotten, resolved);
  };
  image_barriers(device, commands,
                 std::array{barrier(reflection.colour, VK_IMAGE_ASPECT_COLOR_BIT,
                                    VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL),
                            barrier(reflection.depth, VK_IMAGE_ASPECT_DEPTH_BIT,
                                    VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL)});
}

// Moves the targets to the layouts of attachments, after all previous uses. Parts after the first
// one keep what was drawn.
void to_attachments(const Device& device, VkCommandBuffer commands, Targets& targets,
                    RenderingPart part) {
  VkImageLayout& layout =
      targets.is_low_resolution() ? targets.low_resolution_layout : targets.colour_layout;
  if (is_reflected(targets, part)) change_reflection(device, commands, targets.reflection, false);
  if (part == RenderingPart::kWater) change_reflection(device, commands, targets.reflection, true);
  ImageUse drawn = kColourAttachment;
  drawn.layout = landscape_layout(targets);
  if (part == RenderingPart::kWhole && targets.host_ordered && layout == drawn.layout) return;
  const bool keeps = part == RenderingPart::kSecond || part == RenderingPart::kWater;
  ImageUse before{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT |
                      (targets.is_low_resolution() ? VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT
                                                   : VK_PIPELINE_STAGE_2_COPY_BIT),
                  VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
  if (keeps) before.layout = drawn.layout;
  ImageUse depth_before{VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                        VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
  if (part == RenderingPart::kSecond)
    depth_before = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_NONE,
                    VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL};
  if (part == RenderingPart::kWater) depth_before.layout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  ImageUse samples_before = before;
  if (keeps) samples_before.layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  const std::array barriers{
      barrier_of(landscape_of(targets).image.get(), VK_IMAGE_ASPECT_COLOR_BIT, before, drawn),
      barrier_of(targets.depth.image.get(), VK_IMAGE_ASPECT_DEPTH_BIT, depth_before,
                 kDepthAttachment),
      barrier_of(targets.samples.image.get(), VK_IMAGE_ASPECT_COLOR_BIT, samples_before,
                 kColourAttachment)};
  image_barriers(device, commands, std::span(barriers).first(targets.has_samples() ? 3 : 2));
  layout = drawn.layout;
}

void to_copy_source(const Device& device, VkCommandBuffer commands, Targets& targets) {
  if (targets.colour_layout == VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL) return;
  constexpr ImageUse kCopied{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                             VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
  const ImageUse drawn{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                       VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, targets.colour_layout};
  image_barrier(device, commands,
                barrier_of(targets.colour.image.get(), VK_IMAGE_ASPECT_COLOR_BIT, drawn, kCopied));
  targets.colour_layout = kCopied.layout;
}

// After a landscape of fewer pixels: shaders can read it, and the picture can be drawn to.
void to_scaling_up(const Device& device, VkCommandBuffer commands, Targets& targets) {
  constexpr ImageUse kDrawn{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                            VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, kLowResolutionLayout},
      kRead{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
            kLowResolutionLayout},
      kForgotten{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_2_COPY_BIT,
                 VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
  image_barriers(device, commands,
                 std::array{barrier_of(targets.low_resolution.image.get(),
                                       VK_IMAGE_ASPECT_COLOR_BIT, kDrawn, kRead),
                            barrier_of(targets.colour.image.get(), VK_IMAGE_ASPECT_COLOR_BIT,
                                       kForgotten, kColourAttachment)});
  targets.colour_layout = kColourAttachment.layout;
}

VkRenderingAttachmentInfo colour_of(const Targets& targets, RenderingPart part) {
  const bool loads = part == RenderingPart::kSecond || part == RenderingPart::kWater;
  VkRenderingAttachmentInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                 .imageView = landscape_of(targets).view.get(),
                                 .imageLayout = landscape_layout(targets)};
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
  VkRenderingAttachmentInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                 .imageView = targets.depth.view.get(),
                                 .imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};
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

// Begins a rendering on `extent` pixels in the corner of attachments. `depth` may be null.
void begin_on(const Device& device, VkCommandBuffer commands, core::Extent extent,
              const VkRenderingAttachmentInfo& colour, const VkRenderingAttachmentInfo* depth) {
  const VkRenderingInfo info{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                             .renderArea = {{0, 0}, {extent.width, extent.height}},
                             .layerCount = 1,
                             .colorAttachmentCount = 1,
                             .pColorAttachments = &colour,
                             .pDepthAttachment = depth};
  device.vk.vkCmdBeginRendering(commands, &info);
  const VkViewport viewport{
      0.0F, 0.0F, static_cast<float>(extent.width), static_cast<float>(extent.height), 0.0F, 1.0F};
  device.vk.vkCmdSetViewport(commands, 0, 1, &viewport);
  device.vk.vkCmdSetScissor(commands, 0, 1, &info.renderArea);
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
  return make_image(device, targets.extent, format,
                    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                    VK_IMAGE_ASPECT_COLOR_BIT)
      .map(into(targets.low_resolution));
}

Result<Targets> make_targets(const Device& device, VkFormat format, core::Extent extent,
                             VkSampleCountFlagBits samples, bool reflections) {
  Targets targets;
  targets.extent = targets.drawn = extent;
  const auto add_colour = [&](Image& image, VkImageUsageFlags use, VkSampleCountFlagBits of_pixel) {
    return make_image(device, extent, format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | use,
                      VK_IMAGE_ASPECT_COLOR_BIT, {.samples = of_pixel})
        .map(into(image));
  };
  const auto add_depth = [&](Image& image, VkImageUsageFlags use, VkSampleCountFlagBits of_pixel) {
    return make_image(device, extent, kDepthFormat,
                      VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | use, VK_IMAGE_ASPECT_DEPTH_BIT,
                      {.samples = of_pixel})
        .map(into(image));
  };
  // The depth pyramid reads depth, if the device supports it.
  const VkImageUsageFlags read =
      (device.sampled_depth_counts & samples) != 0 ? VK_IMAGE_USAGE_SAMPLED_BIT : 0;
  constexpr VkSampleCountFlagBits kOne = VK_SAMPLE_COUNT_1_BIT;
  Result<void> made =
      add_colour(targets.colour, VK_IMAGE_USAGE_TRANSFER_SRC_BIT, kOne).and_then([&] {
        return add_depth(targets.depth, read, samples);
      });
  if (made && samples != kOne) made = add_colour(targets.samples, 0, samples);
  if (made && samples != kOne && reflections) {
    made = add_colour(targets.reflection.colour, VK_IMAGE_USAGE_SAMPLED_BIT, kOne).and_then([&] {
      return add_depth(targets.reflection.depth, VK_IMAGE_USAGE_SAMPLED_BIT, kOne);
    });
  }
  if (!made) return tl::unexpected(made.error());
  return targets;
}

void begin_rendering(const Device& device, VkCommandBuffer commands, Targets& targets,
                     RenderingPart part) {
  to_attachments(device, commands, targets, part);
  const VkRenderingAttachmentInfo colour = colour_of(targets, part);
  const VkRenderingAttachmentInfo depth = depth_of(targets, part);
  begin_on(device, commands, targets.drawn, colour, &depth);
}

void split_rendering(const Device& device, VkCommandBuffer commands, const Targets& targets) {
  device.vk.vkCmdEndRendering(commands);
  // lavapipe would take a rendering on the same images for the same rendering.
  const VkRenderingInfo other{
      .sType = VK_STRUCTURE_TYPE_RENDERING_INFO, .renderArea = {{0, 0}, {1, 1}}, .layerCount = 1};
  device.vk.vkCmdBeginRendering(commands, &other);
  device.vk.vkCmdEndRendering(commands);
  VkRenderingAttachmentInfo colour = colour_of(targets, RenderingPart::kWhole);
  VkRenderingAttachmentInfo depth = depth_of(targets, RenderingPart::kWhole);
  colour.loadOp = depth.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  begin_on(device, commands, targets.drawn, colour, &depth);
}

void begin_upscale_rendering(const Device& device, VkCommandBuffer commands, Targets& targets) {
  to_scaling_up(device, commands, targets);
  const VkRenderingAttachmentInfo colour{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                         .imageView = targets.colour.view.get(),
                                         .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                         .loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                         .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
  begin_on(device, commands, targets.extent, colour, nullptr);
}

void record_copy_to_window(const Device& device, VkCommandBuffer commands, Targets& targets,
                           VkImage window, core::Extent window_extent) {
  to_copy_source(device, commands, targets);
  // The stage that waits for the image.
  constexpr ImageUse kAcquired{VK_PIPELINE_STAGE_2_COPY_BIT},
      kCopied{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL},
      kShown{VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};
  image_barrier(device, commands,
                barrier_of(window, VK_IMAGE_ASPECT_COLOR_BIT, kAcquired, kCopied));
  VkImageCopy copy{.srcSubresource = kColourLayer,
                   .dstSubresource = kColourLayer,
                   .extent = {std::min(targets.extent.width, window_extent.width),
                              std::min(targets.extent.height, window_extent.height), 1}};
  device.vk.vkCmdCopyImage(commands, targets.colour.image.get(),
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, window,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
  image_barrier(device, commands, barrier_of(window, VK_IMAGE_ASPECT_COLOR_BIT, kCopied, kShown));
}

void record_copy_to_buffer(const Device& device, VkCommandBuffer commands, Targets& targets,
                           VkBuffer buffer) {
  to_copy_source(device, commands, targets);
  VkBufferImageCopy copy{.imageSubresource = kColourLayer,
                         .imageExtent = {targets.extent.width, targets.extent.height, 1}};
  device.vk.vkCmdCopyImageToBuffer(commands, targets.colour.image.get(),
                                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &copy);
  memory_barrier(device, commands, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                 VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
}

}  // namespace psygen::render
