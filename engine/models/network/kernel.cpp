// Spots are few per call, so each spot runs over rows of points, in the order of the lattice.
// Points outside its reach gain +0, which changes no bit. Channels run over vectors of samples.
#include "engine/models/network/kernel.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "engine/models/kit/scratch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/network/kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef PSYGEN_MODELS_NETWORK_KERNEL_ONCE
#define PSYGEN_MODELS_NETWORK_KERNEL_ONCE
namespace psygen::models::network {

// Points of the guide along an axis, and floats of a row of any grid here.
constexpr std::size_t kMaxGuide = 48, kRow = 96;

// The spots and curves that reach a call's samples.
struct Chosen {
  std::vector<const Spot*> spots;
  std::vector<const Curve*> curves;
  std::vector<std::int32_t> lakes;  // ascending
};

}  // namespace psygen::models::network
#endif

HWY_BEFORE_NAMESPACE();
namespace psygen::models::network::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using FloatTag = hn::CappedTag<float, 16>;
using IntTag = hn::RebindToSigned<FloatTag>;
using Float = hn::Vec<FloatTag>;
using Int = hn::Vec<IntTag>;

HWY_INLINE Float set(float value) {
  return hn::Set(FloatTag(), value);
}
HWY_INLINE Float load(const float* from) {
  return hn::LoadU(FloatTag(), from);
}
HWY_INLINE void store(Float value, float* to) {
  hn::StoreU(value, FloatTag(), to);
}
HWY_INLINE std::size_t lanes() {
  return hn::Lanes(FloatTag());
}
// The first n lanes of rows of callers, which end with their last sample.
HWY_INLINE Float load_few(const float* from, std::size_t n) {
  if (n == lanes()) return load(from);
  HWY_ALIGN float few[16] = {};
  std::copy_n(from, n, few);
  return hn::Load(FloatTag(), few);
}
template <class D, class V, class T>
HWY_INLINE void store_few(V value, D d, T* to, std::size_t n) {
  if (n == lanes()) return hn::StoreU(value, d, to);
  HWY_ALIGN T few[16];
  hn::Store(value, d, few);
  std::copy_n(few, n, to);
}
HWY_INLINE Float smooth(Float t) {
  return hn::Mul(hn::Mul(t, t), hn::Sub(set(3), hn::Mul(set(2), t)));
}

// Points of a grid, in units. Columns are padded with the last one to whole vectors.
struct Axes {
  HWY_ALIGN std::int32_t x[kRow];
  std::int32_t z[kMaxSamples];
  std::size_t columns = 0, rows = 0;

  void pad() {
    for (std::size_t i = columns; i < kRow; ++i)
      x[i] = x[columns - 1];
  }
};

// Sums over kernels at each point of a grid.
struct Sums {
  static constexpr std::size_t kRows = kMaxSamples;
  HWY_ALIGN float weight[kRows * kRow], height[kRows * kRow];
  // Of derivatives along x and z, of weights and of weights times heights.
  HWY_ALIGN float wx[kRows * kRow], wz[kRows * kRow], hx[kRows * kRow], hz[kRows * kRow];
  // Of the spots of one lake, and of their depths.
  HWY_ALIGN float lake[kRows * kRow], depth[kRows * kRow];
};

// The lake with the largest share at each sample.
struct LakeRows {
  HWY_ALIGN float share[kMaxSamples * kRow], level[kMaxSamples * kRow], depth[kMaxSamples * kRow];
  HWY_ALIGN std::int32_t body[kMaxSamples * kRow];
};

enum class Wanted { kHeight, kGradient, kLake };

// The range of columns within `reach` of x, from a multiple of the lanes.
struct Range {
  std::size_t first, end;
};
HWY_INLINE Range within(const Axes& axes, std::int32_t x, std::int32_t reach) {
  const std::int32_t* const end = axes.x + axes.columns;
  const auto first = static_cast<std::size_t>(std::lower_bound(axes.x, end, x - reach) - axes.x);
  const auto last = static_cast<std::size_t>(std::upper_bound(axes.x, end, x + reach) - axes.x);
  return {first - first % lanes(), last};
}

