#include "engine/render/meshes/contact_shadow_map.hpp"

#include <algorithm>
#include <cmath>

namespace psygen::render {

namespace {

constexpr int kShadeSide = PSYGEN_SHADE_SIDE;  // cells of 1 m

// Most of the sun and of the sky that all spots together take, of 255: ground is never black.
constexpr std::uint32_t kMaxSun = 210, kMaxSky = 170;

// The missing light, of 255, after a share of the rest is missing too.
std::uint32_t with_more(std::uint32_t missing, float share, std::uint32_t most) {
  const auto left = static_cast<float>(255 - missing);
  return std::min(255 - static_cast<std::uint32_t>(left * (1 - share) + 0.5F), most);
}

}  // namespace

void ContactShadowMap::build(std::span<const GroundSpot> spots, glm::dvec2 camera) {
  std::fill(words_.begin(), words_.end(), 0U);
  constexpr double kHalf = kShadeSide / 2;
  corner_ = {static_cast<float>(std::floor(camera.x) - camera.x - kHalf),
             static_cast<float>(std::floor(camera.y) - camera.y - kHalf)};
  for (const GroundSpot& spot : spots)
    add(spot);
}

void ContactShadowMap::add(const GroundSpot& spot) {
  const glm::vec2 middle = spot.middle - corner_ - 0.5F;  // in cells, from the middle of the first
  if (!(spot.radius_m > 0) || !(std::abs(middle.x) + std::abs(middle.y) < 4.0F * kShadeSide))
    return;
  const auto first = [&](float at) {
    return std::max(static_cast<int>(std::ceil(at - spot.radius_m)), 0);
  };
  const auto last = [&](float at) {
    return std::min(static_cast<int>(std::floor(at + spot.radius_m)), kShadeSide - 1);
  };
  const float scale = 1 / (spot.radius_m * spot.radius_m);
  for (int z = first(middle.y); z <= last(middle.y); ++z) {
    for (int x = first(middle.x); x <= last(middle.x); ++x) {
      const float dx = static_cast<float>(x) - middle.x, dz = static_cast<float>(z) - middle.y;
      const float inside = std::max(1 - (dx * dx + dz * dz) * scale, 0.0F);
      const float soft = inside * (2 - inside);
      std::uint32_t& word = words_[static_cast<std::size_t>(z * kShadeSide + x) / 2];
      const unsigned shift = (x & 1) * 16;
      const std::uint32_t sun = with_more(word >> shift & 0xFF, soft * spot.sun, kMaxSun);
      const std::uint32_t sky = with_more(word >> (shift + 8) & 0xFF, soft * spot.sky, kMaxSky);
      word = (word & ~(0xFFFFU << shift)) | (sun | sky << 8) << shift;
    }
  }
}

}  // namespace psygen::render
