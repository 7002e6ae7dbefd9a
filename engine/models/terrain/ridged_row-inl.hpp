// Rows of samples of ridged noise, with all octaves of a row in registers. Only ridged_kernel.cpp
// includes it, once per instruction set; hence the unusual include guard.
#if defined(PSYGEN_MODELS_RIDGED_ROW_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_RIDGED_ROW_INL
#undef PSYGEN_MODELS_RIDGED_ROW_INL
#else
#define PSYGEN_MODELS_RIDGED_ROW_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#include "engine/models/terrain/ridged_lattice-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

// Adds an octave's ridges, squared, to the sums, and finds the weights of the next octave.
template <class V>
HWY_INLINE void add_octave(V square, V limit, V& weight, V& sum) {
  const V signal = hn::Mul(weight, square);
  sum = hn::Add(sum, signal);
  weight = hn::Min(signal, limit);
}

// The square of a ridge. `value` and `slope` are those of the noise on the lower lattice row;
// `value_rise` and `slope_rise` lead to the upper row; `f` and `fade` are the position between
// them.
template <class V>
HWY_INLINE V square_of(V value, V slope, V value_rise, V slope_rise, V f, V fade, V offset) {
  const V low = hn::Add(value, hn::Mul(f, slope));
  const V more = hn::Add(value_rise, hn::Mul(f, slope_rise));
  const V noise = hn::Add(low, hn::Mul(fade, more));
  const V ridge = hn::Sub(offset, hn::Abs(noise));
  return hn::Mul(ridge, ridge);
}

// The position of one row between two lattice rows of each octave, kMaxNoiseAxis elements apart.
struct RowPlace {
  const float *fraction, *fade;
};

// Settings that all rows share.
struct RowSettings {
  const float* next_limit;  // of each octave: largest weight of the next one
  std::size_t octave_count;
  float offset, scale;
};

// Computes one row of samples.
struct RowKernel {
  const ColumnOctave* columns;
  RowSettings settings;
  RowPlace row;

  // The squares of octave o's ridges, for the columns that are `at` elements into the pairs of
  // vectors (ColumnOctave).
  template <class D, class V = hn::Vec<D>>
  HWY_INLINE V square(D d, std::size_t o, std::size_t at, V f, V fade, V offset) const {
    const float *const lower = columns[o].lower + at, *const rise = columns[o].rise + at;
    const std::size_t second = hn::Lanes(FloatTag());
    return square_of(hn::Load(d, lower), hn::Load(d, lower + second), hn::Load(d, rise),
                     hn::Load(d, rise + second), f, fade, offset);
  }

  // One vector of samples from column i on. D may have fewer lanes than the kernel's vectors.
  template <class D>
  HWY_INLINE hn::Vec<D> one(D d, std::size_t i) const {
    const RowSettings& s = settings;
    const std::size_t at = 2 * i - i % hn::Lanes(FloatTag());
    auto weight = hn::Set(d, 1.0F), sum = hn::Zero(d);
    for (std::size_t o = 0; o < s.octave_count; ++o)
      add_octave(square(d, o, at, hn::Set(d, row.fraction[o * kMaxNoiseAxis]),
                        hn::Set(d, row.fade[o * kMaxNoiseAxis]), hn::Set(d, s.offset)),
                 hn::Set(d, s.next_limit[o]), weight, sum);
    return hn::Mul(sum, hn::Set(d, s.scale));
  }

  // Four vectors at once. They share the row's numbers and hide each other's latency.
  HWY_INLINE void four(std::size_t i, float* HWY_RESTRICT out) const {
    const FloatTag d;
    const RowSettings& s = settings;
    const std::size_t n = hn::Lanes(d);
    const Float offset = hn::Set(d, s.offset), scale = hn::Set(d, s.scale);
    Float weight0 = hn::Set(d, 1.0F), weight1 = weight0, weight2 = weight0, weight3 = weight0;
    Float sum0 = hn::Zero(d), sum1 = sum0, sum2 = sum0, sum3 = sum0;
    const std::size_t at = 2 * i;
    for (std::size_t o = 0; o < s.octave_count; ++o) {
      const Float f = hn::Set(d, row.fraction[o * kMaxNoiseAxis]),
                  u = hn::Set(d, row.fade[o * kMaxNoiseAxis]), limit = hn::Set(d, s.next_limit[o]);
      add_octave(square(d, o, at, f, u, offset), limit, weight0, sum0);
      add_octave(square(d, o, at + 2 * n, f, u, offset), limit, weight1, sum1);
      add_octave(square(d, o, at + 4 * n, f, u, offset), limit, weight2, sum2);
      add_octave(square(d, o, at + 6 * n, f, u, offset), limit, weight3, sum3);
    }
    hn::StoreU(hn::Mul(sum0, scale), d, out + i);
    hn::StoreU(hn::Mul(sum1, scale), d, out + i + n);
    hn::StoreU(hn::Mul(sum2, scale), d, out + i + 2 * n);
    hn::StoreU(hn::Mul(sum3, scale), d, out + i + 3 * n);
  }

  // Writes `count` samples to `out`, which needs no alignment.
  void run(std::size_t count, float* HWY_RESTRICT out) const {
    const FloatTag d;
    const hn::CappedTag<float, 4> few;
    const std::size_t n = hn::Lanes(d), few_lanes = hn::Lanes(few);
    std::size_t i = 0;
    for (; i + 4 * n <= count; i += 4 * n)
      four(i, out);
    for (; i + n <= count; i += n)
      hn::StoreU(one(d, i), d, out + i);
    if (count - i > n / 2) return hn::BlendedStore(one(d, i), hn::FirstN(d, count - i), d, out + i);
    for (; i < count; i += few_lanes)
      hn::BlendedStore(one(few, i), hn::FirstN(few, std::min(few_lanes, count - i)), few, out + i);
  }
};

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