template <Wanted kWanted>
HWY_INLINE void add_spot(const Spot& s, const Axes& axes, Sums& sums) {
  const FloatTag d;
  const IntTag di;
  const Range columns = within(axes, s.x, s.reach);
  for (std::size_t r = 0; r < axes.rows; ++r) {
    const float dz = static_cast<float>(axes.z[r] - s.z);
    const float rz = dz * dz * s.inverse_reach2;
    if (rz >= 1) continue;
    for (std::size_t i = columns.first; i < columns.end; i += lanes()) {
      const std::size_t at = r * kRow + i;
      const Float dx = hn::ConvertTo(d, hn::Sub(hn::Load(di, axes.x + i), hn::Set(di, s.x)));
      const Float rx = hn::Mul(hn::Mul(dx, dx), set(s.inverse_reach2));
      const Float q = hn::Max(hn::Sub(set(1), hn::Add(rx, set(rz))), hn::Zero(d));
      const Float q2 = hn::Mul(q, q), w = hn::Mul(hn::Mul(q2, q2), set(s.gain));
      const auto add = [&](float* sum, Float value)
                           HWY_ATTR { store(hn::Add(load(sum + at), value), sum + at); };
      if constexpr (kWanted == Wanted::kLake) {
        add(sums.lake, w);
        add(sums.depth, hn::Mul(w, set(s.depth_m)));
      } else {
        add(sums.weight, w);
        add(sums.height, hn::Mul(w, set(s.height_m)));
      }
      if constexpr (kWanted == Wanted::kGradient) {
        const Float dw = hn::Mul(hn::Mul(q2, q), set(-8 * s.inverse_reach2 * s.gain));
        const Float wx = hn::Mul(dw, dx), wz = hn::Mul(dw, set(dz));
        add(sums.wx, wx);
        add(sums.wz, wz);
        add(sums.hx, hn::Mul(wx, set(s.height_m)));
        add(sums.hz, hn::Mul(wz, set(s.height_m)));
      }
    }
  }
}

// Reads a grid of guide points at samples by cubic interpolation (Catmull and Rom, 1974).
class GuideReader {
 public:
  // Finds the guide points around the samples.
  GuideReader(const Axes& samples, Axes& guide) : samples_(samples) {
    const auto below = [](std::int32_t v) {
      return static_cast<std::int32_t>(floor_div(v, kGuideUnits));
    };
    const std::int32_t x0 = below(samples.x[0]) - 1, z0 = below(samples.z[0]) - 1;
    guide.columns = static_cast<std::size_t>(below(samples.x[samples.columns - 1]) + 3 - x0);
    guide.rows = static_cast<std::size_t>(below(samples.z[samples.rows - 1]) + 3 - z0);
    for (std::size_t i = 0; i < guide.columns; ++i)
      guide.x[i] = (x0 + static_cast<std::int32_t>(i)) * kGuideUnits;
    for (std::size_t i = 0; i < guide.rows; ++i)
      guide.z[i] = (z0 + static_cast<std::int32_t>(i)) * kGuideUnits;
    guide.pad();
    for (std::size_t i = 0; i < kRow; ++i)
      find(samples.x[i], x0, column_[i], i);
    for (std::size_t r = 0; r < samples.rows; ++r)
      row_[r] = below(samples.z[r]) - z0 - 1;
  }

  // Reads one row of samples; null: not wanted. Slopes are per guide step.
  void read(const float* grid, std::size_t row, float* value, float* slope_x,
            float* slope_z) const {
    const FloatTag d;
    const IntTag di;
    HWY_ALIGN float blend[kMaxGuide + 16], rise[kMaxGuide + 16];
    const Taps z = taps(fraction(samples_.z[row]));
    const float* const first = grid + static_cast<std::size_t>(row_[row]) * kRow;
    for (std::size_t i = 0; i < kMaxGuide; i += lanes()) {
      Float sum = hn::Zero(d), slope = hn::Zero(d);
      for (std::size_t k = 0; k < 4; ++k) {
        const Float g = load(first + k * kRow + i);
        sum = hn::Add(sum, hn::Mul(g, set(z.weight[k])));
        slope = hn::Add(slope, hn::Mul(g, set(z.slope[k])));
      }
      hn::Store(sum, d, blend + i);
      hn::Store(slope, d, rise + i);
    }
    for (std::size_t i = 0; i < samples_.columns; i += lanes()) {
      Float sum = hn::Zero(d), along = hn::Zero(d), across = hn::Zero(d);
      for (std::size_t k = 0; k < 4; ++k) {
        const Int index =
            hn::Add(hn::Load(di, column_ + i), hn::Set(di, static_cast<std::int32_t>(k)));
        const Float b = hn::GatherIndex(d, blend, index);
        const Float weight = hn::Load(d, weight_[k] + i);
        sum = hn::Add(sum, hn::Mul(b, weight));
        if (slope_x == nullptr) continue;
        along = hn::Add(along, hn::Mul(b, hn::Load(d, slope_[k] + i)));
        across = hn::Add(across, hn::Mul(hn::GatherIndex(d, rise, index), weight));
      }
      store(sum, value + i);
      if (slope_x == nullptr) continue;
      store(along, slope_x + i);
      store(across, slope_z + i);
    }
  }

