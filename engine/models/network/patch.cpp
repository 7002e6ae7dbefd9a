#include "engine/models/network/patch.hpp"

#include <algorithm>
#include <cmath>

#include "engine/models/kit/exact_math.hpp"

namespace psygen::models::network {
namespace {

constexpr double kReach = 1.08;      // of a kernel, in longest edges of its node
constexpr float kStreamGain = 1.5F;  // of a channel's kernel
constexpr double kMaxWidthM = 150;   // of a channel
constexpr float kWider = 1.25F;      // a channel so much wider takes in another
constexpr float kLoweredM = 8;       // widest channel that the valleys of others lower

// Channels at coarse levels are as dense as at the finest.
std::uint32_t channel_area(const Scale& scale, int level) {
  const int up = 2 * (scale.halvings() - level);
  return static_cast<std::uint32_t>(
      std::min<std::uint64_t>(std::uint64_t{scale.channel_area} << up, 0xFFFFFFFFU));
}
double max_width_m(const Scale& scale, int level) {
  return std::min(kMaxWidthM, 2.5 * static_cast<double>(scale.spacing(level)) * scale.unit_m);
}

// Height of the water of a curve without its least height.
float bent_m(const Curve& c, float t) {
  const float o = 1 - t;
  return o * o * c.height_m[0] + 2 * o * t * c.height_m[1] + t * t * c.height_m[2];
}

// Lowers water at a place, in metres from the node of a wider channel, as the valley of that
// channel lowers the ground there.
float lowered_m(const Curve& wide, float x, float z, float water_m) {
  const NearestPlace near = nearest_place(wide, x, z);
  const float width = width_m(wide, near.t), edge = std::max(near.distance_m - width / 2, 0.0F);
  const float away = std::min(edge / bank_m(width), 1.0F);
  const float share = 1 - away * away * (3 - 2 * away);
  const float bank =
      level_m(wide, near.t) + kBankRiseM * std::min(edge, 1.0F) + kValleySlope * edge;
  return water_m + share * std::min(bank - water_m, 0.0F);
}

// Adds the spots and curves of nodes to a patch.
class Builder {
 public:
  Builder(const Scale& scale, const NodePatch& nodes, Patch& patch)
      : scale_(scale),
        n_(nodes),
        patch_(patch),
        channel_(channel_area(scale, nodes.level)),
        max_m_(max_width_m(scale, nodes.level)) {}

  void run() {
    name_lakes();
    for (std::int64_t j = n_.rect.j0 + 1; j < n_.rect.j1 - 1; ++j) {
      for (std::int64_t i = n_.rect.i0 + 1; i < n_.rect.i1 - 1; ++i) {
        add_spot(i, j);
        add_curves(i, j);
      }
    }
    lower_into_valleys();
    join_arms();
    keep_curves();
    fill_bins();
  }

 private:
  // Guide points around the square, and its distance from the origin.
  static constexpr std::int32_t kMargin = 4 * kGuideUnits;

  static bool in_lake(const Node& n) { return n.kind == Kind::kLake; }
  float water_m(const Node& n) const { return height_m(scale_, std::max(n.height, 0)); }
  float width_m(std::uint32_t area) const { return channel_width_m(scale_.km2(area), max_m_); }
  Lake lake_of(const Node& n) const { return {water_m(n), n.lake}; }

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
  std::int32_t from_origin_x(const Node& n) const {
    return static_cast<std::int32_t>(n.x - patch_.x);
  }
  std::int32_t from_origin_z(const Node& n) const {
    return static_cast<std::int32_t>(n.z - patch_.z);
  }
  // True if a disc touches the square.
  bool touches(std::int32_t x, std::int32_t z, double reach) const {
    const auto side = static_cast<std::int32_t>(patch_.square.side) + kMargin;
    const double dx = x - std::clamp(x, -kMargin, side), dz = z - std::clamp(z, -kMargin, side);
    return dx * dx + dz * dz < reach * reach;
  }

