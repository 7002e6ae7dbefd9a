// Every pipeline, the one descriptor set layout and the textures that never change. All are made on
// one thread at start-up. Private to engine/render.
#pragma once

#include "engine/core/vertex_layout.hpp"
#include "engine/render/memory.hpp"
#include "engine/render/overlay.hpp"

namespace psygen::render {

inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

class Pipelines {
 public:
  // `sets` descriptor sets can be made.
  core::Result<void> create(const Device& device, VkFormat colour_format, const Overlay& overlay,
                            std::uint32_t sets);

  VkPipelineLayout layout() const { return layout_.get(); }
  // `pushed`: the draw's data is in push constants, else in the buffer of draws.
  VkPipeline mesh(core::VertexLayout layout, bool pushed) const {
    if (layout == core::VertexLayout::kTerrain) return (pushed ? terrain_pushed_ : terrain_).get();
    return (pushed ? model_pushed_ : model_).get();
  }
  VkPipeline sky() const { return sky_.get(); }
  VkPipeline overlay() const { return overlay_.get(); }

  // A set that reads the given buffers and the textures.
  core::Result<VkDescriptorSet> make_set(const Device& device);
  void write_set(const Device& device, VkDescriptorSet set, const Buffer& frame,
                 const Buffer& draws, const Buffer& glyphs) const;

 private:
  core::Result<void> create_layouts(const Device& device, std::uint32_t sets);
  core::Result<void> create_textures(const Device& device, const Overlay& overlay);
  core::Result<void> create_pipelines(const Device& device, VkFormat colour_format);

  UniqueSampler cloud_sampler_, font_sampler_;
  Image clouds_, font_;
  UniqueSetLayout set_layout_;
  UniqueDescriptorPool descriptor_pool_;
  UniquePipelineLayout layout_;
  UniquePipeline terrain_, terrain_pushed_, model_, model_pushed_, sky_, overlay_;
};

}  // namespace psygen::render
