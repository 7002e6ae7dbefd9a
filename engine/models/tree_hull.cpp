// The crown's colour, and the closed hull that stands for it at levels 4 and 5.
#include "engine/models/tree_mesh.hpp"
#include "engine/models/tree_random.hpp"

namespace psygen::models {
namespace {

constexpr std::uint8_t kLeaf = 1;

std::array<std::uint8_t, 3> packed(const std::array<float, 3>& c, float brightness) {
  return {pack_unorm8(c[0] * brightness), pack_unorm8(c[1] * brightness),
          pack_unorm8(c[2] * brightness)};
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
