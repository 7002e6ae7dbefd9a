// The landscape without water, which water mirrors: colour and depth with one sample per pixel, as
// textures. The passes of targets.hpp fill them; shaders/mirror.glsl reads them. Main thread.
// Private to engine/render.
#pragma once

#include "engine/render/memory.hpp"

namespace psygen::render {

// Empty until make_mirror().
struct Mirror {
  Image colour, depth;

  bool exists() const { return colour.image.get() != VK_NULL_HANDLE; }
};
// Creates images of `extent` pixels. Fails with kOutOfMemory.
core::Result<Mirror> make_mirror(const Device& device, VkFormat format, core::Extent extent);

// Moves the images to the layouts of attachments, after water has read them.
void mirror_to_attachments(const Device& device, VkCommandBuffer commands, const Mirror& mirror);
// Makes them readable by fragment shaders, after the pass that filled them.
void mirror_to_textures(const Device& device, VkCommandBuffer commands, const Mirror& mirror);

}  // namespace psygen::render
