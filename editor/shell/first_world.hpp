// What the editor shows without a file, and where the camera stands in it: the valley of the
// README. Values.
#pragma once

#include <glm/trigonometric.hpp>

#include "engine/core/camera.hpp"

namespace psygen::editor {

inline constexpr const char* kFirstWorld = "silver_combe";
inline constexpr double kFirstHeightM = 24;  // over the ground

inline core::CameraPose first_pose() {
  return {{{}, {-1257, 0, 3978}}, glm::radians(110.0), glm::radians(-10.0)};
}

}  // namespace psygen::editor
