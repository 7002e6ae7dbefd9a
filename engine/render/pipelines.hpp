// Every pipeline, the one descriptor set layout and the textures that never change. All are made on
// one thread at start-up. Private to engine/render.
#pragma once

#include "engine/render/memory.hpp"
#include "engine/render/overlay.hpp"

namespace psygen::render {

inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

class Pipelines {
 public:
  // `pushed`: draws find their data in push constants instead of the buffer of draws.
  // `sets` descriptor sets can be made.
  core::Result<void> create(const Device& device, VkFormat colour_format, bool pushed,
                            const Overlay& overlay, std::uint32_t sets);

  VkPipelineLayout layout() const { return layout_.get(); }
  VkPipeline terrain() const { return terrain_.get(); }
  VkPipeline model() const { return model_.get(); }
  VkPipeline sky() const { return sky_.get(); }
  VkPipeline overlay() const { return overlay_.get(); }

  // A set that reads the given buffers and the textures.
  core::Result<VkDescriptorSet> make_set(const Device& device);
  void write_set(const Device& device, VkDescriptorSet set, const Buffer& frame,
                 const Buffer& draws, const Buffer& glyphs) const;

 private:
  core::Result<void> create_layouts(const Device& device, std::uint32_t sets);
  core::Result<void> create_textures(const Device& device, const Overlay& overlay);
  core::Result<void> create_pipelines(const Device& device, VkFormat colour_format, bool pushed);

  UniqueSampler cloud_sampler_, font_sampler_;
  Image clouds_, font_;
  UniqueSetLayout set_layout_;
  UniqueDescriptorPool descriptor_pool_;
  UniquePipelineLayout layout_;
  UniquePipeline terrain_, model_, sky_, overlay_;
};

}  // namespace psygen::render
