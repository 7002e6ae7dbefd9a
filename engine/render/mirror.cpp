#include "engine/render/mirror.hpp"

#include <array>
#include <utility>

#include "engine/render/pipeline_build.hpp"

namespace psygen::render {

using core::Result;

namespace {

// Barriers for both images; layouts and stages are to be completed.
std::array<VkImageMemoryBarrier2, 2> barriers_of(const Mirror& mirror) {
  return {barrier_of(mirror.colour.image.get(), VK_IMAGE_ASPECT_COLOR_BIT),
          barrier_of(mirror.depth.image.get(), VK_IMAGE_ASPECT_DEPTH_BIT)};
}

}  // namespace

Result<Mirror> make_mirror(const Device& device, VkFormat format, core::Extent extent) {
  Mirror mirror;
  Result<Image> colour = make_image(
      device, extent, format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
      VK_IMAGE_ASPECT_COLOR_BIT);
  if (!colour) return tl::unexpected(colour.error());
  mirror.colour = std::move(*colour);
  Result<Image> depth =
      make_image(device, extent, kDepthFormat,
                 VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                 VK_IMAGE_ASPECT_DEPTH_BIT);
  if (!depth) return tl::unexpected(depth.error());
  mirror.depth = std::move(*depth);
  return mirror;
}

// Attachments are resolved, depth too, in the stage and with the access of colours.
void mirror_to_attachments(const Device& device, VkCommandBuffer commands, const Mirror& mirror) {
  std::array<VkImageMemoryBarrier2, 2> barriers = barriers_of(mirror);
  for (VkImageMemoryBarrier2& barrier : barriers) {
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
  }
  barriers[0].newLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  barriers[1].newLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  image_barriers(device, commands, barriers);
}

void mirror_to_textures(const Device& device, VkCommandBuffer commands, const Mirror& mirror) {
  std::array<VkImageMemoryBarrier2, 2> barriers = barriers_of(mirror);
  for (VkImageMemoryBarrier2& barrier : barriers) {
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
    barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  }
  barriers[0].oldLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  barriers[1].oldLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  image_barriers(device, commands, barriers);
}

}  // namespace psygen::render
