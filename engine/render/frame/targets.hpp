// The images that a frame is drawn to: making them, beginning renderings on them, and copying the
// picture out. Knows nothing of what is drawn. Main thread. Private to engine/render.
#pragma once

#include "engine/render/memory/memory.hpp"

namespace psygen::render {

// Of Targets::low_resolution, which is attachment and texture in turns.
inline constexpr VkImageLayout kLowResolutionLayout = VK_IMAGE_LAYOUT_GENERAL;

// The landscape without water, which water reflects: colour and depth with one sample per pixel, as
// textures (shaders/mirror.glsl).
struct ReflectionTargets {
  Image colour, depth;

  bool exists() const { return colour.image.exists(); }
};

// The images of a picture: colour, which can be copied out, and depth, which is discarded after the
// last rendering. With several samples per pixel, `samples` is drawn to and `colour` gets their
// mean.
struct Targets {
  Image colour, depth;
  Image samples;                 // empty with one sample per pixel
  Image low_resolution;          // instead of `colour` for a landscape of fewer pixels; empty until
                                 // add_low_resolution()
  ReflectionTargets reflection;  // empty if water reflects only the sky
  core::Extent extent;
  core::Extent drawn;  // pixels of the landscape: extent, or fewer, in the corner of the images
  bool reflects =
      false;  // the frame has reflecting water: RenderingPart::kWater follows the landscape
  // After the last recorded frame.
  VkImageLayout colour_layout = VK_IMAGE_LAYOUT_UNDEFINED;
  VkImageLayout low_resolution_layout = VK_IMAGE_LAYOUT_UNDEFINED;
  // The host waits for the last frame in these targets before it submits the next one, so no
  // barrier is needed between them. On lavapipe a barrier waits for everything. Without it, the
  // triangles of one frame are set up while the pixels of the last one are filled.
  bool host_ordered = false;
  bool keeps_order =
      false;  // the device fills pixels in the order of triangles over renderings: lavapipe
  bool in_parts = false;  // the next frame is drawn so: split_rendering() may be called

  bool is_low_resolution() const { return drawn != extent; }
  bool has_samples() const { return samples.image.exists(); }
};
// Creates targets of `extent` pixels, with `reflection` if `reflections`, which needs more than one
// sample per pixel. Fails with kOutOfMemory.
core::Result<Targets> make_targets(const Device& device, VkFormat format, core::Extent extent,
                                   VkSampleCountFlagBits samples, bool reflections);
// Returns true if the device can scale images of this format up, smoothly.
bool can_scale_up(const Device& device, VkFormat format);
// Creates Targets::low_resolution, for frames of fewer pixels. Fails with kOutOfMemory.
core::Result<void> add_low_resolution(const Device& device, VkFormat format, Targets& targets);

// A frame has one rendering, or two with a read of depth in between. With Targets::reflects,
// another one follows, in which water reads what was drawn before.
enum class RenderingPart : std::uint8_t { kWhole, kFirst, kSecond, kWater };
// Moves the targets to the layouts of attachments, after all previous uses, and begins a rendering
// on all of them. Depth is cleared; whatever draws must cover every pixel.
void begin_rendering(const Device& device, VkCommandBuffer commands, Targets& targets,
                     RenderingPart part = RenderingPart::kWhole);

// Within the rendering kWhole of targets that are drawn `in_parts`: ends it and goes on. lavapipe
// fills pixels once a rendering ends, with threads of its own, while the triangles of the next are
// set up.
void split_rendering(const Device& device, VkCommandBuffer commands, const Targets& targets);

// After a landscape of fewer pixels: begins a rendering on the colour target alone, without depth
// and with one sample per pixel, whose first draw scales the landscape up over all pixels.
void begin_upscale_rendering(const Device& device, VkCommandBuffer commands, Targets& targets);

// Copies the colour target to a swapchain image and makes that ready to be presented.
void record_copy_to_window(const Device& device, VkCommandBuffer commands, Targets& targets,
                           VkImage window, core::Extent window_extent);
// Copies the colour target into a buffer of width · height · 4 bytes.
void record_copy_to_buffer(const Device& device, VkCommandBuffer commands, Targets& targets,
                           VkBuffer buffer);

}  // namespace psygen::render
