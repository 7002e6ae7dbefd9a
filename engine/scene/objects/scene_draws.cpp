#include "engine/scene/objects/scene_draws.hpp"

#include <cmath>

namespace psygen::scene {

bool is_place(const core::WorldPosition& position) {
  constexpr double kFarM = 1e9;
  const auto near = [](double v) { return std::abs(v) <= kFarM; };
  return near(position.local.x) && near(position.local.y) && near(position.local.z);
}

bool is_valid(const Transform& transform) {
  constexpr float kMinScale = 1e-4F, kMaxScale = 1e4F;
  if (!is_place(transform.position)) return false;
  const glm::vec3 size = glm::abs(transform.scale);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(size[axis] >= kMinScale && size[axis] <= kMaxScale)) return false;
  }
  const float length = glm::length(transform.rotation);
  return length > 1e-6F && length < 1e6F;
}

}  // namespace psygen::scene
