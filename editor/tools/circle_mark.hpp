// A circle on the ground as a mark of a tool: a brush, or what a model covers. Pure.
#pragma once

#include <cmath>
#include <numbers>

#include "editor/view/view_tool.hpp"

namespace psygen::editor {

// Metres of the world, x and z.
inline ToolMarks::Line circle_mark(glm::dvec2 middle_m, double radius_m, const glm::vec3& colour) {
  constexpr int kPoints = 48;
  ToolMarks::Line line;
  line.colour = colour;
  for (int i = 0; i <= kPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPoints;
    line.points_m.push_back(middle_m + radius_m * glm::dvec2(std::sin(angle), std::cos(angle)));
  }
  return line;
}

}  // namespace psygen::editor