  void add_spot(std::int64_t i, std::int64_t j) {
    const Node& n = n_.at(i, j);
    double reach = 0;
    for (int d = 0; d < 6; ++d)
      reach = std::max(reach, kReach * distance(n, n_.beside(i, j, d)));
    Spot s{.x = from_origin_x(n), .z = from_origin_z(n)};
    if (!touches(s.x, s.z, reach)) return;
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
      patch_.lake_spots.push_back(static_cast<std::uint32_t>(patch_.spots.size()));
    }
    patch_.spots.push_back(s);
  }

  // A place where water has one height for all curves that meet there. Wider channels whose valley
  // it lies in lower it, at most to `lowest_m`: no water rises then, for a joint downstream was at
  // most as high before.
  struct Joint {
    std::int32_t x2 = 0, z2 = 0;  // half units from the patch's origin
    float width_m = 0, lowest_m = 1e30F;
    bool is_lowered() const { return lowest_m < 1e30F && width_m <= kLoweredM; }
  };
  struct Joints {
    Joint begin, node, end;
  };
  // The water in the middle of the edge from a node to its receiver. It is level with a lake or the
  // sea from there on.
  float middle_m(const Node& up, const Node& down) const {
    return down.kind == Kind::kLand ? 0.5F * (water_m(up) + water_m(down)) : water_m(down);
  }
  void add_curves(std::int64_t i, std::int64_t j) {
    const Node& v = n_.at(i, j);
    Outlet out;
    Joints joints;
    joints.node = joint(v, v, v);
    if (v.receiver != kSink) {
      const Node& down = n_.beside(i, j, v.receiver);
      out = {half(v, down), middle_m(v, down)};
      joints.end = joint(v, v, down);
    } else {
      out.height_m = water_m(v);
      joints.end = joints.node;
    }
    const int widest = largest_inflow(i, j, channel_);
    const auto begin = static_cast<std::uint32_t>(curves_.size());
    for (int d = 0; d < 6 && widest >= 0; ++d) {
      const Node& up = n_.beside(i, j, d);
      if (!flows_in(up, d, channel_)) continue;
      const std::uint32_t below = d == widest && v.receiver != kSink ? v.area : 0;
      Curve c;
      c.width0_m = width_m(up.area);
      c.width1_m = width_m(std::max(up.area, below));
      c.discharge_m3_s = static_cast<float>(discharge_m3_s(scale_.km2(up.area)));
      joints.begin = joint(up, up, v);
      joints_.push_back(joints);
      add(c, v, Path{half(v, up), {}, out.place, middle_m(up, v), water_m(v), out.height_m});
    }
    if (curves_.size() > begin + 1)
      arms_.push_back({begin, static_cast<std::uint32_t>(curves_.size())});
    if (widest >= 0 || v.kind != Kind::kLand || v.receiver == kSink || v.area < channel_) return;
    Curve c;
    c.head = true;
    c.width1_m = width_m(v.area);
    c.width0_m = 0.3F * c.width1_m;
    c.discharge_m3_s = static_cast<float>(discharge_m3_s(scale_.km2(v.area)));
    // The spring lies up the valley, if there is one.
    const int above = largest_inflow(i, j, 1);
    Path path{{}, {out.place[0] / 2, out.place[1] / 2}, out.place, water_m(v), 0, out.height_m};
    path.control_m = 0.5F * (path.from_m + path.to_m);
    joints.begin = joints.node;
    if (above >= 0) {
      const Node& up = n_.beside(i, j, above);
      joints.begin = joint(v, up, v);
      path.from = half(v, up);
      path.control = {};
      path.from_m = middle_m(up, v);
      path.control_m = water_m(v);
    }
    joints_.push_back(joints);
    add(c, v, path);
  }
  // The joint of the channel of `of` that lies between two nodes, or at one.
  Joint joint(const Node& of, const Node& from, const Node& to) const {
    Joint joint;
    joint.x2 = from_origin_x(from) + from_origin_x(to);
    joint.z2 = from_origin_z(from) + from_origin_z(to);
    if (from.kind == Kind::kLand && to.kind == Kind::kLand) {
      joint.width_m = width_m(of.area);
      joint.lowest_m = water_m(to);
    }
    return joint;
  }
  static bool flows_in(const Node& up, int direction, std::uint32_t area) {
    return up.receiver == opposite(direction) && up.area >= area;
  }
  // The direction of the inflow with the largest area, if it has at least this one, or −1.
  int largest_inflow(std::int64_t i, std::int64_t j, std::uint32_t area) const {
    int best = -1;
    for (int d = 0; d < 6; ++d) {
      const Node& up = n_.beside(i, j, d);
      if (flows_in(up, d, area) && (best < 0 || up.area > n_.beside(i, j, best).area)) best = d;
    }
    return best;
  }

