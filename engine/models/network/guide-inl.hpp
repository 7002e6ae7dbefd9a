// Sums over the kernels of spots at the points of a grid, and the guide: a grid of which the ground
// is interpolated. Spots are few per call, so each spot runs over rows of points, in the order of
// the lattice. Points outside its reach gain +0, which changes no bit. Only the kernel includes it,
// once per instruction set; hence the unusual include guard.
#if defined(PSYGEN_MODELS_NETWORK_GUIDE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_NETWORK_GUIDE_INL
#undef PSYGEN_MODELS_NETWORK_GUIDE_INL
#else
#define PSYGEN_MODELS_NETWORK_GUIDE_INL
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "engine/models/kit/vectors-inl.hpp"
#include "engine/models/network/kernel.hpp"
#include "engine/models/network/patch.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::network::HWY_NAMESPACE {

using namespace models::HWY_NAMESPACE;  // the vectors

// Points of the guide along an axis, and floats of a row of any grid.
constexpr std::size_t kMaxGuide = 48, kRow = 96;

// Points of a grid, in units. Columns are padded with the last one to whole vectors.
struct Axes {
  HWY_ALIGN std::int32_t x[kRow];
  std::int32_t z[kMaxSamples];
  std::size_t columns = 0, rows = 0;

  // Repeats the last column.
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

// The sums that add_spot() adds to: heights, these and their gradient, or those of lakes.
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

// Adds a spot to the sums at all points of a grid.
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

}  // namespace psygen::models::network::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
