#include "engine/world/ground_blends.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>

#include "engine/core/hash.hpp"

namespace psygen::world {
namespace {

// Smallest width of a blend; narrower blends are practically steps.
constexpr float kMinSpan = 1e-3F;

float lattice(std::uint32_t x, std::uint32_t z) {
  std::uint32_t h = ((x & 63u) * 0x9E3779B9u) ^ ((z & 63u) * 0x85EBCA6Bu);
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  return static_cast<float>(h >> 8) * (1.0F / 16777216.0F);
}

// Smooth noise in [0, 1] with one lattice point per unit and a period of 64. Requires p >= 0.
float slow_noise(glm::vec2 p) {
  const glm::vec2 cell = glm::floor(p);
  glm::vec2 f = p - cell;
  f = f * f * (3.0F - 2.0F * f);
  const auto x = static_cast<std::uint32_t>(cell.x), z = static_cast<std::uint32_t>(cell.y);
  const float a = glm::mix(lattice(x, z), lattice(x + 1, z), f.x);
  const float b = glm::mix(lattice(x, z + 1), lattice(x + 1, z + 1), f.x);
  return glm::mix(a, b, f.y);
}

float blend(double start, double width, float value) {
  const float w = std::max(static_cast<float>(width), kMinSpan);
  return (value - static_cast<float>(start)) / w;
}

}  // namespace

glm::vec2 pattern_place(core::BlockCoord block, double block_size_m, glm::vec2 local_m) {
  const auto place = [block_size_m](std::int32_t index, float local) {
    const double metres =
        std::fmod(static_cast<double>(index) * block_size_m, kGroundPatternPeriodM);
    const double inside = std::fmod(metres + static_cast<double>(local), kGroundPatternPeriodM);
    return static_cast<float>(inside < 0 ? inside + kGroundPatternPeriodM : inside);
  };
  return {place(block.x, local_m.x), place(block.z, local_m.y)};
}

GroundBlends ground_blends(const Palette& palette, float height_m, const glm::vec3& normal,
                           glm::vec2 pattern_place_m, float road) {
  const float pattern = 0.65F * slow_noise(pattern_place_m * (1.0F / 32.0F)) +
                        0.35F * slow_noise(pattern_place_m * (1.0F / 8.0F));
  const float slope = 1.0F - normal.y;
  const float uneven = (pattern - 0.5F) * 2.0F;
  const auto smooth = [](float t) { return glm::smoothstep(0.0F, 1.0F, t); };
  const auto rock_start = static_cast<float>(palette.rock_slope_start);
  const float rock_full =
      std::max(static_cast<float>(palette.rock_slope_full), rock_start + kMinSpan);
  const float snow = smooth(blend(palette.snow_start_m, palette.snow_blend_m, height_m) + uneven);
  const float steep = std::max(static_cast<float>(palette.snow_slope_max), kMinSpan);
  GroundBlends blends{
      1.0F,
      glm::smoothstep(0.35F, 0.62F, pattern + slope * 0.5F),
      smooth(blend(palette.dry_start_m, palette.dry_blend_m, height_m) + uneven),
      smooth(0.5F * uneven - blend(palette.sand_end_m, palette.sand_blend_m, height_m)),
      glm::smoothstep(rock_start, rock_full, slope + 0.06F * uneven),
      snow * (1.0F - glm::smoothstep(0.7F * steep, steep, slope))};
  if (road <= 0.0F) return blends;
  blends[2] = glm::mix(blends[2], 1.0F, road);
  blends[3] = glm::mix(blends[3], 0.0F, road);
  blends[4] = glm::mix(blends[4], 0.6F, road);
  blends[5] = glm::mix(blends[5], 0.3F * blends[5], road);
  return blends;
}

std::uint64_t placing_hash(const World& world) {
  if (std::ranges::none_of(world.scatter, [](const Scatter& s) { return s.mask.ground != 0; }))
    return 0;
  const Palette p = drawn_palette(world);
  std::uint64_t hash = 1;
  for (const double v : {p.sand_end_m, p.sand_blend_m, p.dry_start_m, p.dry_blend_m, p.snow_start_m,
                         p.snow_blend_m, p.rock_slope_start, p.rock_slope_full, p.snow_slope_max})
    hash = core::combine(hash, std::bit_cast<std::uint64_t>(v + 0.0));
  return std::max<std::uint64_t>(hash, 1);
}

GroundKind main_kind(const GroundBlends& blends) {
  float left = 1.0F, largest = 0.0F;
  std::size_t kind = 0;
  for (std::size_t i = kGroundKinds; i-- > 0;) {
    const float share = blends[i] * left;
    if (share >= largest) {
      largest = share;
      kind = i;
    }
    left *= 1.0F - blends[i];
  }
  return static_cast<GroundKind>(kind);
}

}  // namespace psygen::world
