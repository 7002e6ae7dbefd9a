// The few triangles that stand for a model far away, made from its outline. A form has always the
// same number of vertices and triangles. Pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>

#include "engine/world/outline.hpp"

namespace psygen::world {

enum class Form : std::uint8_t {
  kSpindleTrunk,  // the crown as a double pyramid of four sides, and a cone to the ground
  kSpindle,       // the double pyramid alone
  kChunkTrunk,    // a chunk, and one triangle to the ground
  kChunk,         // a tetrahedron on its edge: broad at the top and at the bottom
  kSpire,         // a pyramid of three sides without a base
  kSheet,         // one leaning triangle for several models
};
inline constexpr std::size_t kFormCount = 6;
struct FormSize {
  std::uint32_t vertices, triangles;
};
inline constexpr std::array<FormSize, kFormCount> kFormSizes{
    {{10, 11}, {6, 8}, {7, 5}, {4, 4}, {4, 3}, {3, 1}}};
constexpr FormSize size_of(Form form) {
  return kFormSizes[static_cast<std::size_t>(form)];
}

// Metres from the model's foot; the first size_of(form) elements are used. Counter-clockwise seen
// from outside; sheets and trunks of one triangle are seen from both sides.
struct FormMesh {
  std::array<Corner, 10> corners;
  std::array<std::uint16_t, 33> indices;
};

// How a form is stretched: about its axis, and down from its top.
struct Stretch {
  float width = 1, depth = 1;
};

// Any form but sheets. `turn` is a unit vector that the asymmetric ones point along.
void make_form(Form form, const Outline& outline, const Stretch& stretch, glm::vec2 turn,
               FormMesh& out);

// A sheet for `models` of them, whose length and lean give as much area from the side (in the mean
// over all directions) and from above as they have together.
struct Sheet {
  float half_length_m, lean_m;
  float base_m;  // height of the lower edge above the ground
};
Sheet sheet_of(const Outline& outline, const Silhouette& silhouette, float models);
// `ground` is the ground's height at the ends, −turn and +turn, above that at the foot.
void make_sheet(const Outline& outline, const Sheet& sheet, glm::vec2 turn,
                std::array<float, 2> ground, FormMesh& out);

}  // namespace psygen::world
