#include "engine/world/mask.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <utility>

#include "engine/core/hash.hpp"

namespace psygen::world {
namespace {

// Smaller patches are enlarged to this size, so that lattice points of the largest world fit in 64
// bits.
constexpr double kMinPatchM = 0.1;

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

// Patches with frayed borders.
double patch_noise(std::uint64_t seed, glm::dvec2 p) {
  return (smooth_noise(seed, p) + 0.4 * smooth_noise(seed + 1, 2.3 * p)) / 1.4;
}

// The noise value that this fraction of the ground stays below, measured once at 2^14 positions.
double noise_below(double share) {
  static const std::vector<double> sorted = [] {
    std::vector<double> values;
    for (int i = 0; i < 1 << 14; ++i)
      values.push_back(patch_noise(0, {0.37 * (i % 128), 0.37 * (i / 128)}));
    std::ranges::sort(values);
    return values;
  }();
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(sorted.size());
  const auto index = static_cast<std::size_t>(at);
  return index < sorted.size() ? sorted[index] : 2.0;
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

HeightPicture finished(HeightPicture picture) {
  const auto is_whole = [](float v) {
    return v >= 0 && v <= 65'535 && v == std::floor(v) && !std::signbit(v);
  };
  if (std::ranges::all_of(picture.values, is_whole)) {
    picture.wholes.reserve(picture.wholes.size() + picture.values.size());
    for (const float v : std::exchange(picture.values, {}))
      picture.wholes.push_back(static_cast<std::uint16_t>(v));
  }
  std::uint64_t hash = core::combine(picture.width, picture.is_coloured ? 1 : 0);
  hash = core::combine(hash, std::bit_cast<std::uint64_t>(picture.white));
  hash = core::combine(hash, picture.height);
  hash = core::hash_bytes(std::as_bytes(std::span(picture.wholes)), hash);
  picture.hash = core::hash_bytes(std::as_bytes(std::span(picture.values)), hash);
  return picture;
}

HeightPicture heights_of(const GreyPicture& picture) {
  return finished({.width = picture.width,
                   .height = picture.height,
                   .values = {},
                   .wholes = picture.pixels,
                   .white = 65535});
}

bool operator==(const ScatterMask& a, const ScatterMask& b) {
  const auto content = [](const ScatterMask& m) { return m.picture ? m.picture->hash : 0; };
  return a.image == b.image && content(a) == content(b) && a.area_m == b.area_m &&
         a.noise_m == b.noise_m && a.share == b.share && a.patches == b.patches &&
         a.ground == b.ground;
}

double mask_share(const ScatterMask& mask, std::uint64_t seed, glm::dvec2 place_m) {
  if (mask.noise_m > 0) {
    const std::uint64_t patches =
        core::combine(core::mix64(seed), static_cast<std::uint64_t>(mask.patches));
    const double patch_m = std::max(mask.noise_m, kMinPatchM);
    if (!(patch_noise(patches, place_m / patch_m) < noise_below(mask.share))) return 0;
  }
  if (!mask.picture) return 1;
  const auto& [left, top, right, bottom] = mask.area_m;
  const double u = (place_m.x - left) / (right - left), v = (place_m.y - top) / (bottom - top);
  const bool inside = u >= 0 && u <= 1 && v >= 0 && v <= 1;
  return inside ? mask.picture->at(u, v) : 0;
}

std::uint64_t mask_hash(const ScatterMask& mask) {
  if (!mask.thins() && mask.ground == 0) return 0;
  std::uint64_t hash = core::mix64(mask.ground + 1);
  const auto add = [&hash](double v) {
    hash = core::combine(hash, std::bit_cast<std::uint64_t>(v + 0.0));
  };
  if (mask.noise_m > 0) {
    add(mask.noise_m);
    add(mask.share);
    hash = core::combine(hash, static_cast<std::uint64_t>(mask.patches));
  }
  if (mask.picture) {
    hash = core::combine(hash, mask.picture->hash);
    for (const double v : mask.area_m)
      add(v);
  }
  return std::max<std::uint64_t>(hash, 1);
}

}  // namespace psygen::world
