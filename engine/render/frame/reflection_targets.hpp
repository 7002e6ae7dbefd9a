// The landscape without water, which water reflects: colour and depth with one sample per pixel, as
// textures. The renderings of targets.hpp fill them; shaders/mirror.glsl reads them. Main thread.
// Private to engine/render.
#pragma once

#include "engine/render/memory/memory.hpp"

namespace psygen::render {

// Empty until make_reflection_targets().
struct ReflectionTargets {
  Image colour, depth;

  bool exists() const { return colour.image.get() != VK_NULL_HANDLE; }
};
// Creates images of `extent` pixels. Fails with kOutOfMemory.
core::Result<ReflectionTargets> make_reflection_targets(const Device& device, VkFormat format,
                                                        core::Extent extent);

// Moves the images to the layouts of attachments, after water has read them.
void reflection_to_attachments(const Device& device, VkCommandBuffer commands,
                               const ReflectionTargets& reflection);
// Makes them readable by fragment shaders, after the rendering that filled them.
void reflection_to_textures(const Device& device, VkCommandBuffer commands,
                            const ReflectionTargets& reflection);

}  // namespace psygen::render
