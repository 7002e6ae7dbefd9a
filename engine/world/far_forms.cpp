#include "engine/world/far_forms.hpp"

#include <algorithm>

namespace psygen::world {
namespace {

// Rows: the upper edge is shorter than the lower one, and its ends differ in height.
constexpr float kUpperEdge = 0.7F, kLowerEnd = 0.8F;

template <std::size_t N>
void set_indices(FormMesh& out, const std::uint16_t (&list)[N]) {
  static_assert(N <= std::tuple_size_v<decltype(out.indices)>);
  std::copy(std::begin(list), std::end(list), out.indices.begin());
}

// Forms with straight sides are fuller than a crown: they must not be as high all around if they
// are to cover as much from the side and from above. Parts of the height from the lowest corner.
constexpr float kChunkStep = 0.45F, kSpireBase = 0.12F;
// Where a chunk ends: a little below the crown, as there is no trunk.
constexpr float kChunkBase = 0.8F;

// The light of a crown's lower part.
Corner base_corner(const Outline& o) {
  return mixed(o.mean_ring(), o.bottom, 0.35F);
}

Corner placed(Corner corner, const glm::vec3& position, const glm::vec3& normal) {
  corner.position = position;
  corner.normal = normal;
  return corner;
}

// `along` times the turn and `aside` times the direction a quarter turn from it, towards +z from
// +x.
glm::vec3 turned(glm::vec2 turn, float along, float aside) {
  return {along * turn.x - aside * turn.y, 0, along * turn.y + aside * turn.x};
}

void make_spindle(const Outline& o, float width, FormMesh& out) {
  const glm::vec2 axis = o.axis();
  out.corners[0] = o.top;
  for (std::size_t i = 0; i < 4; ++i) {
    Corner& c = out.corners[1 + i] = o.ring[i];
    c.position.x = axis.x + width * (c.position.x - axis.x);
    c.position.z = axis.y + width * (c.position.z - axis.y);
  }
  out.corners[5] = o.bottom;
  set_indices(out, {0, 2, 1, 0, 3, 2, 0, 4, 3, 0, 1, 4, 5, 1, 2, 5, 2, 3, 5, 3, 4, 5, 4, 1});
}

void make_spindle_trunk(const Outline& o, float width, glm::vec2 turn, FormMesh& out) {
  make_spindle(o, width, out);
  constexpr float kHalf = 0.5F, kSine = 0.8660254F;
  constexpr float kCorners[3][2] = {{1, 0}, {-kHalf, kSine}, {-kHalf, -kSine}};
  const glm::vec3 foot{o.foot.position.x, o.foot.position.y, o.foot.position.z};
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec3 away = turned(turn, kCorners[i][0], kCorners[i][1]);
    out.corners[6 + i] = placed(o.foot, foot + o.trunk_radius * away, away);
  }
  const glm::vec2 axis = o.axis();
  out.corners[9] = placed(o.foot, {axis.x, o.ring_height(), axis.y}, {0, 1, 0});
  constexpr std::uint16_t kCone[9] = {9, 7, 6, 9, 8, 7, 9, 6, 8};
  std::copy(std::begin(kCone), std::end(kCone), out.indices.begin() + 24);
}

void make_chunk(const Outline& o, float width, glm::vec2 turn, FormMesh& out) {
  const glm::vec2 axis = o.axis();
  const float top = o.top.position.y, bottom = o.bottom.position.y;
  const float base = bottom > 0 ? kChunkBase * bottom : bottom;
  const float r = width * o.ring_radius();
  const glm::vec3 middle{axis.x, 0, axis.y};
  const Corner upper = mixed(o.top, o.mean_ring(), 0.35F), lower = base_corner(o);
  const glm::vec3 up{0, 1, 0};
  const float heights[2] = {top, top - kChunkStep * (top - base)};
  for (std::size_t i = 0; i < 2; ++i) {
    const float sign = i == 0 ? 1.0F : -1.0F;
    const glm::vec3 along = turned(turn, sign, 0), aside = turned(turn, 0, sign);
    out.corners[i] = placed(upper, middle + r * along + heights[i] * up, 0.7F * along + up);
    out.corners[2 + i] = placed(lower, middle + r * aside + base * up, aside + 0.1F * up);
  }
  set_indices(out, {0, 1, 2, 1, 0, 3, 0, 2, 3, 1, 3, 2});
}

void make_spire(const Outline& o, float width, glm::vec2 turn, FormMesh& out) {
  const glm::vec2 axis = o.axis();
  const float r = width * o.ring_radius(), bottom = o.bottom.position.y;
  const float base = bottom + kSpireBase * (o.top.position.y - bottom);
  constexpr float kHalf = 0.5F, kSine = 0.8660254F;
  constexpr float kCorners[3][2] = {{1, 0}, {-kHalf, kSine}, {-kHalf, -kSine}};
  const Corner lower = base_corner(o);
  out.corners[0] = o.top;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec3 away = turned(turn, kCorners[i][0], kCorners[i][1]);
    out.corners[1 + i] =
        placed(lower, glm::vec3(axis.x, base, axis.y) + r * away, away + glm::vec3(0, 0.2F, 0));
  }
  set_indices(out, {0, 2, 1, 0, 3, 2, 0, 1, 3});
}

}  // namespace

void make_form(Form form, const Outline& outline, float width, glm::vec2 turn, FormMesh& out) {
  switch (form) {
    case Form::kSpindleTrunk:
      return make_spindle_trunk(outline, width, turn, out);
    case Form::kSpindle:
      return make_spindle(outline, width, out);
    case Form::kChunk:
      return make_chunk(outline, width, turn, out);
    case Form::kSpire:
      return make_spire(outline, width, turn, out);
    case Form::kRow:
      return make_row(outline, {outline.ring_radius(), 0}, turn, {0, 0}, out);
  }
}

// A sheet of length 2a and height h has, over all directions, the mean width 4a / π.
Row row_of(const Outline& outline, const Silhouette& silhouette, float models) {
  constexpr float kMeanWidth = 1.27323954F;
  const float height = 0.5F * (1 + kLowerEnd) * std::max(outline.top.position.y, 1e-3F);
  const float edges = 0.5F * (1 + kUpperEdge);
  const float half = models * silhouette.side_m2 / (kMeanWidth * edges * height);
  const float lean = half > 0 ? models * silhouette.plan_m2 / (2 * edges * half) : 0.0F;
  return {half, lean};
}

void make_row(const Outline& o, const Row& row, glm::vec2 turn, std::array<float, 2> ground,
              FormMesh& out) {
  const glm::vec2 axis = o.axis();
  const glm::vec3 middle{axis.x, 0, axis.y}, up{0, 1, 0};
  const Corner upper = mixed(o.top, o.mean_ring(), 0.35F), lower = base_corner(o);
  const glm::vec3 normal = up - turned(turn, 0, 0.6F);
  for (std::size_t i = 0; i < 2; ++i) {
    const float along = (i == 0 ? -1.0F : 1.0F) * row.half_length_m;
    const float top = o.top.position.y * (i == 0 ? 1.0F : kLowerEnd);
    out.corners[i] =
        placed(lower, middle + turned(turn, along, -0.5F * row.lean_m) + ground[i] * up, normal);
    out.corners[3 - i] = placed(
        upper,
        middle + turned(turn, kUpperEdge * along, 0.5F * row.lean_m) + (ground[i] + top) * up,
        normal);
  }
  set_indices(out, {0, 2, 1, 0, 3, 2});
}

}  // namespace psygen::world
