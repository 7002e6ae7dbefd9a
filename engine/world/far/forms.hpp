// The few triangles that stand for a model far away, made from its outline. A form has always the
// same number of vertices and triangles. Pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>

#include "engine/world/far/outline.hpp"

namespace psygen::world {

enum class Form : std::uint8_t {
  kSpindleTrunk,  // a spindle, and a billboard of one triangle to the ground
  kSpindle,       // the crown as a double pyramid of four sides
  kChunk,         // a tetrahedron on its edge: broad at the top and at the bottom
  kKiteTrunk,     // a kite, and the trunk as above
  kKite,          // the crown as a billboard of two triangles, broadest in the middle
  kTent,          // a billboard of one triangle, broadest at its foot, for one or several models
};
inline constexpr std::size_t kFormCount = 6;
// The first vertices are of a solid, the others of billboards, which turn about their axes towards
// the camera.
struct FormSize {
  std::uint32_t vertices, triangles, solid_vertices;
};
inline constexpr std::array<FormSize, kFormCount> kFormSizes{
    {{9, 9, 6}, {6, 8, 6}, {4, 4, 4}, {7, 3, 0}, {4, 2, 0}, {3, 1, 0}}};
constexpr FormSize size_of(Form form) {
  return kFormSizes[static_cast<std::size_t>(form)];
}
constexpr bool is_billboard(Form form) {
  return size_of(form).solid_vertices == 0;
}

// Metres from the model's foot; the first size_of(form) elements are used. Counter-clockwise seen
// from outside. Corners of billboards are on their axis, and `aside` says how far they are to the
// right and behind as the camera sees them.
struct FormMesh {
  std::array<Corner, 9> corners;
  std::array<glm::vec2, 9> aside;
  std::array<std::uint16_t, 27> indices;
};

// Any form but billboards, so many times as wide. `turn` is a unit vector that the asymmetric ones
// point along.
void make_form(Form form, const Outline& outline, float width, glm::vec2 turn, FormMesh& out);

// A billboard whose width and height give as much area from the side as `models` of them have
// together, and whose lean gives half as much from above; a kite is always for one. Where many
// would be a long wall it has less.
struct Billboard {
  float half_width_m, lean_m;
  float base_m;  // height of the lowest corner above the ground
};
Billboard billboard_of(Form form, const Outline& outline, const Silhouette& silhouette,
                       float models);
void make_billboard(Form form, const Outline& outline, const Billboard& billboard, FormMesh& out);

}  // namespace psygen::world
