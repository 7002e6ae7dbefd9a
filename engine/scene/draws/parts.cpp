#include "engine/scene/draws/parts.hpp"

#include <algorithm>
#include <cmath>

#include "engine/scene/view/visibility.hpp"

namespace psygen::scene {
namespace {

glm::vec2 flat(glm::vec3 v) {
  return {v.x, v.z};
}

// Rounds in steps so large that neighbours can often share a draw.
float in_steps(float share) {
  constexpr float kSteps = 6;
  return std::round(share * kSteps) / kSteps;
}

}  // namespace

bool add_parts(const MeshParts& parts, const View* view, const GroundSunlight& sun, float side_m,
               const render::MeshDraw& draw, std::vector<render::MeshDraw>& draws) {
  bool any = false;
  DrawParts run(draw, draws);
  for (std::uint32_t i = 0; i < parts.count; ++i) {
    if (view != nullptr && !mesh_may_be_visible(parts.boxes[i], draw.origin, *view)) continue;
    run.set_sun(in_steps(
        sun_over(sun, flat(parts.boxes[i].min) / side_m, flat(parts.boxes[i].max) / side_m)));
    const std::uint32_t first = i * parts.indices_each;
    run.add({first, std::min(parts.indices_each, parts.index_count - first)});
    any = true;
  }
  return any;
}

}  // namespace psygen::scene