  void fill_bins() {
    patch_.spots.shrink_to_fit();
    patch_.lake_spots.shrink_to_fit();
    patch_.curves.shrink_to_fit();
    patch_.lakes.shrink_to_fit();
    const auto side = static_cast<std::int32_t>(patch_.square.side / ReachBins::kSide) + 1;
    const auto fill = [&](const auto& things) {
      ReachBins bins(things.size(), side);
      for (std::size_t k = 0; k < things.size(); ++k) {
        const std::int32_t x = things[k].x, z = things[k].z;
        bins.add(k, Box{x, z, x, z}.grown(patch_.reach_units(things[k])));
      }
      return bins;
    };
    patch_.spot_bins = fill(patch_.spots);
    patch_.curve_bins = fill(patch_.curves);
  }
  // The curves that lower others, with bins, around the square too.
  void find_wide() {
    const float narrowest_m = channel_width_m(scale_.km2(channel_), max_m_);
    std::int32_t east = 0, south = 0;
    for (std::size_t k = 0; k < curves_.size(); ++k) {
      const Curve& c = curves_[k];
      if (c.width0_m < kWider * narrowest_m) continue;
      from_x_ = wide_.empty() ? c.x : std::min(from_x_, c.x), east = std::max(east, c.x);
      from_z_ = wide_.empty() ? c.z : std::min(from_z_, c.z), south = std::max(south, c.z);
      wide_.push_back(c);
    }
    const std::int32_t side = std::max(east - from_x_, south - from_z_);
    wide_bins_ = ReachBins(wide_.size(), side / ReachBins::kSide + 1);
    for (std::size_t k = 0; k < wide_.size(); ++k) {
      const std::int32_t x = wide_[k].x - from_x_, z = wide_[k].z - from_z_;
      wide_bins_.add(k, Box{x, z, x, z}.grown(patch_.reach_units(wide_[k])));
    }
  }

  using Vector = std::array<double, 2>;  // metres from a node
  // The place and the water where a node's channels end.
  struct Outlet {
    Vector place{};
    float height_m = 0;
  };
  // The control points of a curve, and its water there.
  struct Path {
    Vector from{}, control{}, to{};
    float from_m, control_m, to_m;
  };
  Vector half(const Node& n, const Node& other) const {
    return {static_cast<double>(other.x - n.x) * scale_.unit_m / 2,
            static_cast<double>(other.z - n.z) * scale_.unit_m / 2};
  }
  void add(Curve& c, const Node& v, const Path& p) {
    c.x = from_origin_x(v);
    c.z = from_origin_z(v);
    c.height_m = {p.from_m, p.control_m, p.to_m};
    for (std::size_t k = 0; k < 2; ++k) {
      c.turn[k] = static_cast<float>(p.control[k] - p.from[k]);
      c.turn[2 + k] = static_cast<float>(p.to[k] - p.control[k]);
    }
    double far = 0;
    for (std::size_t s = 0; s <= Curve::kChords; ++s) {
      const double t = static_cast<double>(s) / Curve::kChords, o = 1 - t;
      const auto at = [&](std::size_t k) {
        return o * o * p.from[k] + 2 * o * t * p.control[k] + t * t * p.to[k];
      };
      c.px[s] = static_cast<float>(at(0));
      c.pz[s] = static_cast<float>(at(1));
      far = std::max(far, length(at(0), at(1)));
      if (s == 0) continue;
      const float ex = c.px[s] - c.px[s - 1], ez = c.pz[s] - c.pz[s - 1];
      const float length2 = ex * ex + ez * ez;
      c.inverse_length2[s - 1] = length2 > 0 ? 1 / length2 : 0;
    }
    const float wide = std::max(c.width0_m, c.width1_m);
    c.reach_m = static_cast<float>(far) + wide / 2 + bank_m(wide) + 0.01F;
    const std::uint64_t hash =
        core::combine(static_cast<std::uint64_t>(v.x), static_cast<std::uint64_t>(v.z));
    c.body = static_cast<std::uint32_t>(hash) | 2U;
    curves_.push_back(c);
  }

