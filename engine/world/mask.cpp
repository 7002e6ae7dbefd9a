#include "engine/world/mask.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>
#include <utility>

#include "engine/core/hash.hpp"

namespace psygen::world {

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
         a.noise_m == b.noise_m && a.share == b.share && a.fade == b.fade &&
         a.patches == b.patches && a.ground == b.ground;
}

std::uint64_t patch_seed(const ScatterMask& mask, std::uint64_t world_seed) {
  return core::combine(core::mix64(world_seed), static_cast<std::uint64_t>(mask.patches));
}

double mask_share(const ScatterMask& mask, std::uint64_t seed, glm::dvec2 place_m) {
  double share = 1;
  if (mask.noise_m > 0) {
    const double noise = models::patch_noise(patch_seed(mask, seed), place_m, mask.noise_m);
    // Fades over as much ground inside the sharp border as outside of it.
    const double width = mask.fade * std::min(mask.share, 1 - mask.share);
    const double full = models::patch_noise_below(mask.share - width);
    constexpr double kNearlyAll = 0.9999;  // the noise has no value at which all of it is below
    const double none =
        width > 0 ? models::patch_noise_below(std::min(mask.share + width, kNearlyAll)) : full;
    if (noise >= none) return 0;
    if (noise > full) share = (none - noise) / (none - full);
  }
  return mask.picture ? share * mask.picture->over(mask.area_m, place_m) : share;
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
    if (mask.fade > 0) add(mask.fade);
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
