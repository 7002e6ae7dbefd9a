#include "engine/world/far/outline.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/models/kit/packing.hpp"

namespace psygen::world {
namespace {

core::ModelVertex vertex_at(std::span<const std::byte> vertices, std::size_t i) {
  core::ModelVertex v;
  std::memcpy(&v, vertices.data() + i * sizeof v, sizeof v);
  return v;
}

// The vertices furthest along ±x, ±y, ±z of all that were added.
struct Extremes {
  std::array<std::size_t, 6> at{};  // −x, −y, −z, +x, +y, +z
  std::size_t count = 0;

  void add(const core::ModelVertex& v, std::size_t i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int16_t q = v.position[axis];
      if (count == 0 || q < min_[axis]) {
        min_[axis] = q;
        at[axis] = i;
      }
      if (count == 0 || q > max_[axis]) {
        max_[axis] = q;
        at[3 + axis] = i;
      }
    }
    ++count;
  }

 private:
  std::array<std::int16_t, 3> min_{}, max_{};
};

// Sets the foot to the mean of the vertices that are not leaves, and the trunk's radius to the
// largest distance of their lowest tenth from the axis through the foot.
void measure_trunk(std::span<const std::byte> vertices, const core::Bounds& box, Outline& outline) {
  const std::size_t count = vertices.size() / sizeof(core::ModelVertex);
  float lowest = 0, highest = 0, solids = 0;
  Corner sum;
  sum.ambient = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const core::ModelVertex v = vertex_at(vertices, i);
    if (v.material == kLeaf) continue;
    const Corner c = corner_of(v, box);
    lowest = solids == 0 ? c.position.y : std::min(lowest, c.position.y);
    highest = solids == 0 ? c.position.y : std::max(highest, c.position.y);
    sum.colour += c.colour;
    sum.ambient += c.ambient;
    ++solids;
  }
  if (solids == 0) return;
  sum.colour *= 1 / solids;
  sum.ambient *= 1 / solids;
  sum.position = {0, lowest, 0};
  outline.foot = sum;
  for (std::size_t i = 0; i < count; ++i) {
    const core::ModelVertex v = vertex_at(vertices, i);
    const glm::vec3 p = models::unpack_position(v, box);
    if (v.material == kLeaf || p.y > lowest + 0.1F * (highest - lowest)) continue;
    outline.trunk_radius = std::max(outline.trunk_radius, std::sqrt(p.x * p.x + p.z * p.z));
  }
}

}  // namespace

Corner corner_of(const core::ModelVertex& v, const core::Bounds& box) {
  const glm::vec3 colour = glm::vec3(v.colour[0], v.colour[1], v.colour[2]) * (1.0F / 255.0F);
  return {models::unpack_position(v, box),
          models::decode_octahedral(glm::vec2(v.normal[0], v.normal[1]) * (1.0F / 32767.0F)),
          colour,
          static_cast<float>(v.ambient) * (1.0F / 255.0F),
          static_cast<float>(v.sway) * (1.0F / 255.0F),
          static_cast<std::uint8_t>(v.material & kLeaf)};
}

Corner mixed(const Corner& a, const Corner& b, float t) {
  const float s = 1 - t;
  return {a.position * s + b.position * t, a.normal * s + b.normal * t, a.colour * s + b.colour * t,
          a.ambient * s + b.ambient * t,   a.sway * s + b.sway * t,     a.material};
}

glm::vec2 Outline::axis() const {
  const glm::vec3 sum = ring[0].position + ring[1].position + ring[2].position + ring[3].position;
  return {0.25F * sum.x, 0.25F * sum.z};
}

float Outline::ring_height() const {
  return 0.25F *
         (ring[0].position.y + ring[1].position.y + ring[2].position.y + ring[3].position.y);
}

float Outline::ring_radius() const {
  const glm::vec2 middle = axis();
  float sum = 0;
  for (const Corner& c : ring) {
    const float x = c.position.x - middle.x, z = c.position.z - middle.y;
    sum += std::sqrt(x * x + z * z);
  }
  return 0.25F * sum;
}

Corner Outline::mean_ring() const {
  Corner mean = mixed(mixed(ring[0], ring[1], 0.5F), mixed(ring[2], ring[3], 0.5F), 0.5F);
  mean.normal = {0, 1, 0};
  return mean;
}

Outline Outline::scaled(float across, float up) const {
  Outline result = *this;
  const glm::vec3 scale{across, up, across};
  for (Corner* c : {&result.top, &result.bottom, &result.ring[0], &result.ring[1], &result.ring[2],
                    &result.ring[3], &result.foot})
    c->position *= scale;
  result.trunk_radius *= across;
  return result;
}

std::optional<Outline> outline_of(std::span<const std::byte> vertices, const core::Bounds& box) {
  const std::size_t count = vertices.size() / sizeof(core::ModelVertex);
  if (count == 0) return std::nullopt;
  Extremes leaves, all;
  for (std::size_t i = 0; i < count; ++i) {
    const core::ModelVertex v = vertex_at(vertices, i);
    all.add(v, i);
    if (v.material == kLeaf) leaves.add(v, i);
  }
  Outline outline;
  outline.leafy = leaves.count > 0;
  const Extremes& chosen = outline.leafy ? leaves : all;
  const auto corner = [&](std::size_t i) {
    return corner_of(vertex_at(vertices, chosen.at[i]), box);
  };
  outline.top = corner(4);
  outline.bottom = corner(1);
  outline.ring = {corner(3), corner(5), corner(0), corner(2)};
  if (outline.leafy) measure_trunk(vertices, box, outline);
  return outline;
}

}  // namespace psygen::world
