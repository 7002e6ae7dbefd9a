#include "engine/render/cloud_texture.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <numeric>
#include <span>

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

// Billows: 1 at points, one in each of cells² cells, falling to 0 between them (Worley 1996), so
// their outlines are round. Repeating.
float billows(std::uint32_t x, std::uint32_t y, std::uint32_t cells, std::uint32_t octave) {
  const float px = static_cast<float>(x * cells) / kSize,
              py = static_cast<float>(y * cells) / kSize;
  const auto i = static_cast<std::uint32_t>(px), j = static_cast<std::uint32_t>(py);
  float nearest = 1;
  for (std::uint32_t v = 0; v < 3; ++v) {
    for (std::uint32_t u = 0; u < 3; ++u) {
      const std::uint32_t a = (i + u + cells - 1) % cells, b = (j + v + cells - 1) % cells;
      const float dx = static_cast<float>(i + u) - 1 + lattice(a, b, octave) - px;
      const float dy = static_cast<float>(j + v) - 1 + lattice(a, b, octave + 1) - py;
      nearest = std::min(nearest, dx * dx + dy * dy);
    }
  }
  return 1 - std::sqrt(nearest);
}

// Fractal noise of so many octaves, from 4 lattice points per side on.
float fractal(std::uint32_t x, std::uint32_t y, std::uint32_t octaves) {
  float sum = 0, amplitude = 0.5F;
  std::uint32_t cells = 4;
  for (std::uint32_t octave = 0; octave < octaves; ++octave, cells *= 2, amplitude *= 0.53F)
    sum += amplitude * noise(x, y, cells, octave);
  return sum;
}

// Replaces each value by that of the same rank in `like`, which keeps how much of the sky a density
// covers.
void match_ranks(std::span<float> values, std::span<const float> like) {
  std::vector<std::uint32_t> order(values.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return values[a] != values[b] ? values[a] < values[b] : a < b;
  });
  std::vector<float> sorted(like.begin(), like.end());
  std::ranges::sort(sorted);
  for (std::size_t i = 0; i < order.size(); ++i)
    values[order[i]] = sorted[i];
}

std::uint16_t to_half(float unit) {
  return glm::packHalf1x16(std::clamp(unit, 0.0F, 1.0F));
}

}  // namespace

std::vector<std::uint16_t> make_cloud_texture() {
  std::vector<float> noises(std::size_t{kSize} * kSize), clouds(noises.size());
  for (std::uint32_t y = 0; y < kSize; ++y) {
    for (std::uint32_t x = 0; x < kSize; ++x) {
      const std::size_t at = std::size_t{y} * kSize + x;
      noises[at] = fractal(x, y, 7);
      clouds[at] = fractal(x, y, 3) + 0.17F * billows(x, y, 11, 16) +
                   0.10F * billows(x, y, 23, 18) + 0.06F * billows(x, y, 47, 20);
    }
  }
  const auto [low, high] = std::ranges::minmax_element(noises);
  const float base = *low, span = *high - *low;
  for (float& noise_ : noises)
    noise_ = (noise_ - base) / span;
  match_ranks(clouds, noises);
  std::vector<std::uint16_t> texels(noises.size() * 2);
  for (std::size_t i = 0; i < noises.size(); ++i) {
    texels[2 * i] = to_half(clouds[i]);
    texels[2 * i + 1] = to_half(noises[i]);
  }
  return texels;
}

}  // namespace psygen::render
