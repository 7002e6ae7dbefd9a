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

// A pseudo-random number in 0 … 7 for vertex k of a branch with this hash.
std::uint32_t vertex_noise(std::uint64_t hash, std::uint32_t k) {
  return static_cast<std::uint32_t>(hash >> (3 * k % 61)) & 7U;
}

std::array<std::uint8_t, 3> bark_colour(const TreeShape& shape, float brightness) {
  static constexpr float kGrey[3] = {0.48F, 0.46F, 0.43F};
  static constexpr float kBrown[3] = {0.36F, 0.28F, 0.21F};
  std::array<std::uint8_t, 3> result;
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = pack_unorm8((kGrey[i] + shape.bark_tone * (kBrown[i] - kGrey[i])) * brightness);
  return result;
}

// What all branches of a mesh have in common.
struct Bark {
  const TreeShape& shape;
  const TreeSkeleton& skeleton;
  const TreeCrown& crown;
  std::array<std::uint8_t, 3> colours[8];
};

struct Tube {
  TubePlan plan;
  std::uint32_t node;
  std::uint64_t hash;
  float sway_start, sway_end;
  glm::vec3 around[kMaxSides];  // from the axis, perpendicular to the branch's start
  std::array<std::int16_t, 2> normal[kMaxSides], point_normal;
};

float bark_ambient(const TreeShape& shape, const TreeCrown& crown, const glm::vec3& p) {
  const float contact = std::min(0.55F + 1.5F * std::max(p.y, 0.0F) / shape.size_m, 1.0F);
  return contact * crown_ambient(crown, p);
}

void write_ring(const Bark& bark, const Tube& tube, std::uint32_t ring, MeshWriter& out) {
  const TreeSkeleton& s = bark.skeleton;
  const std::uint32_t node = tube.node, segments = tube.plan.segments;
  const bool trunk = node == 0;
  const float t =
      trunk ? trunk_t(segments, ring) : static_cast<float>(ring) / static_cast<float>(segments);
  glm::vec3 middle = s.point(node, t);
  if (trunk && ring == 0) middle.y -= sink_m(bark.shape);
  const float start = s.radius_start[node];
  const float radius = start + t * (s.radius_end[node] - start);
  float flare = 0.0F;
  if (trunk) {
    const float near_foot = std::max(1.0F - 3.0F * t, 0.0F);
    const float coarse = segments >= 3 ? 1.0F : 0.3F * static_cast<float>(segments);
    flare = bark.shape.flare * near_foot * near_foot * coarse;
  }
  const glm::vec3 turn = 2.0F * t * s.bend[node];
  MeshWriter::Look look{pack_unorm8(bark_ambient(bark.shape, bark.crown, middle)),
                        static_cast<std::uint8_t>(static_cast<int>(
                            tube.sway_start + t * (tube.sway_end - tube.sway_start))),
                        {},
                        {},
                        0};
  const bool point = tube.plan.pointed && ring == segments;
  const std::uint32_t corners = point ? 1 : tube.plan.sides;
  for (std::uint32_t side = 0; side < corners; ++side) {
    const glm::vec3& around = tube.around[side];
    const glm::vec3 sheared = around - dot3(around, turn) * s.direction[node];
    const float lobe = 0.4F + 0.16F * static_cast<float>(vertex_noise(tube.hash, side));  // roots
    look.normal = point ? tube.point_normal : tube.normal[side];
    look.colour = bark.colours[vertex_noise(tube.hash, ring * kMaxSides + side + 5)];
    out.vertex(middle + (radius * (1.0F + flare * lobe)) * sheared, look);
  }
}

void write_tube(const Bark& bark, const Tube& tube, MeshWriter& out) {
  const std::uint32_t first = out.vertex_count();
  const std::uint32_t sides = tube.plan.sides;
  for (std::uint32_t ring = 0; ring <= tube.plan.segments; ++ring)
    write_ring(bark, tube, ring, out);
  for (std::uint32_t ring = 0; ring < tube.plan.segments; ++ring) {
    const std::uint32_t low = first + ring * sides, high = low + sides;
    const bool apex = tube.plan.pointed && ring + 1 == tube.plan.segments;
    for (std::uint32_t side = 0; side < sides; ++side) {
      const std::uint32_t next = side + 1 == sides ? 0 : side + 1;
      if (apex) {
        out.triangle(low + side, low + next, high);
      } else {
        out.triangle(low + side, low + next, high + side);
        out.triangle(low + next, high + next, high + side);
      }
    }
  }
}

void enclose(const Bark& bark, std::uint32_t node, Tube& tube) {
  tube.node = node;
  tube.hash = core::mix64(bark.skeleton.key[node] ^ kBarkSalt);
  const Frame frame = frame_around(bark.skeleton.direction[node]);
  tube.point_normal = pack_normal(bark.skeleton.direction[node]);
  const Circle& unit = circle(tube.plan.sides);
  for (std::uint32_t side = 0; side < tube.plan.sides; ++side) {
    tube.around[side] = unit.x[side] * frame.u + unit.z[side] * frame.v;
    tube.normal[side] = pack_normal(tube.around[side]);
  }
}

float sway_at(int depth, int tips_depth) {
  return static_cast<float>(std::min(30 + 170 * depth / std::max(tips_depth, 1), 200));
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
  Bark bark{shape, skeleton, crown, {}};
  for (int i = 0; i < 8; ++i)
    bark.colours[i] = bark_colour(shape, 0.84F + 0.04F * static_cast<float>(i));
  for (int depth = 0; depth <= skeleton.depth; ++depth) {
    Tube tube;
    tube.plan = tube_plan(level, depth, depth == skeleton.depth);
    if (tube.plan.sides == 0) continue;
    tube.sway_start = depth == 0 ? 0.0F : sway_at(depth - 1, skeleton.depth);
    tube.sway_end = sway_at(depth, skeleton.depth);
    const auto d = static_cast<std::size_t>(depth);
    for (std::uint32_t i = skeleton.first[d]; i < skeleton.first[d + 1]; ++i) {
      enclose(bark, i, tube);
      write_tube(bark, tube, out);
    }
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
