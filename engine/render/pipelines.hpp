// Every pipeline of a preset, the one descriptor set layout and the textures that never change. All
// are made on one thread, before the first frame of the preset. Private to engine/render.
#pragma once

#include <vector>

#include "engine/render/overlay.hpp"
#include "engine/render/pipeline_build.hpp"
#include "engine/render/preset.hpp"
#include "engine/render/shadow_maps.hpp"

namespace psygen::render {

class Pipelines {
 public:
  // What text needs, and so many descriptor sets.
  core::Result<void> create(const Device& device, VkFormat colour_format,
                            const PresetTraits& traits, const Overlay& overlay, std::uint32_t sets);
  // Once, after that: what everything else needs. `progress` is called after each pipeline.
  core::Result<void> create_others(const Device& device, const Progress& progress);

  const PresetTraits& traits() const { return traits_; }
  VkSampleCountFlagBits samples() const { return samples_; }
  VkPipelineLayout layout() const { return layout_.get(); }
  // `pushed`: the draw's data is in push constants, else in the buffer of draws.
  // `fading`: of models that come or go.
  VkPipeline mesh(core::VertexLayout layout, bool pushed, bool fading, View view) const;
  // Into a cascade; only where the preset has some.
  VkPipeline mesh_shadow(core::VertexLayout layout, bool pushed, bool fading) const {
    return shadow_.of(layout, pushed, fading);
  }
  VkPipeline water() const { return water_.get(); }
  VkPipeline lines() const { return lines_.get(); }
  const ShadowMaps& shadows() const { return shadows_; }
  // Over the whole picture; where light is found per vertex what is below the
  // horizon, then a dome, then the sun.
  VkPipeline sky() const { return sky_.get(); }
  VkPipeline sky_below() const { return sky_below_.get(); }
  VkPipeline sun() const { return sun_.get(); }
  VkPipeline overlay() const { return overlay_.get(); }

  VkDescriptorSet set(std::size_t number) const { return sets_[number]; }
  // Lets a set read the given buffers, and the textures.
  void write_set(const Device& device, VkDescriptorSet set, const Buffer& frame,
                 const Buffer& draws, const Buffer& glyphs) const;

 private:
  core::Result<void> create_layouts(const Device& device, std::uint32_t sets);
  core::Result<void> create_sets(const Device& device, std::uint32_t count);
  core::Result<void> create_textures(const Device& device, const Overlay& overlay);
  struct MeshPipelines {
    // By layout (terrain, model) and by whether the data is pushed.
    std::array<std::array<UniquePipeline, 2>, 2> whole;
    std::array<UniquePipeline, 2> fading;  // models; by whether the data is pushed

    VkPipeline of(core::VertexLayout layout, bool is_pushed, bool is_fading) const {
      const std::size_t pushed = is_pushed ? 1 : 0;
      if (is_fading) return fading[pushed].get();
      return whole[layout == core::VertexLayout::kTerrain ? 0 : 1][pushed].get();
    }
  };
  // While pipelines are made.
  struct Making {
    const Device& device;
    const Progress& progress;
    int count = 0;
  };
  PipelineShape usual_shape() const;
  core::Result<void> make(Making& making, const PipelineShape& shape, UniquePipeline& out);
  core::Result<void> create_landscape(Making& making);
  core::Result<void> create_sky(Making& making);
  core::Result<void> create_views(Making& making);
  core::Result<void> create_meshes(Making& making, PipelineShape shape, MeshLook look,
                                   MeshPipelines& out);
  core::Result<void> create_fading(Making& making, PipelineShape shape, MeshLook look,
                                   MeshPipelines& out);

  PresetTraits traits_;
  VkSampleCountFlagBits samples_ = VK_SAMPLE_COUNT_1_BIT;
  VkFormat colour_format_ = VK_FORMAT_UNDEFINED;
  UniqueSampler cloud_sampler_, font_sampler_;
  ShadowMaps shadows_;
  Image clouds_, font_;
  UniqueSetLayout set_layout_;
  UniqueDescriptorPool descriptor_pool_;
  std::vector<VkDescriptorSet> sets_;
  UniquePipelineLayout layout_;
  MeshPipelines landscape_, coloured_, wireframe_, shadow_;
  UniquePipeline water_, sky_, sky_below_, sun_, lines_, overlay_;
};

}  // namespace psygen::render
