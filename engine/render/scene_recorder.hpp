// Records a frame: the sun's shadows, if the preset has them; one pass, or two with occlusion
// culling (gpu_culling.hpp); and the copy of the picture out of the target. A pass draws meshes,
// water, the sky behind, then lines and text in front. It submits nothing. Main thread. Private to
// engine/render.
#pragma once

#include <span>

#include "engine/render/draw_list.hpp"
#include "engine/render/frame_slot.hpp"
#include "engine/render/gpu_culling.hpp"
#include "engine/render/pipelines.hpp"

namespace psygen::render {

// The images of a picture: colour, which can be copied out, and depth, which is discarded after the
// last pass. With several samples per pixel, `samples` is drawn to and `colour` gets their mean.
struct Targets {
  Image colour, depth;
  Image samples;  // empty with one sample per pixel
  core::Extent extent;
  VkImageLayout colour_layout = VK_IMAGE_LAYOUT_UNDEFINED;  // after the last recorded frame
  // The host waits for the last frame in these targets before it submits the next one, so no
  // barrier is needed between them. On lavapipe a barrier waits for everything. Without it, the
  // triangles of one frame are set up while the pixels of the last one are filled.
  bool host_ordered = false;
};
// Creates targets of `extent` pixels. Fails with kOutOfMemory.
core::Result<Targets> make_targets(const Device& device, VkFormat format, core::Extent extent,
                                   VkSampleCountFlagBits samples);

// The buffers of a draw list.
struct SceneBuffers {
  std::span<const Buffer> pool_blocks;
  VkBuffer shared_indices = VK_NULL_HANDLE;
};

// Draws that the device chooses, instead of a draw list.
struct CulledDraws {
  GpuCulling* culling = nullptr;  // null: the draw list is drawn
  std::size_t slot = 0;
};

// An emitter of particles.
struct EmitterRun {
  std::uint32_t count = 0;
  MaterialId textures = kPlainMaterial;  // whose base texture the particles show
};

// The content of a frame.
struct ScenePass {
  const DrawList& list;
  const MaterialTable* materials = nullptr;  // needed for objects
  SceneBuffers buffers;
  CulledDraws culled = {};
  std::uint32_t glyph_vertex_count = 0;  // in the overlay's buffer; the ends of lines follow
  std::uint32_t line_vertex_count = 0;
  std::span<const GuiRun> gui = {};  // after them
  View view = View::kNormal;
  bool water = false;
  bool lamps = false;                         // there are point lights
  std::span<const EmitterRun> emitters = {};  // back to front, in the order of their data
  bool shadows = false;                       // draw the cascades of the preset
};

// Records a whole frame, between slot.begin() and slot.end(). Afterwards the colour target is in
// the layout of an attachment.
void record_scene(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                  Targets& targets, const ScenePass& pass);

// The same for a picture with only text and its background.
void record_text(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                 Targets& targets, std::uint32_t glyph_vertex_count);

// Records a draw with each pipeline of the landscape, of triangles that cover nothing, to make the
// driver compile them. `step` is 0 … kWarmUpSteps − 1; each is one submission, because compiling
// may take long. `blank` is the start of SharedIndexLists::buffer().
inline constexpr int kWarmUpSteps = 5;
void record_warm_up(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                    Targets& targets, VkBuffer blank, int step, bool lamps = false);

// The first kLampWarmUpSteps of these draw with point lights too, if the pipelines exist.
inline constexpr int kLampWarmUpSteps = 4;

// The same for the pipelines of objects, which must exist. kObjectWarmUpSteps submissions.
inline constexpr int kObjectWarmUpSteps = 2;
void record_object_warm_up(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                           Targets& targets, VkBuffer blank, VkDescriptorSet textures, int step,
                           bool lamps);

// The same for those of particles: without and with a texture.
inline constexpr int kParticleWarmUpSteps = 2;
void record_particle_warm_up(const Device& device, const Pipelines& pipelines, FrameSlot& slot,
                             Targets& targets, VkDescriptorSet textures, int step);

// Copies the colour target to a swapchain image and makes that ready to be presented.
void record_copy_to_window(const Device& device, VkCommandBuffer commands, Targets& targets,
                           VkImage window, core::Extent window_extent);
// Copies the colour target into a buffer of width · height · 4 bytes.
void record_copy_to_buffer(const Device& device, VkCommandBuffer commands, Targets& targets,
                           VkBuffer buffer);

}  // namespace psygen::render
