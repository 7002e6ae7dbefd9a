// Sprays: the foliage of levels 0 … 3, six vertices and four triangles each, in clusters about the
// tips. A coarser level has fewer and larger ones on the same skeleton, drawn towards the crown's
// centre by what they are larger, so that the outline stays. Normals follow the crown rather than
// the leaf, which shades it as one soft volume. Worked out in batches, one spray per lane.
#include <bit>

#include "engine/models/tree_mesh.hpp"

// Compiled twice, chosen when the program starts: with AVX2 where the processor has it. The same
// operations in the same order, so the same bits. (Sanitizers start after the choice is made.)
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PSYGEN_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define PSYGEN_WIDE
#endif

namespace psygen::models {
namespace {

static_assert(std::endian::native == std::endian::little, "vertices are assembled from words");

constexpr std::size_t kLanes = 32;
constexpr std::uint64_t kSpraySalt = 0x8EBC6AF09C88C6E3ull;
constexpr std::uint32_t kInnerSway = 205, kOuterSway = 245, kLeaf = 1;

// Corners of a spray: along its axis, across, and against its normal, in spray lengths.
struct SprayForm {
  float along[kSprayVertices], across[kSprayVertices], droop[kSprayVertices];
  std::uint8_t indices[3 * kSprayTriangles];
};
// Three leaflets near by; a rounded patch further out.
constexpr SprayForm kLeaflets{{0.0F, 0.52F, 0.40F, 1.0F, 0.40F, 0.52F},
                              {0.0F, -0.60F, -0.20F, 0.0F, 0.20F, 0.60F},
                              {0.0F, 0.14F, 0.0F, 0.18F, 0.0F, 0.14F},
                              {0, 1, 2, 0, 2, 4, 2, 3, 4, 0, 4, 5}};
constexpr SprayForm kPatch{{0.0F, 0.22F, 0.74F, 1.0F, 0.66F, 0.30F},
                           {0.0F, -0.46F, -0.40F, 0.06F, 0.44F, 0.40F},
                           {0.12F, 0.06F, 0.0F, 0.16F, 0.0F, 0.06F},
                           {0, 1, 5, 1, 2, 5, 2, 4, 5, 2, 3, 4}};
// Length of a spray such that `count` of them fill a crown of radius 1, times √count.
constexpr float kFillingLength[4] = {6.7F, 7.1F, 4.4F, 4.4F};

// What all sprays of one mesh have in common.
struct Foliage {
  const SprayForm& form;
  float center[3], inverse_half[3];  // of the crown
  float colour[3], colour_slope[3];  // stored colour at the tree's hue; change per unit of hue
  float hue_spread, brightness, brightness_spread;
  float length_m;   // of a spray
  float cluster_m;  // radius of a tip's cluster
  float pull;       // cluster positions relative to the crown's centre are times this
  float box_center[3], box_scale[3];
};

Foliage foliage(const TreeShape& shape, int level, const TreeCrown& crown, std::uint32_t tips,
                std::uint32_t sprays, const MeshWriter& out) {
  const float root = std::sqrt(static_cast<float>(sprays));
  const float filling = kFillingLength[level] * crown.radius * shape.leaf_scale / root;
  const float length = std::min(filling, 2.0F * shape.size_m);
  const float cluster = crown.radius * std::min(2.1F / std::sqrt(static_cast<float>(tips)), 0.6F);
  const float pull = level == 0 ? 1.0F : std::max(1.0F - 0.28F * length / crown.radius, 0.5F);
  const LeafTint tint = leaf_tint(shape);
  Foliage f{level <= 1 ? kLeaflets : kPatch,
            {},
            {},
            {},
            {},
            0.16F * shape.colour_variation,
            tint.brightness,
            0.4F * shape.colour_variation,
            length,
            cluster,
            pull,
            {},
            {}};
  const std::array<float, 3> below = leaf_colour(tint.hue - 0.05F);
  const std::array<float, 3> above = leaf_colour(tint.hue + 0.05F);
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    f.center[k] = crown.center[k];
    f.inverse_half[k] = 1.0F / crown.half[k];
    f.colour[k] = 0.5F * (below[i] + above[i]);
    f.colour_slope[k] = 10.0F * (above[i] - below[i]);
    f.box_center[k] = out.box_center()[k];
    f.box_scale[k] = out.box_scale()[k];
  }
  return f;
}

using Row = float[kLanes];
using Words = std::uint32_t[kLanes];

// One batch. The random fractions are still integers of 16 bits when they come in.
struct Batch {
  alignas(64) Row tip[3];
  std::int32_t a[4][kLanes], b[4][kLanes];
  Row foot[3], axis[3], side[3], face[3];  // in packed units relative to the box
  Words normal, inner_colour, outer_colour, inner_light, outer_light;
  Words xy[kSprayVertices], z_light[kSprayVertices];
  Row low[3], high[3];  // over all batches
};

inline float reciprocal_length(float x, float y, float z) {
  return 1.0F / std::sqrt(x * x + y * y + z * z + 1e-20F);
}
inline std::uint32_t unorm8_word(float x) {
  return static_cast<std::uint32_t>(
      static_cast<std::int32_t>(std::min(std::max(x, 0.0F), 1.0F) * 255.0F + 0.5F));
}
inline std::uint32_t snorm16_word(float x) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(x * 32767.0F + 32768.5F) - 32768) &
         0xFFFFU;
}
inline std::uint32_t octahedral_word(float x, float y, float z) {
  const float scale = 1.0F / (std::abs(x) + std::abs(y) + std::abs(z));
  x *= scale;
  z *= scale;
  const float fold_x = std::copysign(1.0F - std::abs(z), x);
  const float fold_z = std::copysign(1.0F - std::abs(x), z);
  return snorm16_word(y < 0.0F ? fold_x : x) | (snorm16_word(y < 0.0F ? fold_z : z) << 16);
}

