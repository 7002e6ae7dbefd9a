// What shaders read besides vertices: the one layout of descriptor sets, a set for each slot, the
// constant textures in them, and the layout of pipelines. Creates no pipelines (pipelines.hpp).
// Main thread. Private to engine/render.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/render/ground_image.hpp"
#include "engine/render/materials.hpp"
#include "engine/render/model_pictures.hpp"
#include "engine/render/overlay.hpp"
#include "engine/render/shadow_maps.hpp"
#include "engine/render/targets.hpp"

namespace psygen::render {

// The buffers of a slot that its set names.
struct SlotBuffers {
  const Buffer &frame, &draws, &glyphs, &emitters, &shade;
};

// Empty until create(). The device, the materials and the pictures must outlive it.
class Bindings {
 public:
  // Creates the textures of a preset, the layouts and `sets` sets, once. Waits for the device.
  core::Result<void> create(const Device& device, const PresetTraits& traits,
                            const Overlay& overlay, std::uint32_t sets,
                            const MaterialTable& materials, const ModelPictures& pictures,
                            std::span<const GroundPicture> ground);

  // The layout of all pipelines, the set of a slot, and the shadow maps.
  VkPipelineLayout layout() const { return layout_.get(); }
  VkDescriptorSet set(std::size_t number) const { return sets_[number]; }
  const ShadowMaps& shadows() const { return shadows_; }

  // Binds these buffers and the textures to a set that no unfinished commands use.
  void write(const Device& device, VkDescriptorSet set, const SlotBuffers& buffers) const;
  // The same with what is read of the images that a frame is drawn to, once they have changed.
  void write_targets(const Device& device, VkDescriptorSet set, const Targets& targets) const;

 private:
  core::Result<void> create_samplers(const Device& device);
  core::Result<void> create_textures(const Device& device, const Overlay& overlay);
  core::Result<void> create_sets(const Device& device, std::uint32_t count);
  core::Result<void> create_layout(const Device& device);

  const MaterialTable* materials_ = nullptr;
  const ModelPictures* pictures_ = nullptr;
  UniqueSampler cloud_sampler_, smooth_sampler_, depth_sampler_;
  ShadowMaps shadows_;
  Image clouds_, font_;
  GroundImage ground_;
  UniqueSetLayout set_layout_;
  UniqueDescriptorPool pool_;
  std::vector<VkDescriptorSet> sets_;
  UniquePipelineLayout layout_;
};

}  // namespace psygen::render