 private:
  struct Taps {
    float weight[4], slope[4];
  };
  static float fraction(std::int32_t v) {
    const auto cell = static_cast<std::int32_t>(floor_div(v, kGuideUnits));
    return static_cast<float>(v - cell * kGuideUnits) / static_cast<float>(kGuideUnits);
  }
  static Taps taps(float t) {
    const float t2 = t * t, t3 = t2 * t;
    return {{0.5F * (2 * t2 - t3 - t), 0.5F * (2 - 5 * t2 + 3 * t3), 0.5F * (t + 4 * t2 - 3 * t3),
             0.5F * (t3 - t2)},
            {0.5F * (4 * t - 3 * t2 - 1), 0.5F * (9 * t2 - 10 * t), 0.5F * (1 + 8 * t - 9 * t2),
             0.5F * (3 * t2 - 2 * t)}};
  }
  void find(std::int32_t v, std::int32_t first, std::int32_t& index, std::size_t i) {
    index = static_cast<std::int32_t>(floor_div(v, kGuideUnits)) - first - 1;
    const Taps x = taps(fraction(v));
    for (std::size_t k = 0; k < 4; ++k) {
      weight_[k][i] = x.weight[k];
      slope_[k][i] = x.slope[k];
    }
  }

  const Axes& samples_;
  HWY_ALIGN std::int32_t column_[kRow];
  HWY_ALIGN float weight_[4][kRow], slope_[4][kRow];
  std::int32_t row_[kMaxSamples];
};

// The position of a vector of samples against a channel.
struct Beside {
  Float t;                            // along the curve, 0 … 1
  Float distance;                     // from the middle of the water, m
  Float surface, width, edge, taper;  // edge: distance from the water's edge, < 0 inside
  Float abeam;                        // 1 beside the curve … 0 beyond its ends
  Float valley;                       // of banks: 0 at a spring … 1
  hn::Mask<FloatTag> near;            // within the reach of the banks
};

HWY_INLINE Beside beside(const Curve& c, Float px, Float pz) {
  const FloatTag d;
  Float best = set(1e30F), t = hn::Zero(d);
  for (std::size_t s = 0; s < c.chords; ++s) {
    const Float dx = hn::Sub(px, set(c.px[s])), dz = hn::Sub(pz, set(c.pz[s]));
    const Float ex = set(c.px[s + 1] - c.px[s]), ez = set(c.pz[s + 1] - c.pz[s]);
    const Float along =
        hn::Mul(hn::Add(hn::Mul(dx, ex), hn::Mul(dz, ez)), set(c.inverse_length2[s]));
    const Float f = hn::Min(hn::Max(along, hn::Zero(d)), set(1));
    const Float qx = hn::Sub(dx, hn::Mul(f, ex)), qz = hn::Sub(dz, hn::Mul(f, ez));
    const Float square = hn::Add(hn::Mul(qx, qx), hn::Mul(qz, qz));
    const auto closer = hn::Lt(square, best);
    best = hn::Min(square, best);
    const Float place = hn::Mul(hn::Add(f, set(static_cast<float>(s))), set(1.0F / Curve::kChords));
    t = hn::IfThenElse(closer, place, t);
  }
  Beside b;
  const float end_t = static_cast<float>(c.chords) / Curve::kChords;
  b.t = hn::Min(t, set(end_t));
  // Beyond an end the next curve shapes the ground.
  const auto past = [&](std::size_t p, std::size_t s, float sign) HWY_ATTR {
    const Float dx = hn::Sub(px, set(c.px[p])), dz = hn::Sub(pz, set(c.pz[p]));
    const float ex = c.px[s + 1] - c.px[s], ez = c.pz[s + 1] - c.pz[s];
    const Float dot = hn::Add(hn::Mul(dx, set(sign * ex)), hn::Mul(dz, set(sign * ez)));
    const Float over = hn::Max(dot, hn::Zero(d));
    return hn::Mul(hn::Mul(over, over), set(c.inverse_length2[s]));
  };
  const Float end = hn::IfThenElse(
      hn::Lt(b.t, set(1e-6F)), past(0, 0, -1),
      hn::IfThenElseZero(hn::Gt(b.t, set(end_t - 1e-6F)), past(c.chords, c.chords - 1, 1)));
  const Float sine2 = hn::Div(end, hn::Max(best, set(1e-6F)));
  b.abeam = hn::Max(hn::Sub(set(1), hn::Mul(sine2, set(4))), hn::Zero(d));
  b.distance = hn::Sqrt(best);
  const Float o = hn::Sub(set(1), b.t);
  const Float twice = hn::Mul(hn::Add(b.t, b.t), set(c.height_m[1] - c.height_m[2]));
  const Float fall = hn::Mul(o, hn::Add(hn::Mul(o, set(c.height_m[0] - c.height_m[2])), twice));
  b.surface = hn::Max(hn::Add(set(c.height_m[2]), fall), set(c.min_m));
  b.width = hn::Add(set(c.width0_m), hn::Mul(b.t, set(c.width1_m - c.width0_m)));
  b.edge = hn::Sub(b.distance, hn::Mul(b.width, set(0.5F)));
  b.taper = c.head ? smooth(hn::Min(hn::Add(b.t, b.t), set(1))) : set(1);
  b.valley = c.head ? smooth(b.t) : set(1);
  b.near = hn::Lt(b.edge, hn::Add(set(kValleyM), hn::Mul(b.width, set(kBankWidths))));
  return b;
}

