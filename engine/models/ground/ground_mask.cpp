#include "engine/models/ground/ground_mask.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "engine/core/hash.hpp"

namespace psygen::models {
namespace {

constexpr double kMinPatchM = 0.1;
// Patches fade out over this range of their noise, whose steepest slope is below kNoiseSlope.
constexpr double kPatchFade = 0.15, kNoiseSlope = 3.7;
constexpr double kFadeSlope = 1.5;  // the steepest slope of faded()

// A random number in [0, 1) for each point of a lattice.
double lattice_value(std::uint64_t seed, std::int64_t x, std::int64_t z) {
  const std::uint64_t hash = core::combine(core::combine(seed, static_cast<std::uint64_t>(x)),
                                           static_cast<std::uint64_t>(z));
  return static_cast<double>(hash >> 11) * 0x1.0p-53;
}

double smooth_noise(std::uint64_t seed, glm::dvec2 p) {
  const double x = std::floor(p.x), z = std::floor(p.y);
  const auto curve = [](double t) { return t * t * t * (t * (6 * t - 15) + 10); };
  const double u = curve(p.x - x), v = curve(p.y - z);
  const auto i = static_cast<std::int64_t>(x), k = static_cast<std::int64_t>(z);
  const double near = lattice_value(seed, i, k) * (1 - u) + lattice_value(seed, i + 1, k) * u;
  const double far =
      lattice_value(seed, i, k + 1) * (1 - u) + lattice_value(seed, i + 1, k + 1) * u;
  return near * (1 - v) + far * v;
}

}  // namespace

double GreyPicture::at(double u, double v) const {
  const auto place = [](double t, std::uint32_t size) {
    return std::clamp(t * size - 0.5, 0.0, static_cast<double>(size - 1));
  };
  const double x = place(u, width), y = place(v, height);
  const auto left = static_cast<std::size_t>(x), top = static_cast<std::size_t>(y);
  const std::size_t right = std::min<std::size_t>(left + 1, width - 1);
  const std::size_t below = std::min<std::size_t>(top + 1, height - 1);
  const double s = x - static_cast<double>(left), t = y - static_cast<double>(top);
  const auto value = [&](std::size_t column, std::size_t row) {
    return static_cast<double>(pixels[row * width + column]) / 65535;
  };
  return (value(left, top) * (1 - s) + value(right, top) * s) * (1 - t) +
         (value(left, below) * (1 - s) + value(right, below) * s) * t;
}

double GreyPicture::over(const std::array<double, 4>& area_m, glm::dvec2 place_m) const {
  const auto& [left, top, right, bottom] = area_m;
  const double u = (place_m.x - left) / (right - left), v = (place_m.y - top) / (bottom - top);
  return u >= 0 && u <= 1 && v >= 0 && v <= 1 ? at(u, v) : 0;
}

std::uint64_t content_hash(const GreyPicture& picture) {
  std::uint64_t hash = core::mix64(picture.width);
  for (std::uint32_t row = 0; row < picture.height; ++row)
    hash += row_hash(picture, row);
  return hash;
}

std::uint64_t row_hash(const GreyPicture& picture, std::uint32_t row) {
  const std::span<const std::uint16_t> pixels(picture.pixels);
  return core::hash_bytes(
      std::as_bytes(pixels.subspan(std::size_t{row} * picture.width, picture.width)), row);
}

double patch_noise(std::uint64_t seed, glm::dvec2 place_m, double patch_m) {
  const glm::dvec2 place = place_m / std::max(patch_m, kMinPatchM);
  return (smooth_noise(seed, place) + 0.4 * smooth_noise(seed + 1, 2.3 * place)) / 1.4;
}

// Measured once at 2^14 positions.
double patch_noise_below(double share) {
  static const std::vector<double> sorted = [] {
    constexpr int kSide = 128;
    std::vector<double> values;
    values.reserve(std::size_t{kSide} * kSide);
    for (int z = 0; z < kSide; ++z) {
      for (int x = 0; x < kSide; ++x)
        values.push_back(patch_noise(0, {0.37 * x, 0.37 * z}, 1));
    }
    std::ranges::sort(values);
    return values;
  }();
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(sorted.size());
  const auto index = static_cast<std::size_t>(at);
  return index < sorted.size() ? sorted[index] : 2.0;
}

double GroundMask::at(glm::dvec2 place_m, glm::dvec2 own) const {
  double kept = 1;
  if (noise_m > 0) {
    const double noise = patch_noise(patches, place_m, noise_m);
    kept = share > 0 ? faded(patch_noise_below(share) + kPatchFade / 2 - noise, kPatchFade) : 0;
  }
  if (!picture || kept == 0) return kept;
  if (area_m == std::array<double, 4>{}) return kept * picture->at(own.x, own.y);
  return kept * picture->over(area_m, place_m);
}

std::uint64_t GroundMask::hash() const {
  std::uint64_t hash = core::combine(0x3A5C, picture ? picture->hash : 0);
  const auto add = [&hash](double v) {
    hash = core::combine(hash, std::bit_cast<std::uint64_t>(v + 0.0));
  };
  for (const double v : area_m)
    add(v);
  add(noise_m);
  add(share);
  hash = core::combine(hash, patches);
  for (const FadedRange& range : {height_m, slope}) {
    for (const double v : {range.min, range.min_fade, range.max, range.max_fade})
      add(v);
  }
  return hash;
}

// The guide may be arbitrarily steep, and a picture with an area ends at its border.
double GroundMask::steepness(double side_m) const {
  if (reads_guide() || (picture && area_m != std::array<double, 4>{})) return 1e30;
  const double patches_slope =
      kFadeSlope / kPatchFade * kNoiseSlope / std::max(noise_m, kMinPatchM);
  const double pixels = picture ? 1.5 * std::max(picture->width, picture->height) : 0;
  return (noise_m > 0 ? patches_slope : 0) + pixels / side_m;
}

}  // namespace psygen::models
