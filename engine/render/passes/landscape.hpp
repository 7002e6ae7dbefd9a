// Ground, models and objects: from a list of the CPU, or chosen by the device (gpu_culling.hpp).
// Private to engine/render.
#pragma once

#include "engine/render/passes/pass.hpp"

namespace psygen::render {

// It begins the renderings of the landscape itself: the device culls between two of them, and
// software devices split one into parts. It leaves the last one open for what follows. Its
// pipelines are those of MeshTables.
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

}  // namespace psygen::render
