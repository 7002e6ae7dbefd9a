#include "engine/world/far_forms.hpp"

#include <algorithm>
#include <cmath>

namespace psygen::world {
namespace {

constexpr glm::vec3 kUp{0, 1, 0};
constexpr float kCosine = -0.5F, kSine = 0.8660254F;  // of a third of a turn
constexpr float kThirds[3][2] = {{1, 0}, {kCosine, kSine}, {kCosine, -kSine}};
// The second corner on top of a chunk is so much lower, in parts of its height.
constexpr float kChunkStep = 0.4F;

// Sheets lie flat to the light where crowns shade themselves.
constexpr float kSheetShade = 0.6F;

template <std::size_t N>
void set_indices(FormMesh& out, const std::uint16_t (&list)[N], std::size_t first = 0) {
  static_assert(N <= std::tuple_size_v<decltype(out.indices)>);
  std::copy(std::begin(list), std::end(list),
            out.indices.begin() + static_cast<std::ptrdiff_t>(first));
}

Corner placed(Corner corner, const glm::vec3& position, const glm::vec3& normal) {
  corner.position = position;
  corner.normal = normal;
  return corner;
}

// The light of the upper and of the lower part of a crown, over all that is seen of it.
Corner upper_light(const Outline& o) {
  return mixed(o.top, o.mean_ring(), 0.35F);
}
Corner lower_light(const Outline& o) {
  return mixed(o.mean_ring(), o.bottom, 0.4F);
}

glm::vec3 axis_of(const Outline& o) {
  const glm::vec2 axis = o.axis();
  return {axis.x, 0, axis.y};
}

// The lowest point of a form that is stretched from the top down.
float base_of(const Outline& o, const Stretch& stretch) {
  return o.top.position.y - stretch.depth * (o.top.position.y - o.bottom.position.y);
}

// `along` times the turn and `aside` times the direction a quarter turn from it, towards +z from
// +x.
glm::vec3 turned(glm::vec2 turn, float along, float aside) {
  return {along * turn.x - aside * turn.y, 0, along * turn.y + aside * turn.x};
}

void make_spindle(const Outline& o, const Stretch& stretch, FormMesh& out) {
  const glm::vec3 axis = axis_of(o);
  const glm::vec3 scale{stretch.width, 1, stretch.width};
  out.corners[0] = o.top;
  for (std::size_t i = 0; i < 4; ++i)
    out.corners[1 + i] =
        placed(o.ring[i], axis + scale * (o.ring[i].position - axis), o.ring[i].normal);
  out.corners[5] = o.bottom;
  set_indices(out, {0, 2, 1, 0, 3, 2, 0, 4, 3, 0, 1, 4, 5, 1, 2, 5, 2, 3, 5, 3, 4, 5, 4, 1});
}

void add_trunk_cone(const Outline& o, glm::vec2 turn, FormMesh& out) {
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec3 away = turned(turn, kThirds[i][0], kThirds[i][1]);
    out.corners[6 + i] = placed(o.foot, o.foot.position + o.trunk_radius * away, away);
  }
  out.corners[9] = placed(o.foot, axis_of(o) + o.ring_height() * kUp, kUp);
  set_indices(out, {9, 7, 6, 9, 8, 7, 9, 6, 8}, 24);
}

void make_chunk(const Outline& o, const Stretch& stretch, glm::vec2 turn, FormMesh& out) {
  const float top = o.top.position.y, base = base_of(o, stretch);
  const float r = stretch.width * o.ring_radius();
  const glm::vec3 axis = axis_of(o);
  const Corner upper = upper_light(o), lower = lower_light(o);
  const float heights[2] = {top, top - kChunkStep * (top - base)};
  for (std::size_t i = 0; i < 2; ++i) {
    const float sign = i == 0 ? 1.0F : -1.0F;
    const glm::vec3 along = turned(turn, sign, 0), aside = turned(turn, 0, sign);
    out.corners[i] = placed(upper, axis + r * along + heights[i] * kUp, along + 0.6F * kUp);
    out.corners[2 + i] = placed(lower, axis + r * aside + base * kUp, aside - 0.2F * kUp);
  }
  set_indices(out, {0, 1, 2, 1, 0, 3, 0, 2, 3, 1, 3, 2});
}

// In the plane of the turn; the cone is narrower in the mean than at its foot.
void add_trunk_triangle(const Outline& o, glm::vec2 turn, FormMesh& out) {
  for (std::size_t i = 0; i < 2; ++i) {
    const glm::vec3 along = turned(turn, i == 0 ? -1.0F : 1.0F, 0);
    out.corners[4 + i] = placed(o.foot, o.foot.position + o.trunk_radius * along, along);
  }
  out.corners[6] = placed(o.foot, axis_of(o) + o.ring_height() * kUp, kUp);
  set_indices(out, {4, 5, 6}, 12);
}

void make_spire(const Outline& o, const Stretch& stretch, glm::vec2 turn, FormMesh& out) {
  const float r = stretch.width * o.ring_radius();
  const glm::vec3 foot = axis_of(o) + base_of(o, stretch) * kUp;
  const Corner lower = lower_light(o);
  out.corners[0] = o.top;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec3 away = turned(turn, kThirds[i][0], kThirds[i][1]);
    out.corners[1 + i] = placed(lower, foot + r * away, away - 0.1F * kUp);
  }
  set_indices(out, {0, 2, 1, 0, 3, 2, 0, 1, 3});
}

}  // namespace

