// The crown's colour, and the closed hull that represents it at levels 4 and 5.
#include "engine/models/tree/mesh.hpp"
#include "engine/models/tree/random.hpp"

namespace psygen::models {
namespace {

constexpr std::uint8_t kLeaf = 1;

std::array<std::uint8_t, 3> packed(const std::array<float, 3>& c, float brightness) {
  return {pack_unorm8(c[0] * brightness), pack_unorm8(c[1] * brightness),
          pack_unorm8(c[2] * brightness)};
}

// Corners of a unit sphere: top, rings, bottom.
constexpr float kA = 0.894427191F, kB = 0.447213595F;  // of an icosahedron
constexpr float kC1 = 0.309016994F, kS1 = 0.951056516F, kC2 = 0.809016994F, kS2 = 0.587785252F;
constexpr float kBall[kBallVertices][3] = {{0, 1, 0},
                                           {kA, kB, 0},
                                           {kA * kC1, kB, kA* kS1},
                                           {-kA * kC2, kB, kA* kS2},
                                           {-kA * kC2, kB, -kA* kS2},
                                           {kA * kC1, kB, -kA* kS1},
                                           {kA * kC2, -kB, kA* kS2},
                                           {-kA * kC1, -kB, kA* kS1},
                                           {-kA, -kB, 0},
                                           {-kA * kC1, -kB, -kA* kS1},
                                           {kA * kC2, -kB, -kA* kS2},
                                           {0, -1, 0}};
constexpr std::uint32_t kBallIndices[3 * kBallTriangles] = {
    0, 2,  1, 0, 3,  2,  0, 4, 3,  0, 5, 4,  0, 1, 5,  1, 2,  6,  2,  7,
    6, 2,  3, 7, 3,  8,  7, 3, 4,  8, 4, 9,  8, 4, 5,  9, 5,  10, 9,  5,
    1, 10, 1, 6, 10, 11, 6, 7, 11, 7, 8, 11, 8, 9, 11, 9, 10, 11, 10, 6};
constexpr float kOctahedron[kOctahedronVertices][3] = {{0, 1, 0},  {1, 0, 0},  {0, 0, 1},
                                                       {-1, 0, 0}, {0, 0, -1}, {0, -1, 0}};
constexpr std::uint32_t kOctahedronIndices[3 * kOctahedronTriangles] = {
    0, 2, 1, 0, 3, 2, 0, 4, 3, 0, 1, 4, 5, 1, 2, 5, 2, 3, 5, 3, 4, 5, 4, 1};

// Maps a corner of the unit sphere to the crown, relative to its middle. The more a crown narrows
// towards one end, the closer the ring of its wider half is to the other end.
glm::vec3 stretched(const float (&corner)[3], bool ball, const CrownOutline& o) {
  const bool end = corner[0] == 0.0F && corner[2] == 0.0F;
  const float narrow = (o.upper - o.lower) / (o.upper + o.lower);
  float radius = 1.1F * std::max(o.upper, o.lower), y = corner[1];
  if (ball) {
    radius = (corner[1] > 0.0F ? o.upper : o.lower) * (1.0F / kA);
    const float shift = 0.6F * narrow;
    if (!end) y += corner[1] > 0.0F ? std::max(shift, 0.0F) : std::min(shift, 0.0F);
  } else if (!end) {
    y = std::clamp(1.2F * narrow, -0.9F, 0.9F);
  }
  return {radius * corner[0], o.half_height * y, radius * corner[2]};
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

void mesh_hull(const TreePlan& plan, int level, const TreeCrown& crown, const CrownOutline& outline,
               MeshWriter& out) {
  const bool ball = level == 4;
  const LeafTint tint = leaf_tint(plan);
  const std::uint32_t first = out.vertex_count();
  const glm::vec3 middle{crown.centre.x, outline.middle, crown.centre.z};
  for (std::uint32_t k = 0; k < (ball ? kBallVertices : kOctahedronVertices); ++k) {
    const auto& corner = ball ? kBall[k] : kOctahedron[k];
    const std::uint32_t h = number_of(plan.key, plan.salt, kHullNumber + k);
    const glm::vec3 place = middle + (plan.foliage.hull * (0.85F + 0.3F * low_fraction(h))) *
                                         stretched(corner, ball, outline);
    const std::array<float, 3> colour =
        leaf_colour(plan, tint.hue + 0.1F * plan.colour_variation * (high_fraction(h) - 0.5F));
    out.vertex(place, {pack_unorm8((ball ? 0.78F : 0.7F) * crown_ambient(crown, place)), 200,
                       glm::vec3(corner[0], corner[1] + 0.2F, corner[2]),
                       packed(colour, 0.9F * tint.brightness), kLeaf});
  }
  const std::uint32_t* indices = ball ? kBallIndices : kOctahedronIndices;
  for (std::uint32_t k = 0; k < 3 * (ball ? kBallTriangles : kOctahedronTriangles); k += 3)
    out.triangle(first + indices[k], first + indices[k + 1], first + indices[k + 2]);
}

}  // namespace psygen::models
