#include "engine/render/frame/reflection_targets.hpp"

#include <array>
#include <utility>

#include "engine/render/device/pipeline_build.hpp"

namespace psygen::render {

using core::Result;

namespace {

// A use of both images, which change uses together.
struct Use {
  VkPipelineStageFlags2 stage;
  VkAccessFlags2 access;
  VkImageLayout colour, depth;
};
// Their old content is discarded.
constexpr Use kForgotten{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_NONE,
                         VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_UNDEFINED};
// Attachments are resolved, depth too, in the stage and with the access of colours.
constexpr Use kResolved{
    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
    VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};
constexpr Use kRead{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};

void change_use(const Device& device, VkCommandBuffer commands, const ReflectionTargets& reflection,
                const Use& from, const Use& to) {
  std::array barriers{barrier_of(reflection.colour.image.get(), VK_IMAGE_ASPECT_COLOR_BIT),
                      barrier_of(reflection.depth.image.get(), VK_IMAGE_ASPECT_DEPTH_BIT)};
  for (VkImageMemoryBarrier2& barrier : barriers) {
    barrier.srcStageMask = from.stage;
    barrier.srcAccessMask = from.access;
    barrier.dstStageMask = to.stage;
    barrier.dstAccessMask = to.access;
  }
  barriers[0].oldLayout = from.colour;
  barriers[0].newLayout = to.colour;
  barriers[1].oldLayout = from.depth;
  barriers[1].newLayout = to.depth;
  image_barriers(device, commands, barriers);
}

}  // namespace

Result<ReflectionTargets> make_reflection_targets(const Device& device, VkFormat format,
                                                  core::Extent extent) {
  ReflectionTargets reflection;
  Result<Image> colour = make_image(
      device, extent, format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
      VK_IMAGE_ASPECT_COLOR_BIT);
  if (!colour) return tl::unexpected(colour.error());
  reflection.colour = std::move(*colour);
  Result<Image> depth =
      make_image(device, extent, kDepthFormat,
                 VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                 VK_IMAGE_ASPECT_DEPTH_BIT);
  if (!depth) return tl::unexpected(depth.error());
  reflection.depth = std::move(*depth);
  return reflection;
}

void reflection_to_attachments(const Device& device, VkCommandBuffer commands,
                               const ReflectionTargets& reflection) {
  change_use(device, commands, reflection, kForgotten, kResolved);
}

void reflection_to_textures(const Device& device, VkCommandBuffer commands,
                            const ReflectionTargets& reflection) {
  change_use(device, commands, reflection, kResolved, kRead);
}

}  // namespace psygen::render