// The vectors of channel_depth_m().
HWY_INLINE Float depth_of(const Beside& b) {
  return hn::Add(set(kBedM), hn::Mul(b.width, set(kBedWidths)));
}

// One call: the chosen spots and curves at its samples.
class Call {
 public:
  Call(const Patch& patch, const Samples& samples, const Chosen& chosen)
      : patch_(patch), chosen_(chosen), guided_(samples.guided) {
    Axes& s = samples_;
    s.columns = samples.x.size();
    s.rows = samples.z.size();
    std::copy(samples.x.begin(), samples.x.end(), s.x);
    std::copy(samples.z.begin(), samples.z.end(), s.z);
    s.pad();
    if (guided_) reader_.emplace(s, guide_);
  }

  void base(const BaseRows& out) {
    sum_all(out.slope_x != nullptr);
    if (!chosen_.lakes.empty()) find_lakes();
    for (std::size_t r = 0; r < samples_.rows; ++r)
      base_row(r, out);
  }
  void carve(const CarvedRows& out) {
    if (!chosen_.lakes.empty()) {
      sum_all(false);
      find_lakes();
    }
    for (std::size_t r = 0; r < samples_.rows; ++r) {
      for (std::size_t i = 0; i < samples_.columns; i += lanes())
        carve_vector(r, i, out);
    }
  }

 private:
  const Axes& axes() const { return guided_ ? guide_ : samples_; }

  // Sums over all spots; then heights are divided by weights.
  void sum_all(bool gradient) {
    const Axes& a = axes();
    Sums& sums = *sums_;
    const std::size_t size = a.rows * kRow;
    std::fill_n(sums.weight, size, 0.0F);
    std::fill_n(sums.height, size, 0.0F);
    if (gradient && !guided_) {
      for (float* sum : {sums.wx, sums.wz, sums.hx, sums.hz})
        std::fill_n(sum, size, 0.0F);
      for (const Spot* s : chosen_.spots)
        add_spot<Wanted::kGradient>(*s, a, sums);
    } else {
      for (const Spot* s : chosen_.spots)
        add_spot<Wanted::kHeight>(*s, a, sums);
    }
    const Float least = set(1e-20F);
    for (std::size_t r = 0; r < a.rows; ++r) {
      for (std::size_t i = r * kRow; i < r * kRow + a.columns; i += lanes()) {
        const Float w = hn::Max(load(sums.weight + i), least);
        const Float h = hn::Div(load(sums.height + i), w);
        store(w, sums.weight + i);
        store(h, sums.height + i);
        if (!gradient || guided_) continue;
        const auto slope = [&](float* height, const float* weight) HWY_ATTR {
          store(hn::Div(hn::Sub(load(height + i), hn::Mul(h, load(weight + i))), w), height + i);
        };
        slope(sums.hx, sums.wx);
        slope(sums.hz, sums.wz);
      }
    }
  }