// Place, orientation, light and colour of every spray.
PSYGEN_WIDE void orient(const Foliage& f, Batch& s) {
  for (std::size_t i = 0; i < kLanes; ++i) {
    constexpr float kUnit = 1.0F / 65536.0F, kTwice = 2.0F / 65536.0F;
    const float cx = static_cast<float>(s.a[0][i]) * kTwice - 1.0F;
    const float cy = static_cast<float>(s.a[1][i]) * kTwice - 1.0F;
    const float cz = static_cast<float>(s.a[2][i]) * kTwice - 1.0F;
    const float ball = f.cluster_m * (1.0F - 0.2F * (cx * cx + cy * cy + cz * cz));
    const float px = f.pull * (s.tip[0][i] + ball * cx - f.center[0]);  // from the crown's centre
    const float py = f.pull * (s.tip[1][i] + ball * cy - f.center[1]);
    const float pz = f.pull * (s.tip[2][i] + ball * cz - f.center[2]);
    const float rx = px * f.inverse_half[0], ry = py * f.inverse_half[1],
                rz = pz * f.inverse_half[2];

    float ox = rx * f.inverse_half[0], oy = ry * f.inverse_half[1], oz = rz * f.inverse_half[2];
    const float outward = reciprocal_length(ox, oy, oz);
    ox *= outward;
    oy *= outward;
    oz *= outward;
    float ax = 0.7F * (cx + ox), ay = 0.7F * (cy + oy) - 0.25F, az = 0.7F * (cz + oz);
    const float along = reciprocal_length(ax, ay, az);
    ax *= along;
    ay *= along;
    az *= along;
    const float dx = 0.7F * ox + 0.9F * (static_cast<float>(s.b[0][i]) * kTwice - 1.0F);
    const float dy = 0.7F * oy + 0.9F * (static_cast<float>(s.b[1][i]) * kTwice - 1.0F) + 0.3F;
    const float dz = 0.7F * oz + 0.9F * (static_cast<float>(s.b[2][i]) * kTwice - 1.0F);
    float sx = dy * az - dz * ay, sy = dz * ax - dx * az, sz = dx * ay - dy * ax;
    const float across = reciprocal_length(sx, sy, sz);
    sx *= across;
    sy *= across;
    sz *= across;

    const float size = static_cast<float>(s.b[3][i]) * kUnit;
    const float length = f.length_m * (0.75F + 0.5F * size);
    const float kx = length * f.box_scale[0], ky = length * f.box_scale[1],
                kz = length * f.box_scale[2];
    s.foot[0][i] = (px + f.center[0] - f.box_center[0]) * f.box_scale[0] - 0.45F * kx * ax;
    s.foot[1][i] = (py + f.center[1] - f.box_center[1]) * f.box_scale[1] - 0.45F * ky * ay;
    s.foot[2][i] = (pz + f.center[2] - f.box_center[2]) * f.box_scale[2] - 0.45F * kz * az;
    s.axis[0][i] = kx * ax;
    s.axis[1][i] = ky * ay;
    s.axis[2][i] = kz * az;
    s.side[0][i] = kx * sx;
    s.side[1][i] = ky * sy;
    s.side[2][i] = kz * sz;
    s.face[0][i] = kx * (ay * sz - az * sy);
    s.face[1][i] = ky * (az * sx - ax * sz);
    s.face[2][i] = kz * (ax * sy - ay * sx);

    s.normal[i] = octahedral_word(ox + 0.3F * ax, oy + 0.3F * ay + 0.25F, oz + 0.3F * az);
    const float ambient = ambient_of(rx, ry, rz);
    s.inner_light[i] = (unorm8_word(0.8F * ambient) << 16) | (kInnerSway << 24);
    s.outer_light[i] = (unorm8_word(ambient) << 16) | (kOuterSway << 24);
    const float hue = f.hue_spread * (static_cast<float>(s.a[3][i]) * kUnit - 0.5F);
    const float bright = f.brightness * (1.0F + f.brightness_spread * (size - 0.5F));
    const float red = bright * (f.colour[0] + hue * f.colour_slope[0]);
    const float green = bright * (f.colour[1] + hue * f.colour_slope[1]);
    const float blue = bright * (f.colour[2] + hue * f.colour_slope[2]);
    s.inner_colour[i] = unorm8_word(0.9F * red) | (unorm8_word(0.9F * green) << 8) |
                        (unorm8_word(0.9F * blue) << 16) | (kLeaf << 24);
    s.outer_colour[i] = unorm8_word(1.05F * red) | (unorm8_word(1.05F * green) << 8) |
                        (unorm8_word(1.05F * blue) << 16) | (kLeaf << 24);
  }
}

