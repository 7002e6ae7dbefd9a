// All graphics pipelines of a preset, and what their shaders read (bindings.hpp). They are created
// before the first frame of the preset. Records no draws (scene_recorder.hpp). Main thread. Private
// to engine/render.
#pragma once

#include <vector>

#include "engine/render/bindings.hpp"
#include "engine/render/draw_list.hpp"
#include "engine/render/pipeline_build.hpp"
#include "engine/render/preset.hpp"

namespace psygen::render {

// Empty until create(). The device must outlive it.
class Pipelines {
 public:
  // Creates the textures, `sets` descriptor sets, and the pipelines for text and for scaling up.
  core::Result<void> create(const Device& device, VkFormat colour_format,
                            const PresetTraits& traits, const Overlay& overlay, std::uint32_t sets,
                            const MaterialTable& materials, const ModelPictures& pictures,
                            std::span<const GroundPicture> ground);
  // Creates all other pipelines; call it once, after create(). `progress` is called after each
  // pipeline and can end it with kInterrupted.
  core::Result<void> create_others(const Device& device, const Progress& progress);

  // Creates those for objects, which few programs need, unless they exist.
  core::Result<void> create_objects(const Device& device);
  bool has_objects() const { return !objects_.whole.empty(); }

  // The same for what point lights reach, and for particles.
  core::Result<void> create_lamps(const Device& device);
  bool has_lamps() const { return lamplit_water_.get() != VK_NULL_HANDLE; }
  core::Result<void> create_particles(const Device& device);
  bool has_particles() const { return particles_[0].get() != VK_NULL_HANDLE; }

  // The preset, the samples per pixel that the device supports, and the pipeline layout.
  const PresetTraits& traits() const { return traits_; }
  VkSampleCountFlagBits samples() const { return samples_; }
  VkPipelineLayout layout() const { return bindings_.layout(); }
  // What their shaders read.
  const Bindings& bindings() const { return bindings_; }
  // Whether water mirrors the land: its pipelines need what Bindings::write_targets() binds.
  bool mirrors() const { return traits_.waves && samples_ != VK_SAMPLE_COUNT_1_BIT; }
  // The pipeline for meshes. `pushed`: the data of a draw is in push constants, else in the buffer
  // of draws. `lamps`, after create_lamps(): with point lights.
  VkPipeline mesh(core::VertexLayout layout, bool pushed, Coverage coverage, bool lamps,
                  View view) const;
  // The same for drawing into a cascade, if the preset has cascades.
  VkPipeline mesh_shadow(core::VertexLayout layout, bool pushed, Coverage coverage) const {
    return shadow_.of(layout, pushed, coverage);
  }
  // The pipeline for objects, after create_objects(). `textured`: the material's set is bound;
  // `fading`: those that fade or have holes.
  VkPipeline object(bool pushed, bool textured, bool fading, bool lamps, View view) const;
  VkPipeline object_shadow(bool pushed, bool textured, bool fading) const {
    return objects_.shadow[index_of_object(pushed, textured, fading)].get();
  }
  // Pipelines for water, particles and lines.
  VkPipeline water(bool lamps) const { return lamps ? lamplit_water_.get() : water_.get(); }
  VkPipeline particles(bool textured) const { return particles_[textured ? 1 : 0].get(); }
  VkPipeline lines() const { return lines_.get(); }
  // The sky. With light per pixel, sky() fills the whole picture and the others are null. With
  // light per vertex, sky_below() fills the part below the horizon, sky() is a dome, sun() comes
  // last.
  VkPipeline sky() const { return sky_.get(); }
  VkPipeline sky_below() const { return sky_below_.get(); }
  VkPipeline sun() const { return sun_.get(); }
  // Scales a landscape of fewer pixels up, in the pass over it.
  VkPipeline scale_up() const { return scale_up_.get(); }
  // Text, in the pass of the landscape or in that over a coarse one (begin_pass_over_coarse()).
  VkPipeline overlay(bool over_coarse) const {
    return (over_coarse ? overlay_over_coarse_ : overlay_).get();
  }

 private:
  struct MeshPipelines {
    // Indexed by layout (terrain, model) and by whether the data is pushed.
    std::array<std::array<UniquePipeline, 2>, 2> whole;
    std::array<UniquePipeline, 2> fading;       // models, indexed by whether the data is pushed
    std::array<UniquePipeline, 2> pictured;     // the same
    std::array<UniquePipeline, 2> near_ground;  // the same; null if it is drawn like all terrain
    std::array<UniquePipeline, 2>
        near_models;  // the same; null if they are drawn like those that fade

    VkPipeline of(core::VertexLayout layout, bool is_pushed, Coverage coverage) const {
      const std::size_t pushed = is_pushed ? 1 : 0;
      if (layout == core::VertexLayout::kTerrain) {
        const VkPipeline near =
            coverage == Coverage::kPart ? near_ground[pushed].get() : VK_NULL_HANDLE;
        return near != VK_NULL_HANDLE ? near : whole[0][pushed].get();
      }
      if (coverage == Coverage::kPictured) return pictured[pushed].get();
      if (coverage == Coverage::kNear && near_models[pushed].get() != VK_NULL_HANDLE)
        return near_models[pushed].get();
      return coverage == Coverage::kWhole ? whole[1][pushed].get() : fading[pushed].get();
    }
  };
  static std::size_t index_of_object(bool pushed, bool textured, bool fading) {
    return (pushed ? 1U : 0U) + (textured ? 2U : 0U) + (fading ? 4U : 0U);
  }
  // Empty, or indexed by index_of_object(). Those of views have no textures.
  struct ObjectPipelines {
    std::vector<UniquePipeline> whole, lamplit, coloured, wireframe, shadow;
  };
  // State while pipelines are created.
  struct Making {
    const Device& device;
    const Progress& progress;
    int count = 0;
  };
  PipelineShape usual_shape() const;
  ShaderCode lit_frag(bool terrain) const;
  core::Result<void> make(Making& making, const PipelineShape& shape, UniquePipeline& out);
  core::Result<void> create_landscape(Making& making, bool lamps, MeshPipelines& out,
                                      UniquePipeline& water);
  core::Result<void> create_near_ground(Making& making, PipelineShape shape, MeshPipelines& out);
  core::Result<void> create_near_models(Making& making, PipelineShape shape, MeshPipelines& out);
  core::Result<void> create_sky(Making& making);
  core::Result<void> create_views(Making& making);
  core::Result<void> create_meshes(Making& making, PipelineShape shape, MeshLook look,
                                   MeshPipelines& out);
  core::Result<void> create_fading(Making& making, PipelineShape shape, MeshLook look,
                                   MeshPipelines& out);
  core::Result<void> create_objects(Making& making, MeshLook look, bool wireframe, bool lamps,
                                    std::vector<UniquePipeline>& out);
  core::Result<void> create_lamplit_objects(const Device& device);

  PresetTraits traits_;
  VkSampleCountFlagBits samples_ = VK_SAMPLE_COUNT_1_BIT;
  VkFormat colour_format_ = VK_FORMAT_UNDEFINED;
  Bindings bindings_;
  MeshPipelines landscape_, lamplit_, coloured_, wireframe_, shadow_;
  ObjectPipelines objects_;
  std::array<UniquePipeline, 2> particles_;  // indexed by whether they have a texture
  UniquePipeline water_, lamplit_water_, sky_, sky_below_, sun_, lines_;
  UniquePipeline overlay_, overlay_over_coarse_, scale_up_;
};

}  // namespace psygen::render
