#include "engine/world/far/proxy_shapes.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/assert.hpp"

namespace psygen::world {
namespace {

constexpr glm::vec3 kUp{0, 1, 0};
// Height difference of a chunk's two upper corners, relative to the chunk's height.
constexpr float kChunkStep = 0.4F;

// Ambient light of flat billboards relative to a crown, which shades itself.
constexpr float kBillboardShade = 0.6F;

template <std::size_t N>
void set_indices(ProxyMesh& out, const std::uint16_t (&list)[N], std::size_t first = 0) {
  static_assert(N <= std::tuple_size_v<decltype(out.indices)>);
  std::copy(std::begin(list), std::end(list),
            out.indices.begin() + static_cast<std::ptrdiff_t>(first));
}

Corner placed(Corner corner, const glm::vec3& position, const glm::vec3& normal) {
  corner.position = position;
  corner.normal = normal;
  return corner;
}

// The mean light and colour of the visible upper and lower part of a crown.
Corner upper_light(const Outline& o) {
  return mixed(o.top, o.mean_ring(), 0.35F);
}
Corner lower_light(const Outline& o) {
  return mixed(o.mean_ring(), o.bottom, 0.4F);
}

Corner flat(Corner corner) {
  if (corner.material == kLeaf) corner.ambient *= kBillboardShade;
  return corner;
}

glm::vec3 axis_of(const Outline& o) {
  const glm::vec2 axis = o.axis();
  return {axis.x, 0, axis.y};
}

// `along` times the direction `turn`, plus `aside` times the direction a quarter turn from it (from
// +x towards +z).
glm::vec3 turned(glm::vec2 turn, float along, float aside) {
  return {along * turn.x - aside * turn.y, 0, along * turn.y + aside * turn.x};
}

void make_spindle(const Outline& o, float width, ProxyMesh& out) {
  const glm::vec3 axis = axis_of(o);
  const glm::vec3 scale{width, 1, width};
  out.corners[0] = o.top;
  for (std::size_t i = 0; i < 4; ++i)
    out.corners[1 + i] =
        placed(o.ring[i], axis + scale * (o.ring[i].position - axis), o.ring[i].normal);
  out.corners[5] = o.bottom;
  set_indices(out, {0, 2, 1, 0, 3, 2, 0, 4, 3, 0, 1, 4, 5, 1, 2, 5, 2, 3, 5, 3, 4, 5, 4, 1});
}

// Appends a trunk after `vertices` vertices and `indices` indices.
void add_trunk(const Outline& o, std::size_t vertices, std::size_t indices, ProxyMesh& out) {
  const auto first = static_cast<std::uint16_t>(vertices);
  const auto second = static_cast<std::uint16_t>(vertices + 1);
  const auto third = static_cast<std::uint16_t>(vertices + 2);
  for (std::size_t i = 0; i < 2; ++i) {
    out.corners[vertices + i] = o.foot;
    out.aside[vertices + i] = {i == 0 ? -o.trunk_radius : o.trunk_radius, 0};
  }
  out.corners[vertices + 2] = placed(o.foot, axis_of(o) + o.ring_height() * kUp, kUp);
  out.aside[vertices + 2] = {0, 0};
  set_indices(out, {first, second, third}, indices);
}

void make_chunk(const Outline& o, float width, glm::vec2 turn, ProxyMesh& out) {
  const float top = o.top.position.y, base = o.bottom.position.y;
  const float r = width * o.ring_radius();
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

// A kite is widest at the height where the crown is.
void make_kite(const Outline& o, const Billboard& b, ProxyMesh& out) {
  const glm::vec3 axis = axis_of(o);
  const float top = o.top.position.y, bottom = o.bottom.position.y;
  const float part = (o.ring_height() - bottom) / std::max(top - bottom, 1e-3F);
  const float middle = b.base_m + std::clamp(part, 0.2F, 0.8F) * (top - b.base_m);
  const Corner lower = flat(lower_light(o)), upper = flat(upper_light(o));
  const Corner between = mixed(lower, upper, 0.5F);
  for (std::size_t i = 0; i < 2; ++i) {
    out.corners[i] = placed(between, axis + middle * kUp, kUp);
    out.aside[i] = {i == 0 ? -b.half_width_m : b.half_width_m, 0};
  }
  out.corners[2] = placed(upper, axis + top * kUp, kUp);
  out.aside[2] = {0, 0.5F * b.lean_m};
  out.corners[3] = placed(lower, axis + b.base_m * kUp, kUp);
  out.aside[3] = {0, -0.5F * b.lean_m};
  set_indices(out, {0, 1, 2, 1, 0, 3});
}

// The area of the trunk's triangle that the crown does not hide.
float seen_trunk_m2(const Outline& o) {
  const float tip = std::max(o.ring_height(), 1e-3F);
  const float hidden = std::clamp(1 - o.bottom.position.y / tip, 0.0F, 1.0F);
  return o.trunk_radius * tip * (1 - hidden * hidden);
}

// A tent with base 2a and height h has the area a h, and so has a kite of width 2a. Crowns keep
// their width. Other models may become narrower, to reach down to their lower end. Both become
// wider where they would otherwise reach into the ground.
float half_width(const Outline& o, float side_m2, float models) {
  const float top = std::max(o.top.position.y, 1e-3F);
  const float height = std::max(top - std::max(o.bottom.position.y, 0.0F), 1e-3F);
  const float wide = std::sqrt(models) * o.ring_radius();
  return std::max(side_m2 / top, o.leafy ? wide : std::min(wide, side_m2 / height));
}

void make_tent(const Outline& o, const Billboard& b, ProxyMesh& out) {
  const glm::vec3 axis = axis_of(o);
  const Corner lower = flat(lower_light(o));
  for (std::size_t i = 0; i < 2; ++i) {
    out.corners[i] = placed(lower, axis + b.base_m * kUp, kUp);
    out.aside[i] = {i == 0 ? -b.half_width_m : b.half_width_m, -0.5F * b.lean_m};
  }
  out.corners[2] = placed(flat(upper_light(o)), axis + o.top.position.y * kUp, kUp);
  out.aside[2] = {0, 0.5F * b.lean_m};
  set_indices(out, {0, 1, 2});
}

}  // namespace

void make_proxy(Form form, const Outline& outline, float width, glm::vec2 turn, ProxyMesh& out) {
  PSYGEN_CHECK(!is_billboard(form), "make_proxy() makes solids; use make_billboard()");
  if (form == Form::kChunk) return make_chunk(outline, width, turn, out);
  make_spindle(outline, width, out);
  if (form == Form::kSpindleTrunk) add_trunk(outline, 6, 24, out);
}

Billboard billboard_of(Form form, const Outline& outline, const Silhouette& silhouette,
                       float models) {
  constexpr float kMaxElongation = 2, kLean = 0.5F;
  const float trunk = form == Form::kKiteTrunk ? seen_trunk_m2(outline) : 0;
  const float one = std::max(silhouette.side_m2 - trunk, 0.1F * silhouette.side_m2);
  const float plan = models * silhouette.plan_m2, side = models * one;
  const float most = std::max(kMaxElongation * std::sqrt(plan), half_width(outline, one, 1));
  const float half = std::min(half_width(outline, side, models), most);
  if (!(half > 0 && side > 0)) return {0, 0, 0};
  const float top = std::max(outline.top.position.y, 1e-3F);
  return {half, kLean * plan / half, std::max(top - side / half, 0.0F)};
}

void make_billboard(Form form, const Outline& outline, const Billboard& billboard, ProxyMesh& out) {
  PSYGEN_CHECK(is_billboard(form) && form != Form::kPicture,
               "make_billboard() makes billboards other than impostors");
  if (form == Form::kTent) return make_tent(outline, billboard, out);
  make_kite(outline, billboard, out);
  if (form == Form::kKiteTrunk) add_trunk(outline, 4, 6, out);
}

}  // namespace psygen::world
