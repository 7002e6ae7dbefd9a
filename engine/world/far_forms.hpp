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
  kChunk,         // a tetrahedron on its edge: broad at the top and at the bottom
  kSpire,         // a pyramid of three sides without a base
  kRow,           // a leaning sheet for several models in a row
};
inline constexpr std::size_t kFormCount = 5;
struct FormSize {
  std::uint32_t vertices, triangles;
};
inline constexpr std::array<FormSize, kFormCount> kFormSizes{
    {{10, 11}, {6, 8}, {4, 4}, {4, 3}, {4, 2}}};
constexpr FormSize size_of(Form form) {
  return kFormSizes[static_cast<std::size_t>(form)];
}

// Metres from the model's foot; the first size_of(form) elements are used. Counter-clockwise seen
// from outside; the sheet of a row is seen from both sides.
struct FormMesh {
  std::array<Corner, 10> corners;
  std::array<std::uint16_t, 33> indices;
};

// Any form but rows, `width` times as wide about its axis as its outline. `turn` is a unit vector
// that the asymmetric ones point along.
void make_form(Form form, const Outline& outline, float width, glm::vec2 turn, FormMesh& out);

// A row for `models` of them, whose length and lean give as much area from the side (in the mean
// over all directions) and from above as they have together.
struct Row {
  float half_length_m, lean_m;
};
Row row_of(const Outline& outline, const Silhouette& silhouette, float models);
// `ground` is the ground's height at the ends, −turn and +turn, above that at the foot.
void make_row(const Outline& outline, const Row& row, glm::vec2 turn, std::array<float, 2> ground,
              FormMesh& out);

}  // namespace psygen::world
