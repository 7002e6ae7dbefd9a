// SIMD primitives of the rock kernel: items of four floats gathered into separate vectors, and
// numbers rounded into the words of a vertex. The kernel includes it after foreach_target.h and
// before its own namespace, once per instruction set; hence the unusual include guard.
#if defined(PSYGEN_MODELS_ROCK_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_ROCK_LANES_INL
#undef PSYGEN_MODELS_ROCK_LANES_INL
#else
#define PSYGEN_MODELS_ROCK_LANES_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "engine/models/kit/mix32-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

// As many unsigned words as D has floats.
template <class D>
using Uint = hn::Vec<hn::RebindToUnsigned<D>>;

// ---- Items -------------------------------------------------------------------------------------

// Items of as many vertices as D has lanes. Block b of rows[r] is the item of lane 4b + r. On the
// scalar target rows[r] is component r of the only item.
template <class D>
struct Items {
  hn::Vec<D> rows[4];
  HWY_INLINE Items() {}  // in the kernel's instruction set (docs/models.md#arithmetic)
};

// The items as one vector per component.
template <class D>
struct Vectors {
  hn::Vec<D> x, y, z, w;
  HWY_INLINE Vectors() {}
  HWY_INLINE Vectors(hn::Vec<D> to_x, hn::Vec<D> to_y, hn::Vec<D> to_z, hn::Vec<D> to_w)
      : x(to_x), y(to_y), z(to_z), w(to_w) {}
};

// Loads the item at `base` + offsets[lane] for each lane. Offsets count floats.
template <class D>
HWY_INLINE Items<D> load_items(D d, const float* base, const std::uint16_t* offsets) {
  Items<D> items;
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t r = 0; r < 4; ++r)
    items.rows[r] = hn::Load(d, base + offsets[0] + r);
#else
  for (std::size_t r = 0; r < 4; ++r) {
    const hn::FixedTag<float, 4> d4;
    const auto item = [&](std::size_t lane)
                          HWY_ATTR { return hn::Load(d4, base + offsets[lane + r]); };
    if constexpr (hn::MaxLanes(D()) == 4) {
      items.rows[r] = item(0);
    } else if constexpr (hn::MaxLanes(D()) == 8) {
      items.rows[r] = hn::Combine(d, item(4), item(0));
    } else {
      const hn::Half<D> half;
      items.rows[r] =
          hn::Combine(d, hn::Combine(half, item(12), item(8)), hn::Combine(half, item(4), item(0)));
    }
  }
#endif
  return items;
}

// a + b
template <class D>
HWY_INLINE Items<D> add(const Items<D>& a, const Items<D>& b) {
  Items<D> sum;
  for (std::size_t r = 0; r < 4; ++r)
    sum.rows[r] = hn::Add(a.rows[r], b.rows[r]);
  return sum;
}

// Transposes items to components.
template <class D>
HWY_INLINE Vectors<D> to_lanes(D d, const Items<D>& items) {
  const auto& r = items.rows;
#if HWY_TARGET == HWY_SCALAR
  (void)d;
  return {r[0], r[1], r[2], r[3]};
#else
  const auto even_xy = hn::InterleaveLower(d, r[0], r[2]);
  const auto odd_xy = hn::InterleaveLower(d, r[1], r[3]);
  const auto even_zw = hn::InterleaveUpper(d, r[0], r[2]);
  const auto odd_zw = hn::InterleaveUpper(d, r[1], r[3]);
  return {hn::InterleaveLower(d, even_xy, odd_xy), hn::InterleaveUpper(d, even_xy, odd_xy),
          hn::InterleaveLower(d, even_zw, odd_zw), hn::InterleaveUpper(d, even_zw, odd_zw)};
#endif
}

// a − b, transposed.
template <class D>
HWY_INLINE Vectors<D> difference(D d, const Items<D>& a, const Items<D>& b) {
  Items<D> items;
  for (std::size_t r = 0; r < 4; ++r)
    items.rows[r] = hn::Sub(a.rows[r], b.rows[r]);
  return to_lanes(d, items);
}

// ---- Vectors -----------------------------------------------------------------------------------

// Products and differences of x, y and z. They ignore the fourth component; results have 0 there.
template <class D>
HWY_INLINE hn::Vec<D> dot(const Vectors<D>& a, const Vectors<D>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
template <class D>
HWY_INLINE Vectors<D> minus(const Vectors<D>& a, const Vectors<D>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z), hn::Zero(D())};
}
template <class D>
HWY_INLINE Vectors<D> cross(const Vectors<D>& a, const Vectors<D>& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x)), hn::Zero(D())};
}

// ---- Words -------------------------------------------------------------------------------------

// `v` limited to [low, high].
template <class D>
HWY_INLINE hn::Vec<D> clamp(D d, hn::Vec<D> v, float low, float high) {
  return hn::Min(hn::Max(v, hn::Set(d, low)), hn::Set(d, high));
}
// The nearest integer, halves to even, as in kit/packing.hpp, plus kRounding. The lower 16 bits of
// kRounding are 0.
inline constexpr std::uint32_t kRounding = 0x4B400000U;
template <class D>
HWY_INLINE Uint<D> rounded(D d, hn::Vec<D> v) {
  return hn::BitCast(hn::RebindToUnsigned<D>(), hn::Add(v, hn::Set(d, 12582912.0F)));
}
// The lower halves of two words as one word.
template <class D>
HWY_INLINE Uint<D> pair(D, Uint<D> low, Uint<D> high) {
#if HWY_TARGET == HWY_SCALAR
  const hn::RebindToUnsigned<D> du;
  return hn::Or(hn::And(low, hn::Set(du, 0xFFFFU)), hn::ShiftLeft<16>(high));
#else
  const hn::Repartition<std::uint16_t, D> halves;
  return hn::BitCast(
      hn::RebindToUnsigned<D>(),
      hn::OddEven(hn::BitCast(halves, hn::ShiftLeft<16>(high)), hn::BitCast(halves, low)));
#endif
}

// Octahedral normal around +Y, snorm16 twice (kit/packing.hpp). `scale` is 1 / (|x| + |y| + |z|).
template <class D>
HWY_INLINE Uint<D> octahedral(D d, const Vectors<D>& n, hn::Vec<D> scale) {
  const auto zero = hn::Zero(d);  // adding it turns −0 into 0
  const auto p = fold_octahedral(d, hn::Mul(hn::Add(n.x, zero), scale), n.y,
                                 hn::Mul(hn::Add(n.z, zero), scale), 1.0F);
  // In [−1, 1] up to a rounding error that cannot reach the next integer.
  const auto to_snorm = hn::Set(d, 32767.0F);
  return pair(d, rounded(d, hn::Mul(p.x, to_snorm)), rounded(d, hn::Mul(p.z, to_snorm)));
}
// 1 / (|x| + |y| + |z|), which octahedral() needs.
template <class D>
HWY_INLINE hn::Vec<D> octahedral_scale(D d, const Vectors<D>& n) {
  return hn::Div(hn::Set(d, 1.0F), hn::Add(hn::Add(hn::Abs(n.x), hn::Abs(n.y)), hn::Abs(n.z)));
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
