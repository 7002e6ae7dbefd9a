// Rows of samples of ridged noise: all octaves of a row in registers. Included once per instruction
// set, by ridged_kernel.cpp only; hence its include guard.
#if defined(PSYGEN_MODELS_RIDGED_ROW_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_RIDGED_ROW_INL
#undef PSYGEN_MODELS_RIDGED_ROW_INL
#else
#define PSYGEN_MODELS_RIDGED_ROW_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#include "engine/models/ridged_lattice-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

// Adds an octave to the sums.
template <class V>
HWY_INLINE void add_octave(V square, V limit, V& weight, V& sum) {
  const V signal = hn::Mul(weight, square);
  sum = hn::Add(sum, signal);
  weight = hn::Min(signal, limit);
}

// Of one row: where it lies between two lattice rows of each octave.
struct RowPlace {
  const float *fraction, *fade;
};

// What is the same in all rows.
struct RowSettings {
  const float* next_limit;  // of each octave
  std::size_t octave_count;
  float offset, scale;
};

// The lowest four lanes, or all where there are fewer; no instruction, unlike setting them anew.
template <class V>
HWY_INLINE auto low_lanes(V v) {
  if constexpr (hn::MaxLanes(hn::DFromV<V>()) <= 4)
    return v;
  else
    return low_lanes(hn::LowerHalf(v));
}

// The sums of one row of samples.
struct RowKernel {
  const ColumnOctave* columns;
  RowSettings settings;
  RowPlace row;

  // The squares of an octave's ridges, of the columns `at` elements into the pairs of vectors
  // (ColumnOctave).
  template <class D, class V = hn::Vec<D>>
  HWY_INLINE V square(D d, std::size_t o, std::size_t at, V f, V fade, V offset) const {
    const float *const lower = columns[o].lower + at, *const rise = columns[o].rise + at;
    const std::size_t second = hn::Lanes(FloatTag());
    const V low = hn::Add(hn::Load(d, lower), hn::Mul(f, hn::Load(d, lower + second)));
    const V more = hn::Add(hn::Load(d, rise), hn::Mul(f, hn::Load(d, rise + second)));
    const V noise = hn::Add(low, hn::Mul(fade, more));
    const V ridge = hn::Sub(offset, hn::Abs(noise));
    return hn::Mul(ridge, ridge);
  }

  // One vector from column i on; with fewer lanes than the kernel's vectors where D has fewer.
  template <class D>
  HWY_INLINE hn::Vec<D> one(D d, std::size_t i) const {
    const RowSettings& s = settings;
    const std::size_t at = 2 * i - i % hn::Lanes(FloatTag());
    auto weight = hn::Set(d, 1.0F), sum = hn::Zero(d);
    for (std::size_t o = 0; o < s.octave_count; ++o)
      add_octave(square(d, o, at, hn::Set(d, row.fraction[o]), hn::Set(d, row.fade[o]),
                        hn::Set(d, s.offset)),
                 hn::Set(d, s.next_limit[o]), weight, sum);
    return hn::Mul(sum, hn::Set(d, s.scale));
  }

  // Four vectors at once, which share the row's numbers and hide each other's latency, and
  // `rest` <= 4 further samples where kRest.
  template <bool kRest>
  HWY_INLINE void four(std::size_t i, std::size_t rest, float* HWY_RESTRICT out) const {
    const FloatTag d;
    const hn::CappedTag<float, 4> few;
    const RowSettings& s = settings;
    const std::size_t n = hn::Lanes(d);
    const Float offset = hn::Set(d, s.offset), scale = hn::Set(d, s.scale);
    Float weight0 = hn::Set(d, 1.0F), weight1 = weight0, weight2 = weight0, weight3 = weight0;
    Float sum0 = hn::Zero(d), sum1 = sum0, sum2 = sum0, sum3 = sum0;
    auto weight4 = hn::Set(few, 1.0F), sum4 = hn::Zero(few);
    for (std::size_t o = 0; o < s.octave_count; ++o) {
      const Float f = hn::Set(d, row.fraction[o]), u = hn::Set(d, row.fade[o]),
                  limit = hn::Set(d, s.next_limit[o]);
      const std::size_t at = 2 * i;
      add_octave(square(d, o, at, f, u, offset), limit, weight0, sum0);
      add_octave(square(d, o, at + 2 * n, f, u, offset), limit, weight1, sum1);
      add_octave(square(d, o, at + 4 * n, f, u, offset), limit, weight2, sum2);
      add_octave(square(d, o, at + 6 * n, f, u, offset), limit, weight3, sum3);
      if constexpr (kRest)
        add_octave(square(few, o, at + 8 * n, low_lanes(f), low_lanes(u), low_lanes(offset)),
                   low_lanes(limit), weight4, sum4);
    }
    hn::StoreU(hn::Mul(sum0, scale), d, out + i);
    hn::StoreU(hn::Mul(sum1, scale), d, out + i + n);
    hn::StoreU(hn::Mul(sum2, scale), d, out + i + 2 * n);
    hn::StoreU(hn::Mul(sum3, scale), d, out + i + 3 * n);
    if constexpr (kRest)
      hn::BlendedStore(hn::Mul(sum4, low_lanes(scale)), hn::FirstN(few, rest), few,
                       out + i + 4 * n);
  }

  void run(std::size_t count, float* HWY_RESTRICT out) const {
    const FloatTag d;
    const hn::CappedTag<float, 4> few;
    const std::size_t n = hn::Lanes(d), few_lanes = hn::Lanes(few);
    std::size_t i = 0;
    for (; i + 4 * n <= count; i += 4 * n) {
      const std::size_t rest = count - i - 4 * n;
      if (rest > 0 && rest <= few_lanes) return four<true>(i, rest, out);
      four<false>(i, 0, out);
    }
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