  // Finds the lake with the largest share at every sample.
  void find_lakes() {
    const Axes& a = axes();
    Sums& sums = *sums_;
    LakeRows& lakes = *lakes_;
    for (float* row : {lakes.share, lakes.level, lakes.depth})
      std::fill_n(row, samples_.rows * kRow, 0.0F);
    std::fill_n(lakes.body, samples_.rows * kRow, 0);
    for (const std::int32_t index : chosen_.lakes) {
      const Lake& lake = patch_.lakes[static_cast<std::size_t>(index)];
      std::fill_n(sums.lake, a.rows * kRow, 0.0F);
      std::fill_n(sums.depth, a.rows * kRow, 0.0F);
      for (const Spot* s : chosen_.spots) {
        if (s->lake == index) add_spot<Wanted::kLake>(*s, a, sums);
      }
      for (std::size_t r = 0; r < a.rows; ++r) {
        for (std::size_t i = r * kRow; i < r * kRow + a.columns; i += lanes()) {
          store(hn::Div(load(sums.lake + i), load(sums.weight + i)), sums.lake + i);
          store(hn::Div(load(sums.depth + i), load(sums.weight + i)), sums.depth + i);
        }
      }
      for (std::size_t r = 0; r < samples_.rows; ++r)
        compare_lake(r, lake);
    }
  }
  void compare_lake(std::size_t r, const Lake& lake) {
    const IntTag di;
    HWY_ALIGN float share[kRow], depth[kRow];
    const float *shares = sums_->lake + r * kRow, *depths = sums_->depth + r * kRow;
    if (guided_) {
      reader_->read(sums_->lake, r, share, nullptr, nullptr);
      reader_->read(sums_->depth, r, depth, nullptr, nullptr);
      shares = share;
      depths = depth;
    }
    LakeRows& best = *lakes_;
    for (std::size_t i = 0; i < samples_.columns; i += lanes()) {
      const std::size_t at = r * kRow + i;
      const Float s = hn::Min(load(shares + i), set(1)), old = load(best.share + at);
      const auto more = hn::Gt(s, old);
      // The depth of the lake's own spots.
      const Float deep = hn::Div(load(depths + i), hn::Max(s, set(1e-3F)));
      store(hn::IfThenElse(more, s, old), best.share + at);
      store(hn::IfThenElse(more, set(lake.level_m), load(best.level + at)), best.level + at);
      store(hn::IfThenElse(more, deep, load(best.depth + at)), best.depth + at);
      const Int body = hn::Set(di, static_cast<std::int32_t>(lake.body));
      hn::StoreU(hn::IfThenElse(hn::RebindMask(di, more), body, hn::LoadU(di, best.body + at)), di,
                 best.body + at);
    }
  }

