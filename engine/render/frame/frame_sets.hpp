// The descriptor sets that pipelines share. Set 0, one for each frame in flight, names the data of
// the frame and of its draws, the images that belong to no pass alone, the materials and the map of
// contact shadows. Set 1 has the textures of a material (textures/materials.hpp). A pass may add a
// set 2, or have one set of its own instead (pass_set.hpp). Owns the constant images of set 0 and
// the samplers. Main thread. Private to engine/render.
#pragma once

#include <array>
#include <span>

#include "engine/render/device/descriptors.hpp"
#include "engine/render/frame/shadow_maps.hpp"
#include "engine/render/textures/materials.hpp"
#include "engine/render/textures/model_pictures.hpp"

namespace psygen::render {

// The buffers of a slot that set 0 names.
struct SlotBuffers {
  const Buffer &frame, &draws, &shade;
};

// The input of FrameSets::create(). Materials and pictures must outlive the sets.
struct FrameSetsInput {
  const PresetTraits& traits;
  const MaterialTable& materials;
  const ImpostorTextures& pictures;
  std::span<const GroundPicture> ground;  // RendererOptions::ground
};

// The push constants of all pipelines: shaders::DrawData and the number of a cascade.
VkPushConstantRange push_range();

// Empty until create(). The device must outlive it.
class FrameSets {
 public:
  // Creates the images and layouts of a preset, and `slots` sets. Once; waits for the device.
  core::Result<void> create(const Device& device, std::size_t slots, const FrameSetsInput& input);

  // The number of frames in flight; the layouts of sets 0 and 1; and the layout of pipelines
  // without a set of their own.
  std::size_t slots() const { return sets_.count(); }
  std::array<VkDescriptorSetLayout, 2> shared() const {
    return {sets_.layout(), materials_->set_layout()};
  }
  VkPipelineLayout layout() const { return layout_.get(); }
  const ShadowMaps& shadows() const { return shadows_; }
  // A linear and a nearest sampler that clamp, and an image for bindings that have none: lavapipe
  // looks at all images of a set, also at those that no shader reads.
  const VkSampler* smooth_sampler() const { return smooth_sampler_.address(); }
  const VkSampler* nearest_sampler() const { return nearest_sampler_.address(); }
  VkDescriptorImageInfo any_image() const;

  // Names these buffers and the images in a slot's set that no unfinished commands use.
  void write(const Device& device, std::size_t slot, const SlotBuffers& buffers) const;
  // Names another buffer with the data of draws.
  void write_draws(const Device& device, std::size_t slot, const Buffer& draws) const;
  // Binds set 0 of a slot and pushes zeros, because draws push only parts of push_range(). Or binds
  // the textures of a material as set 1.
  void bind(const Device& device, VkCommandBuffer commands, std::size_t slot) const;
  void bind_textures(const Device& device, VkCommandBuffer commands,
                     VkDescriptorSet textures) const;

 private:
  core::Result<void> create_samplers(const Device& device);
  core::Result<void> create_ground(const Device& device, const FrameSetsInput& input);
  core::Result<void> create_sets(const Device& device, std::size_t count);

  const MaterialTable* materials_ = nullptr;
  const ImpostorTextures* pictures_ = nullptr;
  UniqueSampler cloud_sampler_, ground_sampler_, smooth_sampler_, nearest_sampler_;
  ShadowMaps shadows_;
  Image clouds_, ground_;
  DescriptorSets sets_;
  UniquePipelineLayout layout_;
};

// Creates an image of constant texels for fragment shaders. Waits for the device. Fails like
// make_image().
core::Result<Image> make_texture(const Device& device, core::Extent size, VkFormat format,
                                 std::span<const std::byte> texels);

}  // namespace psygen::render