// The packed position of one corner of every spray.
PSYGEN_WIDE void place_corner(const SprayForm& form, std::size_t k, Batch& s) {
  const float x = form.along[k], y = form.across[k], z = form.droop[k];
  const Words& light = k == 0 ? s.inner_light : s.outer_light;
  for (std::size_t i = 0; i < kLanes; ++i) {
    std::uint32_t packed[3];
    for (int c = 0; c < 3; ++c) {
      const float p = s.foot[c][i] + (x * s.axis[c][i] + y * s.side[c][i] - z * s.face[c][i]);
      const float clamped = std::min(std::max(p, -32767.0F), 32767.0F);
      s.low[c][i] = std::min(s.low[c][i], clamped);
      s.high[c][i] = std::max(s.high[c][i], clamped);
      packed[c] =
          static_cast<std::uint32_t>(static_cast<std::int32_t>(clamped + 32768.5F) - 32768) &
          0xFFFFU;
    }
    s.xy[k][i] = packed[0] | (packed[1] << 16);
    s.z_light[k][i] = packed[2] | light[i];
  }
}

void write_batch(const SprayForm& form, const Batch& s, std::size_t count, MeshWriter& out) {
  const std::uint32_t first = out.vertex_count();
  std::byte* vertices = out.append_vertices(static_cast<std::uint32_t>(count) * kSprayVertices);
  std::uint16_t* indices =
      out.append_indices(static_cast<std::uint32_t>(count) * 3 * kSprayTriangles);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < kSprayVertices; ++k) {
      const std::uint32_t words[4] = {s.xy[k][i], s.z_light[k][i], s.normal[i],
                                      k == 0 ? s.inner_colour[i] : s.outer_colour[i]};
      std::memcpy(vertices, words, sizeof words);
      vertices += sizeof words;
    }
    const auto base = static_cast<std::uint32_t>(first + i * kSprayVertices);
    for (const std::uint8_t index : form.indices)
      *indices++ = static_cast<std::uint16_t>(base + index);
  }
}

