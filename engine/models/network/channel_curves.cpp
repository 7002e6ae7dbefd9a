#include "engine/models/network/channel_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace psygen::models::network {
namespace {

constexpr double kMaxWidthM = 150;  // of a channel
constexpr float kWider = 1.25F;     // a channel so much wider takes in another
constexpr float kLoweredM = 8;      // widest channel that the valleys of others lower

double max_width_m(const Scale& scale, int level) {
  return std::min(kMaxWidthM, 2.5 * static_cast<double>(scale.spacing(level)) * scale.unit_m);
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

// Makes the curves of nodes.
class Channels {
 public:
  Channels(const Scale& scale, const NodePatch& nodes, Patch& patch)
      : scale_(scale),
        n_(nodes),
        patch_(patch),
        channel_(channel_area(scale, nodes.level)),
        max_m_(max_width_m(scale, nodes.level)) {}

  void run() {
    for (std::int64_t j = n_.rect.j0 + 1; j < n_.rect.j1 - 1; ++j) {
      for (std::int64_t i = n_.rect.i0 + 1; i < n_.rect.i1 - 1; ++i)
        add_curves(i, j);
    }
    bins_ = patch_.bins_of(curves_);
    lower_into_valleys();
    join_arms();
    keep_curves();
  }

 private:
  float width_m(std::uint32_t area) const { return channel_width_m(scale_.km2(area), max_m_); }
  float water_m(const Node& n) const { return network::water_m(scale_, n); }

  // A place where water has one height for all curves that meet there. Wider channels whose valley
  // it lies in lower it, at most to `lowest_m`: no water rises then, for a joint downstream was at
  // most as high before.
  struct Joint {
    std::int32_t x2 = 0, z2 = 0;  // half units from the patch's origin
    float width_m = 0, lowest_m = 1e30F;
    bool is_lowered() const { return lowest_m < 1e30F && width_m <= kLoweredM; }
  };
  // The curves of a node, and where they meet.
  struct Meeting {
    std::size_t begin = 0, end = 0;
    Joint node, out;
  };
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
  // The water in the middle of the edge from a node to its receiver. It is level with a lake or the
  // sea from there on.
  float middle_m(const Node& up, const Node& down) const {
    return down.kind == Kind::kLand ? 0.5F * (water_m(up) + water_m(down)) : water_m(down);
  }
  void add_curves(std::int64_t i, std::int64_t j) {
    const Node& v = n_.at(i, j);
    const int widest = largest_inflow(i, j, channel_);
    const bool springs =
        widest < 0 && v.kind == Kind::kLand && v.receiver != kSink && v.area >= channel_;
    if (widest < 0 && !springs) return;
    Meeting meeting;
    meeting.begin = curves_.size();
    meeting.node = meeting.out = joint(v, v, v);
    Outlet out{.height_m = water_m(v)};
    if (v.receiver != kSink) {
      const Node& down = n_.beside(i, j, v.receiver);
      out = {half(v, down), middle_m(v, down)};
      meeting.out = joint(v, v, down);
    }
    if (springs) {
      add_spring(i, j, out);
    } else {
      add_arms(i, j, widest, out);
    }
    meeting.end = curves_.size();
    meetings_.push_back(meeting);
  }
  void add_arms(std::int64_t i, std::int64_t j, int widest, const Outlet& out) {
    const Node& v = n_.at(i, j);
    for (int d = 0; d < 6; ++d) {
      const Node& up = n_.beside(i, j, d);
      if (!flows_in(up, d, channel_)) continue;
      const std::uint32_t below = d == widest && v.receiver != kSink ? v.area : 0;
      Curve c;
      c.width0_m = width_m(up.area);
      c.width1_m = width_m(std::max(up.area, below));
      c.discharge_m3_s = static_cast<float>(discharge_m3_s(scale_.km2(up.area)));
      add(c, v, joint(up, up, v),
          {half(v, up), {}, out.place, middle_m(up, v), water_m(v), out.height_m});
    }
  }
  // The spring lies up the valley, if there is one.
  void add_spring(std::int64_t i, std::int64_t j, const Outlet& out) {
    const Node& v = n_.at(i, j);
    Curve c;
    c.head = true;
    c.width1_m = width_m(v.area);
    c.width0_m = 0.3F * c.width1_m;
    c.discharge_m3_s = static_cast<float>(discharge_m3_s(scale_.km2(v.area)));
    if (const int above = largest_inflow(i, j, 1); above >= 0) {
      const Node& up = n_.beside(i, j, above);
      add(c, v, joint(v, up, v),
          {half(v, up), {}, out.place, middle_m(up, v), water_m(v), out.height_m});
    } else {
      add(c, v, joint(v, v, v),
          {{},
           {out.place[0] / 2, out.place[1] / 2},
           out.place,
           water_m(v),
           0.5F * (water_m(v) + out.height_m),
           out.height_m});
    }
  }
  // The joint of the channel of `of` that lies between two nodes, or at one.
  Joint joint(const Node& of, const Node& from, const Node& to) const {
    Joint joint;
    joint.x2 = patch_.x_of(from) + patch_.x_of(to);
    joint.z2 = patch_.z_of(from) + patch_.z_of(to);
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

  Vector half(const Node& n, const Node& other) const {
    return {static_cast<double>(other.x - n.x) * scale_.unit_m / 2,
            static_cast<double>(other.z - n.z) * scale_.unit_m / 2};
  }
  void add(Curve& c, const Node& v, const Joint& begin, const Path& p) {
    c.x = patch_.x_of(v);
    c.z = patch_.z_of(v);
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
    begins_.push_back(begin);
  }

  float lowered_m(const Joint& joint, float water_m) const {
    if (!joint.is_lowered() || joint.lowest_m >= water_m) return water_m;
    float lowest_m = water_m;
    const std::int32_t x = joint.x2 / 2, z = joint.z2 / 2;
    bins_.find({x, z, x, z}, [&](std::size_t k) {
      const Curve& wide = curves_[k];
      if (wide.width0_m < kWider * joint.width_m) return;
      const float x_m = patch_.metres(2 * wide.x, joint.x2) / 2;
      const float z_m = patch_.metres(2 * wide.z, joint.z2) / 2;
      if (std::abs(x_m) > wide.reach_m || std::abs(z_m) > wide.reach_m) return;
      lowest_m = std::min(lowest_m, network::lowered_m(wide, x_m, z_m, water_m));
    });
    return std::max(lowest_m, joint.lowest_m);
  }
  // Lowers the water of channels as the valleys of wider ones lower the ground under them.
  void lower_into_valleys() {
    std::vector<std::array<float, 3>> lowered(curves_.size());
    for (Meeting m : meetings_) {
      const auto& [from_m, middle_m, to_m] = curves_[m.begin].height_m;
      const float out_m = lowered_m(m.out, to_m);
      if (m.node.is_lowered()) m.node.lowest_m = out_m;
      const float node_m = lowered_m(m.node, middle_m);
      for (std::size_t k = m.begin; k < m.end; ++k) {
        Joint begin = begins_[k];
        if (curves_[k].head && begin.is_lowered())
          begin.lowest_m = std::min(begin.lowest_m, node_m);
        lowered[k] = {lowered_m(begin, curves_[k].height_m[0]), node_m, out_m};
      }
    }
    for (std::size_t k = 0; k < curves_.size(); ++k)
      curves_[k].height_m = lowered[k];
  }

  // The nearest place of curve c to point s of curve q.
  NearestPlace nearest(const Curve& c, const Curve& q, std::size_t s) const {
    return nearest_place(c, patch_.metres(c.x, q.x) + q.px[s], patch_.metres(c.z, q.z) + q.pz[s]);
  }

  // Gives arms of one node one height from where they touch.
  void join_arms() {
    for (const Meeting& m : meetings_) {
      if (m.end == m.begin + 1) continue;
      for (std::size_t k = m.begin; k < m.end; ++k) {
        Curve& c = curves_[k];
        std::size_t touch = Curve::kChords;
        for (std::size_t o = m.begin; o < m.end; ++o) {
          const Curve& other = curves_[o];
          for (std::size_t s = 0; s < touch && o != k; ++s) {
            const NearestPlace n = nearest(other, c, s);
            const float wide = network::width_m(other, n.t) +
                               network::width_m(c, static_cast<float>(s) / Curve::kChords);
            if (n.distance_m < 0.5F * wide) touch = s;
          }
        }
        c.min_m = c.height_m[2];
        lower_end(c, std::max<std::size_t>(touch, 1) - 1, c.min_m);
      }
    }
  }

  // Keeps the curves that reach the square, up to where they run into a wider one.
  void keep_curves() {
    for (const Curve& c : curves_) {
      if (!patch_.is_reached(c.x, c.z, static_cast<double>(c.reach_m) / scale_.unit_m + 1))
        continue;
      Curve kept = c;
      float lowest = 1e30F;
      bins_.find(Box{c.x, c.z, c.x, c.z}.grown(patch_.reach_units(c)), [&](std::size_t k) {
        const Curve& wide = curves_[k];
        if (wide.width0_m < kWider * c.width0_m || (wide.x == c.x && wide.z == c.z)) return;
        const auto dx = static_cast<float>(wide.x - c.x), dz = static_cast<float>(wide.z - c.z);
        const float far = (c.reach_m + wide.reach_m) / patch_.unit_m;
        if (std::abs(dx) > far || std::abs(dz) > far) return;
        for (std::size_t s = 0; s < std::min<std::size_t>(kept.chords + 1, Curve::kChords); ++s) {
          const float t = static_cast<float>(s) / Curve::kChords;
          const NearestPlace n = nearest(wide, c, s);
          const float level = level_m(wide, n.t);
          if (n.distance_m > 0.5F * network::width_m(wide, n.t) || level > level_m(c, t) + 0.02F)
            continue;
          lowest = s < kept.chords ? level : std::min(lowest, level);
          kept.chords = static_cast<std::uint32_t>(s);
          return;
        }
      });
      if (kept.chords == 0) continue;
      if (kept.chords < Curve::kChords) lower_end(kept, kept.chords, lowest);
      patch_.curves.push_back(kept);
    }
  }

  const Scale& scale_;
  const NodePatch& n_;
  Patch& patch_;
  std::uint32_t channel_;
  double max_m_;
  std::vector<Curve> curves_;  // of all nodes
  std::vector<Joint> begins_;  // of the curves
  std::vector<Meeting> meetings_;
  ReachBins bins_;  // of the curves
};

}  // namespace

std::uint32_t channel_area(const Scale& scale, int level) {
  const int up = 2 * (scale.halvings() - level);
  return static_cast<std::uint32_t>(
      std::min<std::uint64_t>(std::uint64_t{scale.channel_area} << up, 0xFFFFFFFFU));
}

double reach_of_channels(const Scale& scale, int level) {
  const auto wide = static_cast<float>(max_width_m(scale, level));
  const float narrow = std::min(kLoweredM, wide);
  // A channel whose banks reach the square may end in another, which lies in the valley of a third.
  // From joint to joint a channel is two spacings long.
  const float banks_m =
      std::max(wide + bank_m(wide), bank_m(narrow) + 1.5F * narrow + bank_m(wide) + 0.5F * wide);
  return 5 * static_cast<double>(scale.spacing(level)) + double{banks_m} / scale.unit_m;
}

void add_channels(const Scale& scale, const NodePatch& nodes, Patch& patch) {
  Channels(scale, nodes, patch).run();
}

}  // namespace psygen::models::network
