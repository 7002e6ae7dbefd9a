#include "engine/render/cloud_texture.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "engine/core/hash.hpp"

namespace psygen::render {

namespace {

constexpr std::uint32_t kSize = kCloudTextureSize;

float lattice(std::uint32_t x, std::uint32_t y, std::uint32_t octave) {
  const std::uint64_t bits =
      core::mix64((std::uint64_t{octave} << 48) | (std::uint64_t{y} << 24) | x);
  return static_cast<float>(bits >> 40) * 0x1.0p-24F;
}

// Repeating value noise with `cells` lattice points per side. x and y are in texels.
float noise(std::uint32_t x, std::uint32_t y, std::uint32_t cells, std::uint32_t octave) {
  const std::uint32_t step = kSize / cells;
  const std::uint32_t i = x / step, j = y / step;
  const auto fade = [&](std::uint32_t t) {
    const float f = static_cast<float>(t % step) / static_cast<float>(step);
    return f * f * (3 - 2 * f);
  };
  const float fx = fade(x), fy = fade(y);
  const std::uint32_t i1 = (i + 1) % cells, j1 = (j + 1) % cells;
  const float top = std::lerp(lattice(i, j, octave), lattice(i1, j, octave), fx);
  const float bottom = std::lerp(lattice(i, j1, octave), lattice(i1, j1, octave), fx);
  return std::lerp(top, bottom, fy);
}

std::uint16_t to_half(float unit) {
  return glm::packHalf1x16(std::clamp(unit, 0.0F, 1.0F));
}

}  // namespace

std::vector<std::uint16_t> make_cloud_texture() {
  std::vector<float> density(std::size_t{kSize} * kSize);
  for (std::uint32_t y = 0; y < kSize; ++y) {
    for (std::uint32_t x = 0; x < kSize; ++x) {
      float sum = 0, amplitude = 0.5F;
      std::uint32_t cells = 4;
      for (std::uint32_t octave = 0; octave < 7; ++octave, cells *= 2, amplitude *= 0.53F)
        sum += amplitude * noise(x, y, cells, octave);
      density[y * kSize + x] = sum;
    }
  }
  const auto [low, high] = std::minmax_element(density.begin(), density.end());
  const float base = *low, span = *high - *low;
  std::vector<std::uint16_t> texels(density.size() * 2);
  for (std::uint32_t y = 0; y < kSize; ++y) {
    for (std::uint32_t x = 0; x < kSize; ++x) {
      const float here = density[y * kSize + x];
      const float aside = density[(y + 5) % kSize * kSize + (x + 5) % kSize];
      texels[(y * kSize + x) * 2] = to_half((here - base) / span);
      texels[(y * kSize + x) * 2 + 1] = to_half(0.5F + 2.0F * (here - aside) / span);
    }
  }
  return texels;
}

}  // namespace psygen::render
