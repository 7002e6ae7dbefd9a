// The plane of water, and the surfaces of rivers and lakes. Drawn after the sky: they are blended
// over what lies under them, and over the sky where nothing does. Private to engine/render.
#pragma once

#include <vector>

#include "engine/render/passes/pass.hpp"

namespace psygen::render {

// Empty until create(). The device and the sets of the frame must outlive it.
class Water {
 public:
  // The functions of Pass (pass.hpp).
  static constexpr Stage kStage = Stage::kSurface;
  static constexpr int warm_up_steps(Feature feature) {
    return feature == Feature::kLandscape || feature == Feature::kPointLights ? 1 : 0;
  }
  core::Result<void> create(const PassSetup& setup);
  void list(const FrameInput& input, const FrameFacts& facts);
  void use(const Device& device, const FrameSlot& slot, const Targets& targets);
  void record(const Recording& to) const;
  void warm_up(const Recording& to, const WarmUpStep& step) const;

  // True if the listed frame shows water.
  bool visible() const { return plane_ || !surfaces_.empty(); }
  // Numbers of the surfaces of rivers and lakes in the listed frame, and of their triangles.
  std::uint32_t surface_count() const { return static_cast<std::uint32_t>(surfaces_.size()); }
  std::uint64_t surface_triangles() const;

 private:
  // With and without point lights.
  struct Pipelines {
    UniquePipeline plain, lamplit;
    VkPipeline of(bool lamps) const { return lamps ? lamplit.get() : plain.get(); }
  };
  // The surface of a river or lake.
  struct Surface {
    core::GeometryRange range;
    // The whole range of push constants (draw.glsl): culling on the device pushes others before.
    struct Pushed {
      shaders::DrawData data;
      std::uint32_t cascade = 0;
    } pushed;
  };
  core::Result<void> create(const PassSetup& setup, PipelineShape shape, Pipelines& pipelines);
  void bind(const Recording& to, VkPipeline pipeline) const;

  PassSet set_;  // the reflected landscape; empty if water reflects only the sky
  VkDescriptorImageInfo any_image_{};
  Pipelines plane_pipelines_, surface_pipelines_;
  bool plane_ = false;
  std::vector<Surface> surfaces_;
};
static_assert(Pass<Water>);

}  // namespace psygen::render