  // The share, the level and the depth of the lake at a vector.
  struct LakeAt {
    Float share, level, depth;
  };
  LakeAt lake_at(std::size_t at) const {
    const FloatTag d;
    if (chosen_.lakes.empty()) return {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    return {load(lakes_->share + at), load(lakes_->level + at), load(lakes_->depth + at)};
  }
  // Closes the shore: no ground beside a lake lies lower than its water.
  Float closed(Float ground, const LakeAt& lake) const {
    const Float open = hn::Max(hn::Sub(set(0.5F), lake.share), hn::Zero(FloatTag()));
    const Float shore = hn::Sub(lake.level, hn::Mul(open, set(patch_.shore_m)));
    return hn::IfThenElse(hn::Gt(lake.share, set(0.1F)), hn::Max(ground, shore), ground);
  }

  void base_row(std::size_t r, const BaseRows& out) {
    HWY_ALIGN float height[kRow], along[kRow], across[kRow];
    const float *heights = sums_->height + r * kRow, *slopes_x = sums_->hx + r * kRow,
                *slopes_z = sums_->hz + r * kRow;
    float per_metre = 1.0F / patch_.unit_m;
    if (guided_) {
      const bool slopes = out.slope_x != nullptr;
      reader_->read(sums_->height, r, height, slopes ? along : nullptr, slopes ? across : nullptr);
      heights = height;
      slopes_x = along;
      slopes_z = across;
      per_metre = per_metre / static_cast<float>(kGuideUnits);
    }
    for (std::size_t i = 0; i < samples_.columns; i += lanes()) {
      const std::size_t n = std::min(lanes(), samples_.columns - i);
      const LakeAt lake = lake_at(r * kRow + i);
      const Float base = closed(load(heights + i), lake);
      const auto write = [&](Float value, float* rows) HWY_ATTR {
        if (rows != nullptr) store_few(value, FloatTag(), rows + r * out.stride + i, n);
      };
      write(base, out.height_m);
      if (out.slope_x != nullptr) {
        write(hn::Mul(load(slopes_x + i), set(per_metre)), out.slope_x);
        write(hn::Mul(load(slopes_z + i), set(per_metre)), out.slope_z);
      }
      if (out.clear != nullptr) write(clear_at(r, i, base, lake), out.clear);
    }
  }

  // True if a curve may reach the vector at column i of row r, and its place from the curve's node.
  bool reaches(const Curve& c, std::size_t r, std::size_t i, Float& px, Float& pz) const {
    const float dz = static_cast<float>(samples_.z[r] - c.z) * patch_.unit_m;
    if (dz > c.reach_m || -dz > c.reach_m) return false;
    const float first = static_cast<float>(samples_.x[i] - c.x) * patch_.unit_m;
    const float last = static_cast<float>(samples_.x[i + lanes() - 1] - c.x) * patch_.unit_m;
    if (first > c.reach_m || -last > c.reach_m) return false;
    const FloatTag d;
    const IntTag di;
    const Int dx = hn::Sub(hn::Load(di, samples_.x + i), hn::Set(di, c.x));
    px = hn::Mul(hn::ConvertTo(d, dx), set(patch_.unit_m));
    pz = set(dz);
    return true;
  }

  Float clear_at(std::size_t r, std::size_t i, Float base, const LakeAt& lake) const {
    const FloatTag d;
    Float clear = set(1), px, pz;
    for (const Curve* c : chosen_.curves) {
      if (!reaches(*c, r, i, px, pz)) continue;
      const Beside b = beside(*c, px, pz);
      const Float bank = hn::Add(set(kLeveeM), hn::Mul(b.width, set(kBankWidths)));
      const Float s = hn::Min(hn::Max(hn::Div(b.edge, bank), hn::Zero(d)), set(1));
      const Float here = hn::Sub(set(1), hn::Mul(hn::Sub(set(1), s), b.valley));
      clear = hn::IfThenElse(b.near, hn::Min(clear, here), clear);
    }
    const Float dry = hn::Sub(set(1), hn::Min(hn::Add(lake.share, lake.share), set(1)));
    const Float above = hn::Mul(hn::Sub(base, set(patch_.sea_level_m)), set(1.0F / 6));
    const Float land = hn::Min(hn::Max(above, hn::Zero(d)), set(1));
    return hn::Mul(hn::Mul(smooth(clear), dry), land);
  }

  // The water that covers a vector of samples, as a mean over channels. A channel's weight grows
  // without bound towards its middle, so there the water is its own, which never rises downstream;
  // and it vanishes at its edge, so water that touches other water has no step.
  struct Water {
    Float weight, height, flow_x, flow_z, most;
    Int body;
  };
  static void add_channel(const Curve& c, const Beside& b, bool flow, Water& w) {
    const FloatTag d;
    const IntTag di;
    const auto wet = hn::Le(b.edge, hn::Zero(d));
    if (hn::AllFalse(d, wet)) return;
    const Float share = hn::Div(hn::Add(b.distance, b.distance), b.width);
    const Float rho = hn::Min(hn::Mul(share, share), set(1)), inside = hn::Sub(set(1), rho);
    // Beyond its ends a curve leaves the water to the next one.
    const Float own = hn::Mul(hn::Max(b.abeam, set(1e-3F)), hn::Mul(inside, inside));
    const Float k = hn::IfThenElseZero(wet, hn::Div(own, hn::Add(rho, set(1e-6F))));
    w.weight = hn::Add(w.weight, k);
    w.height = hn::Add(w.height, hn::Mul(k, b.surface));
    const auto more = hn::Gt(k, w.most);
    w.most = hn::Max(k, w.most);
    w.body = hn::IfThenElse(hn::RebindMask(di, more),
                            hn::Set(di, static_cast<std::int32_t>(c.body)), w.body);
    if (!flow) return;
    // Discharge over cross-section, fastest in the middle.
    const Float deep = depth_of(b);
    const Float mean = hn::Div(set(2.25F * c.discharge_m3_s), hn::Mul(b.width, deep));
    const Float speed = hn::Mul(hn::Min(mean, set(6)), inside);
    const Float o = hn::Sub(set(1), b.t);
    const Float tx = hn::Add(hn::Mul(o, set(c.turn[0])), hn::Mul(b.t, set(c.turn[2])));
    const Float tz = hn::Add(hn::Mul(o, set(c.turn[1])), hn::Mul(b.t, set(c.turn[3])));
    const Float size = hn::Sqrt(hn::Add(hn::Mul(tx, tx), hn::Mul(tz, tz)));
    const Float scale = hn::Div(hn::Mul(k, speed), hn::Max(size, set(1e-6F)));
    w.flow_x = hn::Add(w.flow_x, hn::Mul(scale, tx));
    w.flow_z = hn::Add(w.flow_z, hn::Mul(scale, tz));
  }
  // Adds a lake or the sea, where `wet`.
  static void add_still(hn::Mask<FloatTag> wet, Float level, Int body, Water& w) {
    const IntTag di;
    const Float k = hn::IfThenElseZero(wet, set(0.25F));
    w.weight = hn::Add(w.weight, k);
    w.height = hn::Add(w.height, hn::Mul(k, level));
    const auto more = hn::Gt(k, w.most);
    w.most = hn::Max(k, w.most);
    w.body = hn::IfThenElse(hn::RebindMask(di, more), body, w.body);
  }

  // One vector of samples. Valleys are lowered first, then banks are raised to the water, so that
  // no valley drains another channel; then all beds are cut, so that no bank dams another bed.
  void carve_vector(std::size_t r, std::size_t i, const CarvedRows& out) {
    const FloatTag d;
    const IntTag di;
    const std::size_t n = std::min(lanes(), samples_.columns - i), at = r * out.stride + i;
    const LakeAt lake = lake_at(r * kRow + i);
    const Float zero = hn::Zero(d), sea_level = set(patch_.sea_level_m);
    const Float base = load_few(out.base_m + r * out.base_stride + i, n);
    Float ground = closed(load_few(out.height_m + at, n), lake);
    const auto inside = hn::Gt(lake.share, set(0.5F));
    const auto sea = hn::AndNot(inside, hn::Lt(base, sea_level));
    const Float basin = smooth(hn::Max(hn::Sub(hn::Add(lake.share, lake.share), set(1)), zero));
    ground = hn::IfThenElse(inside, hn::Sub(ground, hn::Mul(lake.depth, basin)), ground);
    const auto lake_water = hn::And(inside, hn::Lt(ground, lake.level));
    const auto open = hn::Or(sea, lake_water);  // has no banks

    Water w{zero, zero, zero, zero, zero, hn::Zero(di)};
    Float low = ground, bed = set(1e30F), px, pz;
    bool any = false;
    for (const Curve* c : chosen_.curves) {
      if (!reaches(*c, r, i, px, pz)) continue;
      const Beside b = beside(*c, px, pz);
      if (hn::AllFalse(d, b.near)) continue;
      any = true;
      const Bank bank = bank_of(b);
      const Float lowered =
          hn::Add(ground, hn::Mul(hn::Sub(hn::Add(bank.height, bank.rise), ground), bank.force));
      low = hn::IfThenElse(bank.dry, hn::Min(low, lowered), low);
      bed = hn::Min(bed, bed_of(b, ground));
      if (out.water_m != nullptr) add_channel(*c, b, out.flow_x != nullptr, w);
    }
    Float high = low;
    if (any) {
      for (const Curve* c : chosen_.curves) {
        if (!reaches(*c, r, i, px, pz)) continue;
        const Beside b = beside(*c, px, pz);
        const Bank bank = bank_of(b);
        const Float raised =
            hn::Add(low, hn::Mul(hn::Sub(bank.height, low), hn::Mul(bank.levee, bank.levee)));
        high = hn::IfThenElse(bank.dry, hn::Max(high, raised), high);
      }
      high = hn::IfThenElse(open, ground, high);
    }
    ground = hn::Min(high, bed);
    store_few(ground, d, out.height_m + at, n);
    if (out.water_m == nullptr) return;
    const Int lake_body =
        chosen_.lakes.empty() ? hn::Zero(di) : hn::LoadU(di, lakes_->body + r * kRow + i);
    add_still(lake_water, lake.level, lake_body, w);
    const auto alone = hn::Eq(w.weight, zero);
    const auto flooded = hn::And(alone, hn::Lt(ground, sea_level));
    add_still(hn::Or(sea, flooded), sea_level, hn::Set(di, std::int32_t{kSeaBody}), w);
    write_water(w, ground, at, n, out);
  }

  struct Bank {
    Float height, rise, force, levee;
    hn::Mask<FloatTag> dry;  // beside the water, within reach
  };
  static Bank bank_of(const Beside& b) {
    const FloatTag d;
    const Float edge = hn::Max(b.edge, hn::Zero(d));
    const Float widths = hn::Mul(b.width, set(kBankWidths));
    const auto fade = [&](float more, Float grown) HWY_ATTR {
      const Float s = hn::Min(hn::Div(edge, hn::Add(set(more), widths)), set(1));
      return hn::Mul(hn::Mul(hn::Sub(set(1), smooth(s)), grown), b.abeam);
    };
    Bank bank;
    bank.height = hn::Add(b.surface, hn::Mul(set(0.3F), hn::Min(edge, set(1))));
    bank.rise = hn::Mul(set(0.12F), edge);
    bank.force = fade(kValleyM, b.valley);
    bank.levee = fade(kLeveeM, b.taper);
    bank.dry = hn::And(b.near, hn::Gt(b.edge, hn::Zero(d)));
    return bank;
  }
  // The bed under the water; 1e30 beside it. Beds of springs fade in.
  static Float bed_of(const Beside& b, Float ground) {
    const FloatTag d;
    const Float share = hn::Div(hn::Add(b.distance, b.distance), b.width);
    const Float deep = depth_of(b);
    const Float bowl = hn::Mul(deep, hn::Sub(set(1), hn::Mul(share, share)));
    const Float bed = hn::Sub(b.surface, bowl);
    const Float middle = hn::Sub(b.surface, deep);
    const Float begun = hn::Add(ground, hn::Mul(hn::Sub(middle, ground), b.taper));
    const Float tapered = hn::IfThenElse(hn::Lt(b.taper, set(1)), hn::Max(bed, begun), bed);
    return hn::IfThenElse(hn::Le(b.edge, hn::Zero(d)), tapered, set(1e30F));
  }

  static void write_water(const Water& w, Float ground, std::size_t at, std::size_t n,
                          const CarvedRows& out) {
    const FloatTag d;
    const IntTag di;
    const Float weight = hn::Max(w.weight, set(1e-20F));
    const Float surface = hn::Div(w.height, weight);
    const auto wet = hn::And(hn::Gt(w.weight, hn::Zero(d)), hn::Gt(surface, ground));
    store_few(hn::IfThenElse(wet, surface, set(kDry)), d, out.water_m + at, n);
    if (out.flow_x != nullptr) {
      store_few(hn::IfThenElseZero(wet, hn::Div(w.flow_x, weight)), d, out.flow_x + at, n);
      store_few(hn::IfThenElseZero(wet, hn::Div(w.flow_z, weight)), d, out.flow_z + at, n);
    }
    if (out.body != nullptr)
      store_few(hn::IfThenElseZero(hn::RebindMask(di, wet), w.body), di,
                reinterpret_cast<std::int32_t*>(out.body) + at, n);
  }

  const Patch& patch_;
  const Chosen& chosen_;
  bool guided_;
  Axes samples_, guide_;
  std::optional<GuideReader> reader_;
  Scratch<Sums> sums_;
  Scratch<LakeRows> lakes_;
};

void base_on_target(const Patch& patch, const Samples& samples, const Chosen& chosen,
                    const BaseRows& rows) {
  Call(patch, samples, chosen).base(rows);
}
void carve_on_target(const Patch& patch, const Samples& samples, const Chosen& chosen,
                     const CarvedRows& rows) {
  Call(patch, samples, chosen).carve(rows);
}

}  // namespace psygen::models::network::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace psygen::models::network {
namespace {

HWY_EXPORT(base_on_target);
HWY_EXPORT(carve_on_target);

// Chooses what reaches the samples, in the patch's order. More than that would change no bit.
Chosen choose(const Patch& patch, const Samples& samples) {
  Chosen chosen;
  const Box box =
      Box{samples.x.front(), samples.z.front(), samples.x.back(), samples.z.back()}.grown(
          samples.guided ? kGuideReach : 0);
  patch.each_spot(box, [&](const Spot& s) {
    chosen.spots.push_back(&s);
    if (s.lake >= 0) chosen.lakes.push_back(s.lake);
  });
  std::sort(chosen.lakes.begin(), chosen.lakes.end());
  chosen.lakes.erase(std::unique(chosen.lakes.begin(), chosen.lakes.end()), chosen.lakes.end());
  patch.each_curve(box, [&](const Curve& c) { chosen.curves.push_back(&c); });
  return chosen;
}

}  // namespace