void flush(const Foliage& f, Batch& s, std::size_t count, MeshWriter& out) {
  for (std::size_t i = count; i < kLanes; ++i) {  // idle lanes repeat the first
    for (int c = 0; c < 3; ++c)
      s.tip[c][i] = s.tip[c][0];
    for (int c = 0; c < 4; ++c) {
      s.a[c][i] = s.a[c][0];
      s.b[c][i] = s.b[c][0];
    }
  }
  orient(f, s);
  for (std::size_t k = 0; k < kSprayVertices; ++k)
    place_corner(f.form, k, s);
  write_batch(f.form, s, count, out);
}

// Where on the tip i, or for small f on the branch that bears it, a spray grows.
glm::vec3 anchor(const TreeSkeleton& s, std::uint32_t i, float f) {
  return f < 0.3F ? s.point(s.parent[i], 0.4F + 2.0F * f) : s.point(i, f);
}

void enter(Batch& s, std::size_t lane, const TreeSkeleton& skeleton, std::uint32_t tip,
           std::uint32_t number) {
  const std::uint64_t a = core::mix64(skeleton.key[tip] + kSpraySalt * (number + 1));
  const std::uint64_t b = core::mix64(a);
  const auto at = static_cast<float>(static_cast<std::int32_t>((a >> 40) & 0xFFFFU));
  const glm::vec3 p = anchor(skeleton, tip, at * (1.0F / 65536.0F));
  for (int c = 0; c < 3; ++c)
    s.tip[c][lane] = p[c];
  for (int c = 0; c < 4; ++c) {
    s.a[c][lane] = static_cast<std::int32_t>((a >> (16 * c)) & 0xFFFFU);
    s.b[c][lane] = static_cast<std::int32_t>((b >> (16 * c)) & 0xFFFFU);
  }
}

}  // namespace

std::uint32_t spray_count(int level, std::uint32_t tips) {
  if (level == 0) return std::clamp(16U * tips / 5U, 512U, 7168U);
  if (level == 1) return std::clamp(tips, 128U, 1536U);
  return level == 2 ? 64 : kCrownPaths;
}

void mesh_sprays(const TreeShape& shape, int level, const TreeSkeleton& skeleton,
                 const TreeCrown& crown, std::uint32_t sprays, MeshWriter& out) {
  const std::uint32_t tips = skeleton.tip_count();
  const Foliage look = foliage(shape, level, crown, tips, sprays, out);
  Batch batch;
  std::fill_n(&batch.low[0][0], 3 * kLanes, 32767.0F);
  std::fill_n(&batch.high[0][0], 3 * kLanes, -32767.0F);
  std::size_t lanes = 0;
  std::uint32_t done = 0;
  for (std::uint32_t k = 0; k < tips; ++k) {
    const std::uint32_t until = sprays * (k + 1) / tips;
    for (std::uint32_t number = 0; done < until; ++done, ++number) {
      enter(batch, lanes++, skeleton, skeleton.first_tip() + k, number);
      if (lanes < kLanes) continue;
      flush(look, batch, lanes, out);
      lanes = 0;
    }
  }
  if (lanes > 0) flush(look, batch, lanes, out);
  for (int c = 0; c < 3; ++c)
    out.include(c, *std::min_element(batch.low[c], batch.low[c] + kLanes),
                *std::max_element(batch.high[c], batch.high[c] + kLanes));
}

}  // namespace psygen::models
