#include "engine/models/network/patch.hpp"

#include <algorithm>

#include "engine/models/network/channel_curves.hpp"

namespace psygen::models::network {
namespace {

constexpr double kReach = 1.08;      // of a kernel, in longest edges of its node
constexpr float kStreamGain = 1.5F;  // of a channel's kernel

// Adds the kernels and the lakes of nodes to a patch.
class Spots {
 public:
  Spots(const Scale& scale, const NodePatch& nodes, Patch& patch)
      : scale_(scale), n_(nodes), patch_(patch), channel_(channel_area(scale, nodes.level)) {}

  void run() {
    name_lakes();
    for (std::int64_t j = n_.rect.j0 + 1; j < n_.rect.j1 - 1; ++j) {
      for (std::int64_t i = n_.rect.i0 + 1; i < n_.rect.i1 - 1; ++i)
        add_spot(i, j);
    }
  }

 private:
  static bool in_lake(const Node& n) { return n.kind == Kind::kLake; }
  Lake lake_of(const Node& n) const { return {water_m(scale_, n), n.lake}; }

  void name_lakes() {
    std::vector<Lake>& lakes = patch_.lakes;
    for (const Node& n : n_.nodes) {
      if (in_lake(n)) lakes.push_back(lake_of(n));
    }
    std::ranges::sort(lakes);
    lakes.erase(std::unique(lakes.begin(), lakes.end()), lakes.end());
  }
  std::int32_t index_of(const Node& n) const {
    return static_cast<std::int32_t>(std::ranges::lower_bound(patch_.lakes, lake_of(n)) -
                                     patch_.lakes.begin());
  }
  void add_spot(std::int64_t i, std::int64_t j) {
    const Node& n = n_.at(i, j);
    double reach = 0;
    for (int d = 0; d < 6; ++d)
      reach = std::max(reach, kReach * distance(n, n_.beside(i, j, d)));
    Spot s{.x = patch_.x_of(n), .z = patch_.z_of(n)};
    if (!patch_.is_reached(s.x, s.z, reach)) return;
    const bool land = n.kind == Kind::kLand;
    s.height_m = height_m(scale_, n.height + (land ? lift(scale_, n_.level, n.mountain) : 0));
    s.inverse_reach2 = static_cast<float>(1 / (reach * reach));
    s.reach = static_cast<std::int32_t>(reach) + 1;
    if (land)
      s.gain += kStreamGain * static_cast<float>(std::min(n.area, channel_)) /
                static_cast<float>(channel_);
    if (in_lake(n)) {
      s.depth_m = static_cast<float>(n.depth / kHeightUnits);
      s.lake = index_of(n);
    }
    patch_.spots.push_back(s);
    if (s.lake >= 0) patch_.lake_spots.push_back(s);
  }