void base_rows(const Patch& patch, const Samples& samples, const BaseRows& rows) {
  HWY_DYNAMIC_DISPATCH(base_on_target)(patch, samples, choose(patch, samples), rows);
}
HeightRange range_of(const Patch& patch, const Samples& samples) {
  const Chosen chosen = choose(patch, samples);
  HeightRange range{1e30F, -1e30F};
  for (const Spot* s : chosen.spots) {
    range.lowest_m = std::min(range.lowest_m, s->height_m - s->depth_m);
    range.highest_m = std::max(range.highest_m, s->height_m);
  }
  for (const Curve* c : chosen.curves) {
    const float deep = channel_depth_m(std::max(c->width0_m, c->width1_m));
    range.lowest_m = std::min(range.lowest_m, c->height_m[2] - deep);
    range.highest_m = std::max(range.highest_m, c->height_m[0] + 0.3F);
  }
  // Cubic interpolation leaves the range of its points by up to a quarter.
  if (samples.guided) {
    const float more = 0.25F * (range.highest_m - range.lowest_m);
    return {range.lowest_m - more, range.highest_m + more};
  }
  return range;
}
void carve_rows(const Patch& patch, const Samples& samples, const CarvedRows& rows) {
  HWY_DYNAMIC_DISPATCH(carve_on_target)(patch, samples, choose(patch, samples), rows);
}

}  // namespace psygen::models::network
#endif
