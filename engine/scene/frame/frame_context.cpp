#include "engine/scene/frame/frame_context.hpp"

#include <algorithm>

namespace psygen::scene {

Rules rules_of(const SceneSettings& settings, bool settling) {
  const bool lazy = settings.paradigm == Paradigm::kLazyEvaluation;
  const bool pla = settings.paradigm == Paradigm::kParallelLazyAmplification;
  return {.request = settings.paradigm != Paradigm::kDataAmplification,
          .wait = lazy,
          .keep = !lazy,
          .look_ahead = pla,
          .coarse_first = pla && settings.levels_of_detail,
          .settle = settling};
}

float fade_fraction(const FrameContext& frame, double last_s) {
  constexpr double kMinSeconds = 1.0 / 240.0;
  const double passed_s = std::max(frame.clock.now_s - last_s, kMinSeconds);
  const double whole_s = frame.settings.fade_seconds;
  return whole_s <= passed_s ? 1.0F : static_cast<float>(passed_s / whole_s);
}

}  // namespace psygen::scene