  float lowered_m(const Joint& joint, float water_m) const {
    if (!joint.is_lowered() || joint.lowest_m >= water_m) return water_m;
    float lowest_m = water_m;
    const std::int32_t bin_x = joint.x2 / 2 - from_x_, bin_z = joint.z2 / 2 - from_z_;
    wide_bins_.find({bin_x, bin_z, bin_x, bin_z}, [&](std::size_t k) {
      const Curve& wide = wide_[k];
      if (wide.width0_m < kWider * joint.width_m) return;
      const auto metres = [&](std::int32_t place2, std::int32_t node) {
        return static_cast<float>(place2 - 2 * node) * (0.5F * patch_.unit_m);
      };
      const float x = metres(joint.x2, wide.x), z = metres(joint.z2, wide.z);
      if (std::abs(x) > wide.reach_m || std::abs(z) > wide.reach_m) return;
      lowest_m = std::min(lowest_m, network::lowered_m(wide, x, z, water_m));
    });
    return std::max(lowest_m, joint.lowest_m);
  }
  // Lowers the water of channels as the valleys of wider ones lower the ground under them.
  void lower_into_valleys() {
    find_wide();
    for (std::size_t k = 0; k < curves_.size(); ++k) {
      auto& [begin_m, node_m, end_m] = curves_[k].height_m;
      Joints joints = joints_[k];
      end_m = lowered_m(joints.end, end_m);
      if (joints.node.is_lowered()) joints.node.lowest_m = end_m;
      node_m = lowered_m(joints.node, node_m);
      if (curves_[k].head && joints.begin.is_lowered())
        joints.begin.lowest_m = std::min(joints.begin.lowest_m, node_m);
      begin_m = lowered_m(joints.begin, begin_m);
    }
  }

  // The nearest place of curve c to point s of curve q.
  NearestPlace nearest(const Curve& c, const Curve& q, std::size_t s) const {
    const auto offset = [&](std::int32_t to, std::int32_t from) {
      return static_cast<float>(to - from) * patch_.unit_m;
    };
    return nearest_place(c, offset(q.x, c.x) + q.px[s], offset(q.z, c.z) + q.pz[s]);
  }

  // Gives arms of one node one height from where they touch.
  void join_arms() {
    for (const auto& [begin, end] : arms_) {
      for (std::uint32_t k = begin; k < end; ++k) {
        Curve& c = curves_[k];
        std::size_t touch = Curve::kChords;
        for (std::uint32_t o = begin; o < end; ++o) {
          const Curve& other = curves_[o];
          for (std::size_t s = 0; s < touch && o != k; ++s) {
            const NearestPlace n = nearest(other, c, s);
            const float wide = network::width_m(other, n.t) +
                               network::width_m(c, static_cast<float>(s) / Curve::kChords);
            if (n.distance_m < 0.5F * wide) touch = s;
          }
        }
        const std::size_t from = std::max<std::size_t>(touch, 1) - 1;
        c.min_m = c.height_m[2];
        fall(c, from, c.min_m);
      }
    }
  }
  // Lowers the water of a curve so that it has a height, at most its own, at the end of `chords`.
  // It still never rises.
  static void fall(Curve& c, std::size_t chords, float to_m) {
    const float t = static_cast<float>(chords) / Curve::kChords;
    if (chords == 0) {
      c.height_m = {to_m, to_m, to_m};
    } else {
      c.height_m[2] -= std::max(bent_m(c, t) - to_m, 0.0F) / (t * t);
    }
  }

