// The sky behind the landscape. With light per pixel it fills the whole picture. With light per
// vertex it is a dome, with a part below the horizon and the sun. Private to engine/render.
#pragma once

#include "engine/render/passes/pass.hpp"

namespace psygen::render {

// Empty until create(). The device and the sets of the frame must outlive it.
class Sky {
 public:
  // The functions of Pass (pass.hpp).
  static constexpr Stage kStage = Stage::kLandscape;
  static constexpr int warm_up_steps(Feature feature) {
    return feature == Feature::kLandscape ? 1 : 0;
  }
  core::Result<void> create(const PassSetup& setup);
  void record(const Recording& to) const;
  void warm_up(const Recording& to, const WarmUpStep&) const { record(to); }

 private:
  UniquePipeline sky_, below_, sun_;  // the last two only with light per vertex
};
static_assert(Pass<Sky>);

}  // namespace psygen::render