  const Scale& scale_;
  const NodePatch& n_;
  Patch& patch_;
  std::uint32_t channel_;
};

}  // namespace

bool Patch::is_reached(std::int32_t at_x, std::int32_t at_z, double reach) const {
  constexpr std::int32_t kMargin = 4 * kGuideUnits;
  const std::int32_t side = static_cast<std::int32_t>(square.side) + kMargin;
  const double dx = at_x - std::clamp(at_x, -kMargin, side);
  const double dz = at_z - std::clamp(at_z, -kMargin, side);
  return dx * dx + dz * dz < reach * reach;
}

void Patch::fill_bins() {
  spots.shrink_to_fit();
  lake_spots.shrink_to_fit();
  curves.shrink_to_fit();
  lakes.shrink_to_fit();
  spot_bins = bins_of(spots);
  curve_bins = bins_of(curves);
  lake_bins = bins_of(lake_spots);
}

bool Patch::may_have_lake(const Box& box) const {
  const Box read = box.grown(kGuideReach);
  bool any = false;
  lake_bins.find(read, [&](std::size_t k) { any = any || reaches(lake_spots[k], read); });
  return any;
}

bool Patch::is_lake_level(double surface_m, double tolerance_m) const {
  const auto level_m = [](const Lake& lake) { return double{lake.level_m}; };
  const auto found = std::ranges::upper_bound(lakes, surface_m - tolerance_m, {}, level_m);
  return found != lakes.end() && level_m(*found) < surface_m + tolerance_m;
}

bool Patch::may_have_water(const Box& box) const {
  if (may_have_lake(box)) return true;
  bool any = false;
  each_curve(box, [&](const Curve& c) {
    const float x0 = metres(c.x, box.x0), x1 = metres(c.x, box.x1);
    const float z0 = metres(c.z, box.z0), z1 = metres(c.z, box.z1);
    // With room for rounding.
    const float side_m = std::max(c.width0_m, c.width1_m) / 2 + 0.01F + 1e-5F * c.reach_m;
    for (std::size_t s = 0; s < c.chords && !any; ++s) {
      const auto [left, right] = std::minmax(c.px[s], c.px[s + 1]);
      const auto [near, far] = std::minmax(c.pz[s], c.pz[s + 1]);
      any =
          left - side_m <= x1 && right + side_m >= x0 && near - side_m <= z1 && far + side_m >= z0;
    }
  });
  return any;
}

std::size_t Patch::bytes() const {
  return sizeof(Patch) + spots.capacity() * sizeof(Spot) + curves.capacity() * sizeof(Curve) +
         lake_spots.capacity() * sizeof(Spot) + lakes.capacity() * sizeof(Lake) +
         spot_bins.bytes() + curve_bins.bytes() + lake_bins.bytes();
}

float height_m(const Scale& scale, std::int32_t height) {
  // Up to this share of the range heights stay as they are; the rest is compressed. Every step is
  // monotone after rounding too.
  constexpr double kKept = 0.6;
  const double sea = scale.frame.sea_level_m;
  const bool land = height >= 0;
  const double range = land ? scale.frame.relief_m - sea : sea;
  const double metres = (land ? height : -height) / kHeightUnits;
  double y = metres;
  if (const double t = metres / range - kKept; t > 0)
    y = range * (kKept + (1 - kKept) * (1 - 1 / (1 + t / (1 - kKept))));
  return static_cast<float>(land ? sea + y : sea - y);
}

std::int32_t lift(const Scale& scale, int level, float mountain) {
  // Measured over what the rises of the finer levels add up to, by their number.
  constexpr std::array<double, 9> kShare{0, 2.05, 1.6, 1.4, 1.25, 1.15, 1.1, 1.05, 1};
  double rise = 0;
  for (int k = level + 1; k <= scale.halvings(); ++k)
    rise += scale.rise[static_cast<std::size_t>(k)] * static_cast<double>(scale.spacing(k));
  const double share = kShare[static_cast<std::size_t>(scale.halvings() - level)];
  const double m = static_cast<double>(mountain);
  return static_cast<std::int32_t>(share * rise * (0.2 + 0.8 * m) * scale.unit_m * kHeightUnits);
}

Surroundings surroundings_of(const Scale& scale, int level, const Square& square) {
  const double kernels = kReach * kLongestEdge * static_cast<double>(scale.spacing(level));
  const double reach = std::max(kernels, reach_of_channels(scale, level));
  return {square, static_cast<std::int64_t>(reach) + 5 * kGuideUnits};
}

Patch make_patch(const Scale& scale, const NodePatch& nodes, const Square& square) {
  Patch patch;
  patch.level = nodes.level;
  patch.square = square;
  patch.x = floor_div(square.x, kGuideUnits) * kGuideUnits;
  patch.z = floor_div(square.z, kGuideUnits) * kGuideUnits;
  patch.unit_m = static_cast<float>(scale.unit_m);
  patch.sea_level_m = static_cast<float>(scale.frame.sea_level_m);
  patch.shore_m =
      static_cast<float>(0.47 * static_cast<double>(scale.spacing(nodes.level)) * scale.unit_m);
  Spots(scale, nodes, patch).run();
  add_channels(scale, nodes, patch);
  patch.fill_bins();
  return patch;
}

}  // namespace psygen::models::network
