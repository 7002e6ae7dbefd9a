// Ground, models and objects: from a list of the CPU, or chosen by the device (gpu_culling.hpp);
// and the sun's shadows of the same meshes. The pipelines of both passes are those of MeshTables.
// Private to engine/render.
#pragma once

#include "engine/render/passes/pass.hpp"

namespace psygen::render {

// It begins the renderings of the landscape itself: the device culls between two of them, and
// software devices split one into parts. It leaves the last one open for what follows.
class Landscape {
 public:
  // The functions of Pass (pass.hpp).
  static constexpr Stage kStage = Stage::kLandscape;
  static constexpr int warm_up_steps(Feature feature) {
    const bool has_all = feature == Feature::kLandscape || feature == Feature::kPointLights;
    return has_all ? 3 : feature == Feature::kObjects ? 2 : 0;
  }
  void record(const Recording& to) const;
  void warm_up(const Recording& to, const WarmUpStep& step) const;
};
static_assert(Pass<Landscape>);

// The sun's shadows: the meshes of the frame, drawn into each cascade. Images and renderings are
// those of FrameSets::shadows().
class Shadows {
 public:
  // The functions of Pass (pass.hpp).
  static constexpr Stage kStage = Stage::kBefore;
  void list(const FrameInput&, const FrameFacts& facts) { active_ = facts.frame.shadow.y > 0; }
  void record(const Recording& to) const;

 private:
  bool active_ = false;  // the preset has cascades, and the sun shines
};
static_assert(Pass<Shadows>);

}  // namespace psygen::render
