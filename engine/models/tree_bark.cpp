// Trunk and branches: tapering tubes around the skeleton's curves.
#include "engine/models/tree_mesh.hpp"

namespace psygen::models {
namespace {

constexpr std::uint32_t kMaxSides = 8;
constexpr std::uint64_t kBarkSalt = 0xE7037ED1A0B428DBull;

struct Circle {
  float x[kMaxSides], z[kMaxSides];
};
// Unit circle with `sides` corners, for the numbers of sides that the plans use.
const Circle& circle(std::uint32_t sides) {
  static constexpr float kHalf = 0.5F, kR3 = 0.866025404F, kR2 = 0.707106781F;
  static constexpr Circle kThree{{1, -kHalf, -kHalf}, {0, kR3, -kR3}};
  static constexpr Circle kFour{{1, 0, -1, 0}, {0, 1, 0, -1}};
  static constexpr Circle kFive{{1, 0.309016994F, -0.809016994F, -0.809016994F, 0.309016994F},
                                {0, 0.951056516F, 0.587785252F, -0.587785252F, -0.951056516F}};
  static constexpr Circle kSix{{1, kHalf, -kHalf, -1, -kHalf, kHalf}, {0, kR3, kR3, 0, -kR3, -kR3}};
  static constexpr Circle kEight{{1, kR2, 0, -kR2, -1, -kR2, 0, kR2},
                                 {0, kR2, 1, kR2, 0, -kR2, -1, -kR2}};
  switch (sides) {
    case 3:
      return kThree;
    case 4:
      return kFour;
    case 5:
      return kFive;
    case 6:
      return kSix;
    default:
      return kEight;
  }
}

// Where the trunk's rings are, closer together at the foot.
float trunk_t(std::uint32_t segments, std::uint32_t ring) {
  static constexpr float kSixRings[] = {0.0F, 0.06F, 0.16F, 0.34F, 0.55F, 0.78F, 1.0F};
  static constexpr float kThreeRings[] = {0.0F, 0.14F, 0.5F, 1.0F};
  static constexpr float kTwoRings[] = {0.0F, 0.2F, 1.0F};
  if (segments == 6) return kSixRings[ring];
  if (segments == 3) return kThreeRings[ring];
  if (segments == 2) return kTwoRings[ring];
  return static_cast<float>(ring) / static_cast<float>(segments);
}

// A pseudo-random factor in [0, 1) for ring vertex k of a branch with this hash.
float vertex_noise(std::uint64_t hash, std::uint32_t k) {
  const std::uint32_t x = static_cast<std::uint32_t>(hash >> (k & 31U)) ^ (k * 0x9E3779B9U);
  return static_cast<float>((x * 0x85EBCA6BU) >> 16) * (1.0F / 65536.0F);
}

std::array<std::uint8_t, 3> bark_colour(const TreeShape& shape, float brightness) {
  static constexpr float kGrey[3] = {0.48F, 0.46F, 0.43F};
  static constexpr float kBrown[3] = {0.36F, 0.28F, 0.21F};
  std::array<std::uint8_t, 3> result;
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = pack_unorm8((kGrey[i] + shape.bark_tone * (kBrown[i] - kGrey[i])) * brightness);
  return result;
}

struct Tube {
  TubePlan plan;
  Frame frame;
  std::uint64_t hash;
  std::uint8_t sway_start, sway_end;
};

float bark_ambient(const TreeShape& shape, const TreeCrown& crown, const glm::vec3& p) {
  const float contact = std::min(0.55F + 1.5F * std::max(p.y, 0.0F) / shape.size_m, 1.0F);
  return contact * crown_ambient(crown, p);
}

void write_ring(const TreeShape& shape, const TreeSkeleton& s, const TreeCrown& crown,
                std::uint32_t node, const Tube& tube, std::uint32_t ring, MeshWriter& out) {
  const bool trunk = node == 0;
  const float t = trunk ? trunk_t(tube.plan.segments, ring)
                        : static_cast<float>(ring) / static_cast<float>(tube.plan.segments);
  glm::vec3 middle = s.point(node, t);
  if (trunk && ring == 0) middle.y -= sink_m(shape);
  const glm::vec3 tangent = normalised3(s.direction[node] + 2.0F * t * s.bend[node]);
  const float start = s.radius_start[node];
  const float radius = start + t * (s.radius_end[node] - start);
  const float near_foot = trunk ? std::max(1.0F - 3.0F * t, 0.0F) : 0.0F;
  const float coarse =
      tube.plan.segments >= 3 ? 1.0F : 0.3F * static_cast<float>(tube.plan.segments);
  const float flare = shape.flare * near_foot * near_foot * coarse;
  const std::uint8_t ambient = pack_unorm8(bark_ambient(shape, crown, middle));
  const auto sway =
      static_cast<std::uint8_t>(static_cast<float>(tube.sway_start) +
                                t * static_cast<float>(tube.sway_end - tube.sway_start));
  const Circle& unit = circle(tube.plan.sides);
  const std::uint32_t corners =
      tube.plan.pointed && ring == tube.plan.segments ? 1 : tube.plan.sides;
  for (std::uint32_t side = 0; side < corners; ++side) {
    glm::vec3 normal = unit.x[side] * tube.frame.u + unit.z[side] * tube.frame.v;
    normal -= dot3(normal, tangent) * tangent;
    const float lobe = 0.4F + 1.2F * vertex_noise(tube.hash, side);  // roots
    const float noise = vertex_noise(tube.hash, 16 + ring * kMaxSides + side);
    out.vertex(middle + (radius * (1.0F + flare * lobe)) * normal,
               {ambient, sway, pack_normal(normal), bark_colour(shape, 0.84F + 0.3F * noise), 0});
  }
}

void write_tube(const TreeShape& shape, const TreeSkeleton& s, const TreeCrown& crown,
                std::uint32_t node, const Tube& tube, MeshWriter& out) {
  const std::uint32_t first = out.vertex_count();
  const std::uint32_t sides = tube.plan.sides;
  for (std::uint32_t ring = 0; ring <= tube.plan.segments; ++ring)
    write_ring(shape, s, crown, node, tube, ring, out);
  for (std::uint32_t ring = 0; ring < tube.plan.segments; ++ring) {
    const std::uint32_t low = first + ring * sides, high = low + sides;
    const bool apex = tube.plan.pointed && ring + 1 == tube.plan.segments;
    for (std::uint32_t side = 0; side < sides; ++side) {
      const std::uint32_t next = side + 1 == sides ? 0 : side + 1;
      if (apex) {
        out.triangle(low + side, high, low + next);
      } else {
        out.triangle(low + side, high + side, low + next);
        out.triangle(low + next, high + side, high + next);
      }
    }
  }
}

std::uint8_t sway_at(int depth, int tips_depth) {
  const int d = std::max(tips_depth, 1);
  return static_cast<std::uint8_t>(std::min(30 + 170 * depth / d, 200));
}

// Three triangles from a ring about `from` to the crown's centre.
void write_cone(const TreeShape& shape, const glm::vec3& from, float radius, std::uint8_t ambient,
                const TreeCrown& crown, MeshWriter& out) {
  const std::uint32_t first = out.vertex_count();
  const Circle& unit = circle(3);
  const auto colour = bark_colour(shape, 0.99F);
  for (std::size_t side = 0; side < 3; ++side) {
    const glm::vec3 normal{unit.x[side], 0.0F, unit.z[side]};
    out.vertex(from + radius * normal, {ambient, 20, pack_normal(normal), colour, 0});
  }
  const std::uint8_t inside = pack_unorm8(crown_ambient(crown, crown.center));
  out.vertex(crown.center, {inside, 100, pack_normal({0.0F, 1.0F, 0.0F}), colour, 0});
  for (std::uint32_t side = 0; side < 3; ++side)
    out.triangle(first + side, first + 3, first + (side + 1) % 3);
}

}  // namespace

TubePlan tube_plan(int level, int depth, bool tip) {
  static constexpr TubePlan kPlans[4][4] = {
      {{8, 6}, {5, 3}, {4, 2}, {3, 1}},
      {{6, 3}, {4, 2}, {3, 1}, {0, 0}},
      {{4, 2}, {3, 1}, {0, 0}, {0, 0}},
      {{3, 1}, {0, 0}, {0, 0}, {0, 0}},
  };
  TubePlan plan = kPlans[level][std::min(depth, 3)];
  plan.pointed = tip && plan.sides > 0;
  return plan;
}

void mesh_bark(const TreeShape& shape, int level, const TreeSkeleton& skeleton,
               const TreeCrown& crown, MeshWriter& out) {
  for (int depth = 0; depth <= skeleton.depth; ++depth) {
    const TubePlan plan = tube_plan(level, depth, depth == skeleton.depth);
    if (plan.sides == 0) continue;
    const auto d = static_cast<std::size_t>(depth);
    const std::uint8_t start = depth == 0 ? std::uint8_t{0} : sway_at(depth - 1, skeleton.depth);
    const std::uint8_t end = sway_at(depth, skeleton.depth);
    for (std::uint32_t i = skeleton.first[d]; i < skeleton.first[d + 1]; ++i)
      write_tube(shape, skeleton, crown, i,
                 {plan, frame_around(skeleton.direction[i]),
                  core::mix64(skeleton.key[i] ^ kBarkSalt), start, end},
                 out);
  }
}

void mesh_core(const TreeShape& shape, const TreeSkeleton& s, const TreeCrown& crown,
               MeshWriter& out) {
  const glm::vec3 from = s.point(0, 1.0F);
  write_cone(shape, from, s.radius_end[0], pack_unorm8(crown_ambient(crown, from)), crown, out);
}

void mesh_far_trunk(const TreeShape& shape, const TreeCrown& crown, MeshWriter& out) {
  const float radius = shape.radius_m * (1.0F + 0.3F * shape.flare);
  write_cone(shape, {0.0F, -sink_m(shape), 0.0F}, radius, pack_unorm8(0.6F), crown, out);
}

}  // namespace psygen::models
