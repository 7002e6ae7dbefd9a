#include "engine/cli/request_recorder.hpp"

#include <algorithm>
#include <cmath>

#include "engine/scene/frame/clock.hpp"
#include "engine/synthesis/mesh_supply.hpp"

namespace psygen::cli {

void RequestRecorder::observe(const scene::Scene& scene) {
  const double now_s = std::max(scene.clock().now_s, 0.0);
  for (const synthesis::Want& want : scene.meshes().wants()) {
    if (!seen_.insert(want.key).second) continue;
    const double seconds = scene.meshes().predict(want);
    const bool due = synthesis::is_visible(want.rank.group()) || std::isfinite(want.deadline_s);
    const double ahead_s = synthesis::is_visible(want.rank.group()) ? 0.0 : double{want.deadline_s};
    jobs_.push_back({now_s, seconds, due ? now_s + ahead_s : synthesis::kNoDeadline, want.rank});
  }
}

}  // namespace psygen::cli
