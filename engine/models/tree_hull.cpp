// The crown as a whole: its place and extent, its light and colour, and the closed hull that
// stands for it at levels 4 and 5.
#include "engine/models/tree_mesh.hpp"
#include "engine/models/tree_paths.hpp"

namespace psygen::models {
namespace {

constexpr std::uint8_t kLeaf = 1;

std::array<std::uint8_t, 3> packed(const std::array<float, 3>& c, float brightness) {
  return {pack_unorm8(c[0] * brightness), pack_unorm8(c[1] * brightness),
          pack_unorm8(c[2] * brightness)};
}

// Calls `visit` with the end of every branch that the crown is made of.
template <class Visit>
void for_crown_ends(const TreePlan& plan, const TreeSkeleton& s, const Visit& visit) {
  const bool by_leaves = has_bearers(plan, s);
  for (std::size_t g = 0; g < s.group_count; ++g) {
    const TreeGroup& group = s.groups[g];
    const bool counts = by_leaves ? bears_leaves(plan, group) : group.tip;
    for (std::uint32_t i = 0; counts && i < group.count; ++i)
      visit(s.point(group.first + i, 1.0F));
  }
}

}  // namespace

std::array<float, 3> leaf_colour(const TreePlan& plan, float hue) {
  float x = hue * 4.0F;
  if (plan.cyclic) x -= 4.0F * std::floor(hue);
  x = std::min(std::max(x, 0.0F), 4.0F);
  const int i = std::min(static_cast<int>(x), 3);
  const float f = x - static_cast<float>(i);
  const auto at = static_cast<std::size_t>(i);
  std::array<float, 3> c;
  for (std::size_t k = 0; k < 3; ++k)
    c[k] = plan.ramp[at][k] + f * (plan.ramp[at + 1][k] - plan.ramp[at][k]);
  return c;
}

LeafTint leaf_tint(const TreePlan& plan) {
  const std::uint32_t h = number_of(plan.key, plan.salt, kTintNumber);
  return {plan.hue + plan.colour_variation * 0.12F * (low_fraction(h) - 0.5F),
          1.0F + plan.colour_variation * 0.24F * (high_fraction(h) - 0.5F)};
}

TreeCrown crown_of(const TreePlan& plan, const TreeSkeleton& sample) {
  glm::vec3 sum(0.0F), squares(0.0F);
  std::uint32_t count = 0;
  for_crown_ends(plan, sample, [&](const glm::vec3& end) {
    sum += end;
    ++count;
  });
  const float inverse = 1.0F / static_cast<float>(std::max(count, 1U));
  const glm::vec3 center = sum * inverse;
  for_crown_ends(plan, sample, [&](const glm::vec3& end) {
    const glm::vec3 d = end - center;
    squares += d * d;
  });
  const float least = 0.3F * plan.size_m;
  const float across = least + 1.5F * std::sqrt((squares.x + squares.z) * 0.5F * inverse);
  const float up = least + 1.5F * std::sqrt(squares.y * inverse);
  const glm::vec3 half{across, up, across};
  return {center, half, 1.0F / half, (2.0F * across + up) * (1.0F / 3.0F)};
}

float crown_ambient(const TreeCrown& crown, const glm::vec3& p) {
  const glm::vec3 r = (p - crown.center) * crown.inverse_half;
  const float squared = std::min(r.x * r.x + r.y * r.y + r.z * r.z, 1.44F);
  return (0.3F + 0.7F / 1.44F * squared) * std::min(std::max(0.8F + 0.2F * r.y, 0.6F), 1.0F);
}

void mesh_hull(const TreePlan& plan, int level, const TreeCrown& crown, MeshWriter& out) {
  static constexpr float kA = 0.525731112F, kB = 0.850650808F;
  static constexpr float kBall[kBallVertices][3] = {
      {-kA, kB, 0},  {kA, kB, 0},  {-kA, -kB, 0}, {kA, -kB, 0}, {0, -kA, kB},  {0, kA, kB},
      {0, -kA, -kB}, {0, kA, -kB}, {kB, 0, -kA},  {kB, 0, kA},  {-kB, 0, -kA}, {-kB, 0, kA}};
  static constexpr std::uint32_t kBallIndices[3 * kBallTriangles] = {
      0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
      4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
      6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
  static constexpr float kR = 0.85F, kH = 0.52F, kS = 0.736121593F;
  static constexpr float kOctahedron[kOctahedronVertices][3] = {
      {kR, kH, 0},          {-0.5F * kR, kH, kS}, {-0.5F * kR, kH, -kS},
      {0.5F * kR, -kH, kS}, {-kR, -kH, 0},        {0.5F * kR, -kH, -kS}};
  static constexpr std::uint32_t kOctahedronIndices[3 * kOctahedronTriangles] = {
      0, 2, 1, 3, 4, 5, 0, 1, 3, 1, 4, 3, 1, 2, 4, 2, 5, 4, 2, 0, 5, 0, 3, 5};
  const bool ball = level == 4;
  const LeafTint tint = leaf_tint(plan);
  const std::uint32_t first = out.vertex_count();
  const float grow = ball ? 1.05F : 1.3F;
  for (std::uint32_t k = 0; k < (ball ? kBallVertices : kOctahedronVertices); ++k) {
    const float* corner = ball ? kBall[k] : kOctahedron[k];
    const float narrow = 1.0F - plan.hull_taper * (0.5F + 0.5F * corner[1]);
    const glm::vec3 unit{corner[0], corner[1], corner[2]};
    const std::uint32_t h = number_of(plan.key, plan.salt, kHullNumber + k);
    const glm::vec3 shape{narrow * corner[0], corner[1], narrow * corner[2]};
    const glm::vec3 place =
        crown.center + crown.half * shape * (grow * (0.85F + 0.3F * low_fraction(h)));
    const std::array<float, 3> colour =
        leaf_colour(plan, tint.hue + 0.1F * plan.colour_variation * (high_fraction(h) - 0.5F));
    out.vertex(place,
               {pack_unorm8((ball ? 0.78F : 0.7F) * crown_ambient(crown, place)), 200,
                unit + glm::vec3(0.0F, 0.2F, 0.0F), packed(colour, 0.9F * tint.brightness), kLeaf});
  }
  const std::uint32_t* indices = ball ? kBallIndices : kOctahedronIndices;
  for (std::uint32_t k = 0; k < 3 * (ball ? kBallTriangles : kOctahedronTriangles); k += 3)
    out.triangle(first + indices[k], first + indices[k + 1], first + indices[k + 2]);
}

}  // namespace psygen::models