void make_form(Form form, const Outline& outline, const Stretch& stretch, glm::vec2 turn,
               FormMesh& out) {
  switch (form) {
    case Form::kSpindleTrunk:
      make_spindle(outline, stretch, out);
      return add_trunk_cone(outline, turn, out);
    case Form::kSpindle:
      return make_spindle(outline, stretch, out);
    case Form::kChunkTrunk:
      make_chunk(outline, stretch, turn, out);
      return add_trunk_triangle(outline, turn, out);
    case Form::kChunk:
      return make_chunk(outline, stretch, turn, out);
    case Form::kSpire:
      return make_spire(outline, stretch, turn, out);
    case Form::kSheet:
      return make_sheet(outline, {outline.ring_radius(), 0, 0}, turn, {0, 0}, out);
  }
}

// A triangle with a base of 2a and the height h has, over all directions, the mean area 2 a h / π.
// It would be about as wide as long; where it must be higher than there is room for, it is longer
// instead, up to a limit beyond which it would not look like trees any more.
Sheet sheet_of(const Outline& outline, const Silhouette& silhouette, float models) {
  constexpr float kHalfPi = 1.57079633F, kLean = 1.5F, kMostElongation = 2.4F;
  const float plan = models * silhouette.plan_m2, side = models * silhouette.side_m2 * kHalfPi;
  const float top = std::max(outline.top.position.y, 1e-3F);
  const float compact = std::sqrt(plan / kLean);
  const float half = std::clamp(side / top, compact, kMostElongation * compact);
  if (!(half > 0)) return {0, 0, 0};
  return {half, plan / half, std::max(top - side / half, 0.0F)};
}

void make_sheet(const Outline& o, const Sheet& sheet, glm::vec2 turn, std::array<float, 2> ground,
                FormMesh& out) {
  const glm::vec3 axis = axis_of(o), away = turned(turn, 0, -1);
  Corner lower = lower_light(o), upper = upper_light(o);
  lower.ambient *= kSheetShade;
  upper.ambient *= kSheetShade;
  for (std::size_t i = 0; i < 2; ++i) {
    const glm::vec3 end =
        turned(turn, i == 0 ? -sheet.half_length_m : sheet.half_length_m, -0.5F * sheet.lean_m);
    out.corners[i] =
        placed(lower, axis + end + (sheet.base_m + ground[i]) * kUp, away + 0.5F * kUp);
  }
  const float top = o.top.position.y + 0.5F * (ground[0] + ground[1]);
  out.corners[2] =
      placed(upper, axis + turned(turn, 0, 0.5F * sheet.lean_m) + top * kUp, 0.5F * away + kUp);
  set_indices(out, {0, 2, 1});
}

}  // namespace psygen::world
