// Scales a landscape of fewer pixels up to the picture. Private to engine/render.
#pragma once

#include "engine/render/passes/pass.hpp"

namespace psygen::render {

// Empty until create(). The device and the sets of the frame must outlive it.
class ScaleUp {
 public:
  // The functions of Pass (pass.hpp).
  static constexpr Stage kStage = Stage::kPicture;
  static constexpr int warm_up_steps(Feature feature) {
    return feature == Feature::kLandscape ? 1 : 0;
  }
  core::Result<void> create(const PassSetup& setup);
  void use(const Device& device, const FrameSlot& slot, const Targets& targets);
  void record(const Recording& to) const;
  void warm_up(const Recording& to, const WarmUpStep&) const { record(to); }

 private:
  PassSet set_;  // instead of set 0: its texture is the first (shaders/scale_up.glsl)
  VkDescriptorImageInfo any_image_{};
  UniquePipeline pipeline_;
};
static_assert(Pass<ScaleUp>);

}  // namespace psygen::render
