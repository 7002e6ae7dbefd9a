// Foliage. Levels 0 … 3: sprays of three leaflets (six vertices, four triangles) in clusters about
// the tips; a coarser level has fewer and larger ones at places of the same skeleton, drawn
// towards the crown's centre by what they are larger, so that the outline stays. Levels 4 and 5:
// one closed hull. Normals follow the crown, not the leaf, which shades it as one soft volume.
#include "engine/models/tree_mesh.hpp"

namespace psygen::models {
namespace {

constexpr std::uint64_t kSpraySalt = 0x8EBC6AF09C88C6E3ull;
constexpr std::uint64_t kTreeTintSalt = 0x589965CC75374CC3ull;
constexpr std::uint8_t kLeaf = 1;

// Corners of a spray: along its axis, across, and against its normal, in spray lengths.
struct SprayForm {
  float along[kSprayVertices], across[kSprayVertices], droop[kSprayVertices];
  std::uint8_t indices[3 * kSprayTriangles];
  float length;  // that makes as many sprays as there are fill a crown of radius 1, times √count
};
// Three leaflets near by; a rounded patch further out.
constexpr SprayForm kLeaflets{{0.0F, 0.52F, 0.40F, 1.0F, 0.40F, 0.52F},
                              {0.0F, -0.60F, -0.20F, 0.0F, 0.20F, 0.60F},
                              {0.0F, 0.14F, 0.0F, 0.18F, 0.0F, 0.14F},
                              {0, 1, 2, 0, 2, 4, 2, 3, 4, 0, 4, 5},
                              6.2F};
constexpr SprayForm kPatch{{0.0F, 0.22F, 0.74F, 1.0F, 0.66F, 0.30F},
                           {0.0F, -0.46F, -0.40F, 0.06F, 0.44F, 0.40F},
                           {0.12F, 0.06F, 0.0F, 0.16F, 0.0F, 0.06F},
                           {0, 1, 5, 1, 2, 5, 2, 4, 5, 2, 3, 4},
                           4.4F};
const SprayForm& spray_form(int level) {
  return level <= 1 ? kLeaflets : kPatch;
}

using Colour = std::array<float, 3>;

// Stored (square root) leaf colours over the hue: deep green, green, yellow, orange, red.
Colour leaf_colour(float hue) {
  static constexpr float kRamp[5][3] = {{0.21F, 0.33F, 0.17F},
                                        {0.32F, 0.42F, 0.17F},
                                        {0.62F, 0.56F, 0.17F},
                                        {0.64F, 0.36F, 0.13F},
                                        {0.50F, 0.18F, 0.12F}};
  const float x = std::min(std::max(hue, 0.0F), 1.0F) * 4.0F;
  const int i = std::min(static_cast<int>(x), 3);
  const float f = x - static_cast<float>(i);
  Colour c;
  for (std::size_t k = 0; k < 3; ++k)
    c[k] = kRamp[i][k] + f * (kRamp[i + 1][k] - kRamp[i][k]);
  return c;
}

// The colour of a whole tree before its leaves vary: (hue, brightness).
struct Tint {
  float hue, brightness;
};
Tint tree_tint(const TreeShape& shape) {
  const Fractions f(core::mix64(shape.root_key ^ kTreeTintSalt));
  return {shape.leaf_hue + shape.colour_variation * 0.12F * (f.f[0] - 0.5F),
          1.0F + shape.colour_variation * 0.24F * (f.f[1] - 0.5F)};
}

std::array<std::uint8_t, 3> packed(const Colour& c, float brightness) {
  return {pack_unorm8(c[0] * brightness), pack_unorm8(c[1] * brightness),
          pack_unorm8(c[2] * brightness)};
}

// What all sprays of one mesh have in common.
struct Foliage {
  const TreeShape& shape;
  const TreeCrown& crown;
  const SprayForm& form;
  Tint tint;
  float length_m;   // of a spray
  float cluster_m;  // radius of a tip's cluster
  float pull;       // cluster positions relative to the crown's centre are times this
};

// 1 / sqrt(x) without needing it exact: x is a small count.
float inverse_root(std::uint32_t x) {
  return 1.0F / std::sqrt(static_cast<float>(x));
}

Foliage foliage(const TreeShape& shape, int level, const TreeCrown& crown, std::uint32_t tips,
                std::uint32_t sprays) {
  const SprayForm& form = spray_form(level);
  const float fitting = (level == 1 ? 1.08F : 1.0F) * form.length * crown.radius *
                        inverse_root(sprays) * shape.leaf_scale;
  const float length = std::min(fitting, 2.0F * shape.size_m);
  const float cluster = std::min(2.1F * crown.radius * inverse_root(tips), 0.6F * crown.radius);
  const float outgrown = 0.28F * length / crown.radius;
  const float pull = level == 0 ? 1.0F : std::max(1.0F - outgrown, 0.5F);
  return {shape, crown, form, tree_tint(shape), length, cluster, pull};
}

void write_spray(const Foliage& f, const glm::vec3& tip, std::uint64_t hash, MeshWriter& out) {
  const Fractions a(hash), b(core::mix64(hash));
  const glm::vec3 cube{2.0F * a.f[0] - 1.0F, 2.0F * a.f[1] - 1.0F, 2.0F * a.f[2] - 1.0F};
  const glm::vec3 offset = cube * (1.0F - 0.2F * dot3(cube, cube));  // roughly a ball
  const glm::vec3 place = f.crown.center + f.pull * (tip + f.cluster_m * offset - f.crown.center);
  const glm::vec3 outward = normalised3(f.crown.relative(place) / f.crown.half);
  const glm::vec3 random{2.0F * b.f[0] - 1.0F, 2.0F * b.f[1] - 1.0F, 2.0F * b.f[2] - 1.0F};

  glm::vec3 axis = 0.7F * cube + 0.7F * outward;
  axis.y -= 0.25F;
  axis = normalised3(axis);
  glm::vec3 facing = 0.7F * outward + 0.9F * random;
  facing.y += 0.3F;
  const glm::vec3 side =
      normalised3({facing.y * axis.z - facing.z * axis.y, facing.z * axis.x - facing.x * axis.z,
                   facing.x * axis.y - facing.y * axis.x});
  const glm::vec3 face{axis.y * side.z - axis.z * side.y, axis.z * side.x - axis.x * side.z,
                       axis.x * side.y - axis.y * side.x};

  const float length = f.length_m * (0.75F + 0.5F * b.f[3]);
  const glm::vec3 foot = place - 0.45F * length * axis;
  glm::vec3 shading = outward + 0.3F * axis;
  shading.y += 0.25F;
  const auto normal = pack_normal(normalised3(shading));
  const float ambient = crown_ambient(f.crown, place);
  const float spread = f.shape.colour_variation;
  const Colour colour = leaf_colour(f.tint.hue + 0.16F * spread * (a.f[3] - 0.5F));
  const float brightness = f.tint.brightness * (1.0F + 0.4F * spread * (b.f[3] - 0.5F));

  const MeshWriter::Look inner{pack_unorm8(ambient * 0.8F), 205, normal,
                               packed(colour, brightness * 0.9F), kLeaf};
  const MeshWriter::Look outer{pack_unorm8(ambient), 245, normal,
                               packed(colour, brightness * 1.05F), kLeaf};
  const std::uint32_t first = out.vertex_count();
  for (std::uint32_t k = 0; k < kSprayVertices; ++k)
    out.vertex(
        foot + length * (f.form.along[k] * axis + f.form.across[k] * side - f.form.droop[k] * face),
        k == 0 ? inner : outer);
  for (std::uint32_t k = 0; k < 3 * kSprayTriangles; k += 3)
    out.triangle(first + f.form.indices[k], first + f.form.indices[k + 1],
                 first + f.form.indices[k + 2]);
}

// Where on the tip i, or for small f on the branch that bears it, a spray grows.
glm::vec3 anchor(const TreeSkeleton& s, std::uint32_t i, float f) {
  if (f < 0.3F) return s.point(s.parent[i], 0.4F + 2.0F * f);
  return s.point(i, f);
}

}  // namespace

std::uint32_t spray_count(int level, std::uint32_t tips) {
  if (level == 0) return std::clamp(10U * tips / 3U, 512U, 7168U);
  if (level == 1) return std::clamp(tips, 128U, 1536U);
  return level == 2 ? 64 : kCrownPaths;
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
  return {center, {across, up, across}, (2.0F * across + up) * (1.0F / 3.0F)};
}

float crown_ambient(const TreeCrown& crown, const glm::vec3& p) {
  const glm::vec3 r = crown.relative(p);
  const float out = std::min(std::sqrt(dot3(r, r)), 1.2F) * (1.0F / 1.2F);
  const float height = std::min(std::max(0.5F + 0.5F * r.y, 0.0F), 1.0F);
  return (0.3F + 0.7F * out * out) * (0.6F + 0.4F * height);
}

void mesh_sprays(const TreeShape& shape, int level, const TreeSkeleton& skeleton,
                 const TreeCrown& crown, std::uint32_t sprays, MeshWriter& out) {
  const std::uint32_t tips = skeleton.tip_count();
  const Foliage look = foliage(shape, level, crown, tips, sprays);
  std::uint32_t done = 0;
  for (std::uint32_t k = 0; k < tips; ++k) {
    const std::uint32_t i = skeleton.first_tip() + k;
    const std::uint32_t until = sprays * (k + 1) / tips;
    for (std::uint32_t number = 0; done < until; ++done, ++number) {
      const std::uint64_t hash = core::mix64(skeleton.key[i] + kSpraySalt * (number + 1));
      const float f = static_cast<float>((hash >> 40) & 0xFFFFU) * (1.0F / 65536.0F);
      write_spray(look, anchor(skeleton, i, f), hash, out);
    }
  }
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
  const Tint tint = tree_tint(shape);
  const std::uint32_t first = out.vertex_count();
  const float grow = ball ? 1.05F : 1.3F;
  for (std::uint32_t k = 0; k < (ball ? kBallVertices : kOctahedronVertices); ++k) {
    const float* corner = ball ? kBall[k] : kOctahedron[k];
    const glm::vec3 unit{corner[0], corner[1], corner[2]};
    const Fractions a(core::mix64(shape.root_key + kSpraySalt * (k + 1)));
    const glm::vec3 place = crown.center + crown.half * unit * (grow * (0.85F + 0.3F * a.f[0]));
    const Colour colour = leaf_colour(tint.hue + 0.1F * shape.colour_variation * (a.f[1] - 0.5F));
    out.vertex(place, {pack_unorm8((ball ? 0.78F : 0.7F) * crown_ambient(crown, place)), 200,
                       pack_normal(normalised3(unit + glm::vec3(0.0F, 0.2F, 0.0F))),
                       packed(colour, 0.9F * tint.brightness), kLeaf});
  }
  const std::uint32_t* indices = ball ? kBallIndices : kOctahedronIndices;
  for (std::uint32_t k = 0; k < 3 * (ball ? kBallTriangles : kOctahedronTriangles); k += 3)
    out.triangle(first + indices[k], first + indices[k + 1], first + indices[k + 2]);
}

}  // namespace psygen::models
