// The crown as a whole: its place and extent, its light and colour, and the closed hull that
// stands for it at levels 4 and 5.
#include "engine/models/tree_mesh.hpp"

namespace psygen::models {
namespace {

constexpr std::uint64_t kHullSalt = 0x2F72B4215A3D8CAFull;
constexpr std::uint64_t kTreeTintSalt = 0x589965CC75374CC3ull;
constexpr std::uint8_t kLeaf = 1;

std::array<std::uint8_t, 3> packed(const std::array<float, 3>& c, float brightness) {
  return {pack_unorm8(c[0] * brightness), pack_unorm8(c[1] * brightness),
          pack_unorm8(c[2] * brightness)};
}

}  // namespace

std::array<float, 3> leaf_colour(float hue) {
  static constexpr float kRamp[5][3] = {{0.21F, 0.33F, 0.17F},
                                        {0.32F, 0.42F, 0.17F},
                                        {0.62F, 0.56F, 0.17F},
                                        {0.64F, 0.36F, 0.13F},
                                        {0.50F, 0.18F, 0.12F}};
  const float x = std::min(std::max(hue, 0.0F), 1.0F) * 4.0F;
  const int i = std::min(static_cast<int>(x), 3);
  const float f = x - static_cast<float>(i);
  std::array<float, 3> c;
  for (std::size_t k = 0; k < 3; ++k)
    c[k] = kRamp[i][k] + f * (kRamp[i + 1][k] - kRamp[i][k]);
  return c;
}

LeafTint leaf_tint(const TreeShape& shape) {
  const Fractions f(core::mix64(shape.root_key ^ kTreeTintSalt));
  return {shape.leaf_hue + shape.colour_variation * 0.12F * (f.f[0] - 0.5F),
          1.0F + shape.colour_variation * 0.24F * (f.f[1] - 0.5F)};
}

TreeCrown crown_of(const TreeShape& shape, const TreeSkeleton& sample) {
  glm::vec3 sum(0.0F), squares(0.0F);
  const float inverse = 1.0F / static_cast<float>(sample.tip_count());
  for (std::uint32_t i = sample.first_tip(); i < sample.count; ++i)
    sum += sample.point(i, 1.0F);
  const glm::vec3 center = sum * inverse;
  for (std::uint32_t i = sample.first_tip(); i < sample.count; ++i) {
    const glm::vec3 d = sample.point(i, 1.0F) - center;
    squares += d * d;
  }
  const float least = 0.3F * shape.size_m;
  const float across = least + 1.5F * std::sqrt((squares.x + squares.z) * 0.5F * inverse);
  const float up = least + 1.5F * std::sqrt(squares.y * inverse);
  const glm::vec3 half{across, up, across};
  return {center, half, 1.0F / half, (2.0F * across + up) * (1.0F / 3.0F)};
}

void mesh_hull(const TreeShape& shape, int level, const TreeCrown& crown, MeshWriter& out) {
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
  const LeafTint tint = leaf_tint(shape);
  const std::uint32_t first = out.vertex_count();
  const float grow = ball ? 1.05F : 1.3F;
  for (std::uint32_t k = 0; k < (ball ? kBallVertices : kOctahedronVertices); ++k) {
    const float* corner = ball ? kBall[k] : kOctahedron[k];
    const glm::vec3 unit{corner[0], corner[1], corner[2]};
    const Fractions a(core::mix64(shape.root_key + kHullSalt * (k + 1)));
    const glm::vec3 place = crown.center + crown.half * unit * (grow * (0.85F + 0.3F * a.f[0]));
    const std::array<float, 3> colour =
        leaf_colour(tint.hue + 0.1F * shape.colour_variation * (a.f[1] - 0.5F));
    out.vertex(place, {pack_unorm8((ball ? 0.78F : 0.7F) * crown_ambient(crown, place)), 200,
                       pack_normal(normalised3(unit + glm::vec3(0.0F, 0.2F, 0.0F))),
                       packed(colour, 0.9F * tint.brightness), kLeaf});
  }
  const std::uint32_t* indices = ball ? kBallIndices : kOctahedronIndices;
  for (std::uint32_t k = 0; k < 3 * (ball ? kBallTriangles : kOctahedronTriangles); k += 3)
    out.triangle(first + indices[k], first + indices[k + 1], first + indices[k + 2]);
}

}  // namespace psygen::models
