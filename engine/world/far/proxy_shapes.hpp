// Forms: proxy shapes of a few triangles that stand in for distant models, made from their
// outlines. Every form has a fixed number of vertices and triangles. Pure functions, any thread,
// constant time. docs/models.md, "Vegetation".
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>

#include "engine/world/far/outline.hpp"

namespace psygen::world {

// The forms, most detailed first.
enum class Form : std::uint8_t {
  kSpindleTrunk,  // a spindle, and a trunk: a billboard of one triangle down to the ground
  kSpindle,       // the crown as a double pyramid with four sides
  kChunk,         // a tetrahedron on its edge: wide at the top and at the bottom
  kKiteTrunk,     // a kite, and the same trunk
  kKite,          // the crown as a billboard of two triangles, widest in the middle
  kTent,          // a billboard of one triangle, widest at its base, for one or several models
  kPicture,       // an impostor: a billboard of two triangles (tree_impostors.hpp)
};
inline constexpr std::size_t kProxyCount = 7;
// Sizes of a form. The first `solid_vertices` belong to a solid, the others to billboards, which
// turn about their vertical axes towards the camera.
struct ProxySize {
  std::uint32_t vertices, triangles, solid_vertices;
};
inline constexpr std::array<ProxySize, kProxyCount> kProxySizes{
    {{9, 9, 6}, {6, 8, 6}, {4, 4, 4}, {7, 3, 0}, {4, 2, 0}, {3, 1, 0}, {4, 2, 0}}};
// The sizes of a form; true if it has no solid part.
constexpr ProxySize size_of(Form form) {
  return kProxySizes[static_cast<std::size_t>(form)];
}
constexpr bool is_billboard(Form form) {
  return size_of(form).solid_vertices == 0;
}

// The mesh of one form, in metres from the model's base point. The first size_of(form) elements are
// used. Triangles are counter-clockwise from outside. Corners of billboards lie on their axis;
// `aside` is their distance to the right of it and behind it, from the camera.
struct ProxyMesh {
  std::array<Corner, 9> corners;
  std::array<glm::vec2, 9> aside;
  std::array<std::uint16_t, 27> indices;
};

// Makes a form that is not a billboard, `width` times as wide as the outline. Asymmetric forms
// point along the unit vector `turn`, in x and z.
void make_proxy(Form form, const Outline& outline, float width, glm::vec2 turn, ProxyMesh& out);

// The dimensions of a billboard. From the side it has the area of `models` models together, from
// above half of it. Kites always stand in for one model. The width is limited, so that many models
// do not become a long wall; then the area is smaller.
struct Billboard {
  float half_width_m, lean_m;  // lean: distance of the top behind the base
  float base_m;                // height of the lowest corner above the ground
};
// The dimensions for `models` models with this outline and silhouette.
Billboard billboard_of(Form form, const Outline& outline, const Silhouette& silhouette,
                       float models);
// Makes a form that is a billboard, except kPicture, with these dimensions.
void make_billboard(Form form, const Outline& outline, const Billboard& billboard, ProxyMesh& out);

}  // namespace psygen::world
