// Records a frame: the sun's shadows, if the preset has them; one pass, or two with occlusion
// culling (gpu_culling.hpp). A pass draws meshes, the sky behind, water, then lines and text in
// front. Water that mirrors the land begins a pass, and so does text over a landscape of fewer
// pixels than the picture. It submits nothing. Main thread. Private to engine/render.
#pragma once

#include <span>

#include "engine/render/draw_list.hpp"
#include "engine/render/frame_slot.hpp"
#include "engine/render/gpu_culling.hpp"
#include "engine/render/pipelines.hpp"
#include "engine/render/targets.hpp"

namespace psygen::render {

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

// Parts of a pass, which warm_up.hpp draws alone. `emitter`: whose data the shaders of particles
// read.
void bind_set(const Device& device, const Pipelines& pipelines, const FrameSlot& slot,
              std::size_t emitter = 0);
void bind_pipeline(const Device& device, VkCommandBuffer commands, VkPipeline pipeline);
void draw_sky(const Device& device, const Pipelines& pipelines, VkCommandBuffer commands);
// After the sky: the surface is blended over what lies under it, and over the sky where nothing
// does.
void draw_water(const Device& device, const Pipelines& pipelines, VkCommandBuffer commands,
                bool lamps);
// Over a coarse landscape: scales it up, and begins the pass for text on all pixels of the picture.
void draw_scaled_up(const Device& device, const Pipelines& pipelines, const FrameSlot& slot,
                    Targets& targets);
void draw_text(const Device& device, VkPipeline overlay, VkCommandBuffer commands,
               std::uint32_t glyph_vertex_count);

}  // namespace psygen::render