  // Keeps the curves that reach the square, up to where they run into a wider one.
  void keep_curves() {
    for (const Curve& c : curves_) {
      if (!touches(c.x, c.z, static_cast<double>(c.reach_m) / scale_.unit_m + 1)) continue;
      Curve kept = c;
      float lowest = 1e30F;
      for (const Curve& wide : curves_) {
        if (wide.width0_m < kWider * c.width0_m || (wide.x == c.x && wide.z == c.z)) continue;
        const auto dx = static_cast<float>(wide.x - c.x), dz = static_cast<float>(wide.z - c.z);
        const float most = (c.reach_m + wide.reach_m) / patch_.unit_m;
        if (std::abs(dx) > most || std::abs(dz) > most) continue;
        for (std::size_t s = 0; s < std::min<std::size_t>(kept.chords + 1, Curve::kChords); ++s) {
          const float t = static_cast<float>(s) / Curve::kChords;
          const NearestPlace n = nearest(wide, c, s);
          const float level = level_m(wide, n.t);
          if (n.distance_m > 0.5F * network::width_m(wide, n.t) || level > level_m(c, t) + 0.02F)
            continue;
          lowest = s < kept.chords ? level : std::min(lowest, level);
          kept.chords = static_cast<std::uint32_t>(s);
          break;
        }
      }
      if (kept.chords == 0) continue;
      if (kept.chords < Curve::kChords) fall(kept, kept.chords, lowest);
      patch_.curves.push_back(kept);
    }
  }

  const Scale& scale_;
  const NodePatch& n_;
  Patch& patch_;
  std::uint32_t channel_;
  double max_m_;
  std::vector<Curve> curves_;   // of all nodes
  std::vector<Joints> joints_;  // of the curves
  std::vector<Curve> wide_;     // curves that lower others
  ReachBins wide_bins_;         // of these, from (from_x_, from_z_) on
  std::int32_t from_x_ = 0, from_z_ = 0;
  struct Arms {
    std::uint32_t begin, end;
  };
  std::vector<Arms> arms_;  // curves of nodes with several
};

}  // namespace

bool Patch::may_have_lake(const Box& box) const {
  const Box read = box.grown(kGuideReach);
  return std::ranges::any_of(lake_spots, [&](std::uint32_t k) { return reaches(spots[k], read); });
}

bool Patch::may_have_water(const Box& box) const {
  if (may_have_lake(box)) return true;
  bool any = false;
  each_curve(box, [&](const Curve& c) {
    const auto metres = [&](std::int32_t v, std::int32_t of) {
      return static_cast<float>(v - of) * unit_m;
    };
    const float x0 = metres(box.x0, c.x), x1 = metres(box.x1, c.x);
    const float z0 = metres(box.z0, c.z), z1 = metres(box.z1, c.z);
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
         lake_spots.capacity() * sizeof(std::uint32_t) + lakes.capacity() * sizeof(Lake) +
         spot_bins.bytes() + curve_bins.bytes();
}

float level_m(const Curve& c, float t) {
  return std::max(bent_m(c, t), c.min_m);
}

NearestPlace nearest_place(const Curve& c, float x_m, float z_m) {
  float best = 1e30F, t = 0;
  for (std::size_t k = 0; k < c.chords; ++k) {
    const float ex = c.px[k + 1] - c.px[k], ez = c.pz[k + 1] - c.pz[k];
    const float dx = x_m - c.px[k], dz = z_m - c.pz[k];
    const float f = std::clamp((dx * ex + dz * ez) * c.inverse_length2[k], 0.0F, 1.0F);
    const float qx = dx - f * ex, qz = dz - f * ez, square = qx * qx + qz * qz;
    if (square >= best) continue;
    best = square;
    t = (static_cast<float>(k) + f) / Curve::kChords;
  }
  return {std::sqrt(best), t};
}

float channel_width_m(double km2, double max_m) {
  return static_cast<float>(std::min(max_m, 2.6 * exact_pow(std::max(km2, 1e-9), 0.42)));
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
  const double spacing = static_cast<double>(scale.spacing(level));
  const auto wide = static_cast<float>(max_width_m(scale, level));
  const float narrow = std::min(kLoweredM, wide);
  // A channel whose banks reach the square may end in another, which lies in the valley of a third.
  // From joint to joint a channel is two spacings long.
  const float banks_m =
      std::max(wide + bank_m(wide), bank_m(narrow) + 1.5F * narrow + bank_m(wide) + 0.5F * wide);
  const double reach =
      std::max(kReach * kLongestEdge * spacing, 5 * spacing + double{banks_m} / scale.unit_m);
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
  Builder(scale, nodes, patch).run();
  return patch;
}

}  // namespace psygen::models::network
