// The plane of water. Drawn after the sky: it is blended over what lies under it, and over the sky
// where nothing does. Private to engine/render.
#pragma once

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
  void list(const FrameInput& input, const FrameFacts&) { visible_ = input.water.has_value(); }
  void use(const Device& device, const FrameSlot& slot, const Targets& targets);
  void record(const Recording& to) const {
    if (visible_) draw(to, to.lamps);
  }
  void warm_up(const Recording& to, const WarmUpStep& step) const { draw(to, step.lamps); }

  // True if the listed frame shows water.
  bool visible() const { return visible_; }

 private:
  void draw(const Recording& to, bool lamps) const;

  PassSet set_;  // the reflected landscape; empty if water reflects only the sky
  VkDescriptorImageInfo any_image_{};
  UniquePipeline plain_, lamplit_;
  bool visible_ = false;
};
static_assert(Pass<Water>);

}  // namespace psygen::render
