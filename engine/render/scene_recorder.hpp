// Records a frame: the sun's shadows where the preset has them; one pass, or two where the device
// leaves out what is hidden (gpu_culling.hpp): meshes, then water, the sky behind, lines and text
// in front; and the copy of the picture out of the target. Private to engine/render.
#pragma once

#include <span>

#include "engine/render/draw_list.hpp"
#include "engine/render/frame_slot.hpp"
#include "engine/render/gpu_culling.hpp"
#include "engine/render/pipelines.hpp"

namespace psygen::render {

// What is drawn into: colour that can be copied out, and depth, forgotten after the last pass.
// With several samples per pixel these are drawn and `colour` gets their mean.
struct Targets {
  Image colour, depth;
  Image samples;  // empty with one sample per pixel
  core::Extent extent;
  VkImageLayout colour_layout = VK_IMAGE_LAYOUT_UNDEFINED;  // after the last recorded frame
  // The host waits for the last frame in here before it submits the next: no barrier is needed
  // between them, and on lavapipe, where each waits for everything, one frame's triangles are set
  // up while the last one's pixels are filled.
  bool host_ordered = false;
};
core::Result<Targets> make_targets(const Device& device, VkFormat format, core::Extent extent,
                                   VkSampleCountFlagBits samples);

// The buffers that a draw list refers to.
struct SceneBuffers {
  std::span<const Buffer> pool_blocks;
  VkBuffer shared_indices = VK_NULL_HANDLE;
};

// Draws that the device chooses itself, instead of a draw list.
struct CulledDraws {
  GpuCulling* culling = nullptr;  // null: the draw list is drawn
  std::size_t slot = 0;
};

struct ScenePass {
  const DrawList& list;
  SceneBuffers buffers;
  CulledDraws culled = {};
  std::uint32_t glyph_vertex_count = 0;  // of the overlay's buffer; the ends of lines follow
  std::uint32_t line_vertex_count = 0;
  View view = View::kNormal;
  bool water = false;
  bool shadows = false;  // the cascades of the preset
};

// Between slot.begin() and slot.end(). Leaves the colour target as an attachment.
void record_scene(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                  Targets& targets, const ScenePass& pass);

// The same of a picture that is text alone, with a ground below it.
void record_text(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                 Targets& targets, std::uint32_t glyph_vertex_count);

// The pipelines of the landscape once with triangles that cover nothing, so that the driver has
// compiled them; in steps from 0, a submission each, because that may take long.
inline constexpr int kWarmUpSteps = 5;
void record_warm_up(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                    Targets& targets, VkBuffer blank, int step);

// Copies the colour target to a swapchain image and leaves that ready to be shown.
void record_copy_to_window(const Device& device, VkCommandBuffer commands, Targets& targets,
                           VkImage window, core::Extent window_extent);
// Copies the colour target into a buffer of width · height · 4 bytes.
void record_copy_to_buffer(const Device& device, VkCommandBuffer commands, Targets& targets,
                           VkBuffer buffer);

}  // namespace psygen::render
