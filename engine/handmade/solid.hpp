// The solid part of a handmade model: few points whose convex hull it is. Pure; any thread.
#pragma once

#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "engine/handmade/triangles.hpp"

namespace psygen::handmade {

// `kind` is one of world::kHandmadeColliders: the points that are farthest in 98 directions, the
// corners of the box, or none. None too where all points lie in one plane, up to a thousandth of
// their extent.
std::vector<glm::vec3> solid_points(const Triangles& triangles, std::string_view kind);

}  // namespace psygen::handmade
