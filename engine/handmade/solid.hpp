// The collider of a handmade model: a few points that span a convex hull. Pure; any thread.
#pragma once

#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "engine/handmade/triangles.hpp"

namespace psygen::handmade {

// `kind` is one of world::kHandmadeColliders: the extreme points in 98 directions, the corners of
// the box, or none. Also none if all points lie in one plane, up to a thousandth of their extent.
std::vector<glm::vec3> solid_points(const Triangles& triangles, std::string_view kind);

}  // namespace psygen::handmade
