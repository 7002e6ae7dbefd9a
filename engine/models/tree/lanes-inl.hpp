// Arithmetic of trees in SIMD lanes. Highway's foreach_target includes this file once per
// instruction set; hence the unusual include guard. Only additions, multiplications, divisions and
// square roots, each rounded separately and in the same order, so every set computes the same bits.
#if defined(PSYGEN_MODELS_TREE_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_TREE_LANES_INL_HPP
#undef PSYGEN_MODELS_TREE_LANES_INL_HPP
#else
#define PSYGEN_MODELS_TREE_LANES_INL_HPP
#endif

#include <hwy/highway.h>

#include <cstring>

#include "engine/models/kit/mix32-inl.hpp"
#include "engine/models/tree/random.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

// 4, 8 or 16 lanes; 1 without SIMD.
using DF = HWY_CAPPED(float, 16);
using DU = hn::RebindToUnsigned<DF>;
using DI = hn::RebindToSigned<DF>;
using VF = hn::Vec<DF>;
using VU = hn::Vec<DU>;

// A 3-D vector per lane.
struct Vec3 {
  VF x, y, z;
  HWY_INLINE Vec3() {}  // in the kernel's instruction set (docs/models.md#arithmetic)
  HWY_INLINE Vec3(VF to_x, VF to_y, VF to_z) : x(to_x), y(to_y), z(to_z) {}
};

// The same number in every lane.
HWY_INLINE VF f1(float v) {
  return hn::Set(DF(), v);
}
HWY_INLINE VU u1(std::uint32_t v) {
  return hn::Set(DU(), v);
}

// Sums, products by a factor and by component, cross and dot products.
HWY_INLINE Vec3 operator+(Vec3 a, Vec3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE Vec3 operator-(Vec3 a, Vec3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE Vec3 operator*(VF s, Vec3 a) {
  return {s * a.x, s * a.y, s * a.z};
}
HWY_INLINE Vec3 scaled(Vec3 a, Vec3 b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
HWY_INLINE Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HWY_INLINE VF dot(Vec3 a, Vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
// 1 / √x with a relative error below 7e-7, for 1e-30 < x < 1e30 (after Lomont 2003 and Walczyk et
// al. 2018).
HWY_INLINE VF inverse_root(VF x) {
  const VU guess = u1(0x5F1FFFF9U) - hn::ShiftRight<1>(hn::BitCast(DU(), x));
  VF y = hn::BitCast(DF(), guess);
  y = y * f1(0.703952253F) * (f1(2.38924456F) - x * y * y);
  return y * (f1(1.5F) - f1(0.5F) * x * y * y);
}
// `a` scaled to unit length; close to 0 where |a| is far below 1e-10.
HWY_INLINE Vec3 unit(Vec3 a) {
  return inverse_root(dot(a, a) + f1(1e-20F)) * a;
}
// Vectors from three rows at any address, and from three numbers.
HWY_INLINE Vec3 load3(const float* x, const float* y, const float* z) {
  const DF d;
  return {hn::LoadU(d, x), hn::LoadU(d, y), hn::LoadU(d, z)};
}
HWY_INLINE Vec3 set3(const float (&v)[3]) {
  return {f1(v[0]), f1(v[1]), f1(v[2])};
}

// mix32() and number_of() (random.hpp) of every lane.
HWY_INLINE VU mix(VU h) {
  return mix32(DU(), h);
}
HWY_INLINE VU number(VU key, std::uint32_t salt, std::uint32_t i) {
  return mix(key ^ u1(salt + i * kNumberStep));
}
// Integers below 2^31 as floats.
HWY_INLINE VF as_float(VU small) {
  return hn::ConvertTo(DF(), hn::BitCast(DI(), small));
}
// The lower and the upper 16 bits of a hash, 0 … 65535.
HWY_INLINE VF low_number(VU h) {
  return as_float(h & u1(0xFFFFU));
}
HWY_INLINE VF high_number(VU h) {
  return as_float(hn::ShiftRight<16>(h));
}
// The same bits as signed numbers, −32768 … 32767.
HWY_INLINE VF low_signed(VU h) {
  return hn::ConvertTo(DF(), hn::ShiftRight<16>(hn::BitCast(DI(), hn::ShiftLeft<16>(h))));
}
HWY_INLINE VF high_signed(VU h) {
  return hn::ConvertTo(DF(), hn::ShiftRight<16>(hn::BitCast(DI(), h)));
}
// The same bits as fractions in [0, 1): low_fraction() and high_fraction().
HWY_INLINE VF low_part(VU h) {
  return low_number(h) * f1(1.0F / 65536.0F);
}
HWY_INLINE VF high_part(VU h) {
  return high_number(h) * f1(1.0F / 65536.0F);
}

// v rounded to the nearest integer, halves to even, as two's complement in the lower 16 bits.
// Requires |v| < 2^15. The upper bits have no meaning.
HWY_INLINE VU rounded_bits(VF v) {
  return hn::BitCast(DU(), v + f1(12582912.0F));
}
// The same as an unsigned number in all 32 bits. Requires 0 <= v < 2^16.
HWY_INLINE VU rounded_word(VF v) {
  return rounded_bits(v) & u1(0xFFFFU);
}
// `v` limited to [low, high].
HWY_INLINE VF clamped(VF v, float low, float high) {
  return hn::Min(hn::Max(v, f1(low)), f1(high));
}
// [0, 1] as 0 … 255; other values are clamped.
HWY_INLINE VU unorm8(VF v) {
  return rounded_word(clamped(v, 0.0F, 1.0F) * f1(255.0F));
}

// sin(2πx) and cos(2πx) for |x| < 4096. The absolute error is below 4e-7 plus that of x.
HWY_INLINE VF sin_turns(VF x) {
  x = x - ((x + f1(12582912.0F)) - f1(12582912.0F));                   // [-1/2, 1/2]
  const VF folded = hn::Min(hn::Max(x, f1(-0.5F) - x), f1(0.5F) - x);  // [-1/4, 1/4], same sine
  const VF y = folded * f1(6.28318530717958648F);
  const VF z = y * y;
  VF s = f1(1.0F / 362880) - z * f1(1.0F / 39916800);
  s = f1(-1.0F / 5040) + z * s;
  s = f1(1.0F / 120) + z * s;
  s = f1(-1.0F / 6) + z * s;
  return y * (f1(1.0F) + z * s);
}
HWY_INLINE VF cos_turns(VF x) {
  return sin_turns(x + f1(0.25F));
}

// Unit vectors u and v with u × v = d, for the unit vector d. Continuous where d.y keeps its sign
// (after Duff et al. 2017, with y for z).
HWY_INLINE void frame_around(Vec3 d, Vec3& u, Vec3& v) {
  const VF sign = hn::IfThenElse(d.y >= f1(0.0F), f1(1.0F), f1(-1.0F));
  const VF a = f1(-1.0F) / (sign + d.y);
  const VF b = d.z * d.x * a;
  u = {sign * b, hn::Neg(sign * d.z), f1(1.0F) + sign * d.z * d.z * a};
  v = {sign + d.x * d.x * a, hn::Neg(d.x), b};
}

// The octahedral pair of a direction (engine/core/vertex_layout.hpp), snorm16 twice in one word.
// `n` may have any length except zero.
HWY_INLINE VU octahedral(Vec3 n) {
  const VF scale = f1(32767.0F) / (hn::Abs(n.x) + hn::Abs(n.y) + hn::Abs(n.z));
  const auto pair = fold_octahedral(DF(), n.x * scale, n.y, n.z * scale, 32767.0F);
  return (rounded_bits(pair.x) & u1(0xFFFFU)) | hn::ShiftLeft<16>(rounded_bits(pair.z));
}

// Baked ambient visibility in (0, 1], in or below the crown. `r` is the position in units of the
// half axes of the crown's ellipsoid, from its centre. Equals crown_ambient() (mesh.hpp).
HWY_INLINE VF ambient_at(Vec3 r) {
  const VF out = f1(0.3F) + f1(0.7F / 1.44F) * hn::Min(dot(r, r), f1(1.44F));
  return out * clamped(f1(0.8F) + f1(0.2F) * r.y, 0.6F, 1.0F);
}

#if HWY_TARGET != HWY_SCALAR

// The same vectors as 16-bit and 64-bit integers.
using D16 = hn::Repartition<std::int16_t, DU>;
using DU16 = hn::Repartition<std::uint16_t, DU>;
using D64 = hn::Repartition<std::uint64_t, DU>;

// The words (x, y) and (z, upper half of `light`) of vertices; x, y and z are from rounded_bits().
HWY_INLINE VU z_word(VU z, VU light) {
#if HWY_TARGET <= HWY_AVX3
  return hn::IfVecThenElse(u1(0xFFFFU), z, light);
#else
  const DU16 d;
  return hn::BitCast(DU(), hn::OddEven(hn::BitCast(d, light), hn::BitCast(d, z)));
#endif
}
HWY_INLINE VU xy_word(VU x, VU y) {
  return z_word(x, hn::ShiftLeft<16>(y));
}

// Two words of each lane, side by side.
struct Pair {
  VU low, high;
};
// Interleaves two vectors of words within each 128 bits.
HWY_INLINE Pair paired(VU a, VU b) {
  return {hn::InterleaveLower(DU(), a, b), hn::InterleaveUpper(DU(), a, b)};
}

// The vertices of all lanes, four words each: row k has those of the lanes k, 4 + k, 8 + k, …
struct Vertices {
  VU row[4];
};
// Interleaves the lower or the upper 64-bit halves of each 128 bits.
HWY_INLINE VU low_halves(VU a, VU b) {
  return hn::BitCast(DU(),
                     hn::InterleaveLower(D64(), hn::BitCast(D64(), a), hn::BitCast(D64(), b)));
}
HWY_INLINE VU high_halves(VU a, VU b) {
  return hn::BitCast(DU(),
                     hn::InterleaveUpper(D64(), hn::BitCast(D64(), a), hn::BitCast(D64(), b)));
}
// Vertices of their four words.
HWY_INLINE Vertices vertices_of(VU xy, VU z_light, Pair normal_colour) {
  const Pair place = paired(xy, z_light);
  return {{low_halves(place.low, normal_colour.low), high_halves(place.low, normal_colour.low),
           low_halves(place.high, normal_colour.high),
           high_halves(place.high, normal_colour.high)}};
}
// Stores the lanes as numbers `part`, `part` + 1, … of a block of 16. Number i of the block goes to
// place 4 (i mod 4) + i / 4.
HWY_INLINE void store_in_block(const Vertices& v, std::size_t part, std::uint32_t* block) {
  for (std::size_t k = 0; k < 4; ++k)
    hn::StoreU(v.row[k], DU(), block + 16 * k + part);
}
// Stores the first `lanes` vertices, `stride` vertices apart.
HWY_INLINE void store_apart(const Vertices& v, std::size_t lanes, std::size_t stride,
                            std::byte* to) {
  alignas(64) std::uint32_t words[4][16];
  for (std::size_t k = 0; k < 4; ++k)
    hn::Store(v.row[k], DU(), words[k]);
  for (std::size_t i = 0; i < lanes; ++i)
    std::memcpy(to + 16 * stride * i, &words[i % 4][i / 4 * 4], 16);
}

// Smallest and largest packed positions so far, as pairs (x, y) and (z, anything). Undefined before
// clear(). The words are those of xy_word() and z_word().
struct Extent {
  hn::Vec<D16> low_xy, high_xy, low_z, high_z;
  HWY_INLINE Extent() {}
  // Empties it; adds vertices; widens the packed box [low, high] by all of them.
  HWY_INLINE void clear() {
    low_xy = low_z = hn::Set(D16(), 32767);
    high_xy = high_z = hn::Set(D16(), -32767);
  }
  HWY_INLINE void add(VU xy, VU z) {
    low_xy = hn::Min(low_xy, hn::BitCast(D16(), xy));
    high_xy = hn::Max(high_xy, hn::BitCast(D16(), xy));
    low_z = hn::Min(low_z, hn::BitCast(D16(), z));
    high_z = hn::Max(high_z, hn::BitCast(D16(), z));
  }
  HWY_INLINE void widen(std::int16_t (&low)[3], std::int16_t (&high)[3]) const {
    const hn::Vec<hn::Full128<std::int16_t>> rows[4] = {least(low_xy), most(high_xy), least(low_z),
                                                        most(high_z)};
    alignas(16) std::int16_t words[4][8];
    for (std::size_t r = 0; r < 4; ++r)
      hn::Store(rows[r], hn::Full128<std::int16_t>(), words[r]);
    for (std::size_t i = 0; i < 8; i += 2) {
      for (std::size_t c = 0; c < 3; ++c) {
        low[c] = std::min(low[c], c < 2 ? words[0][i + c] : words[2][i]);
        high[c] = std::max(high[c], c < 2 ? words[1][i + c] : words[3][i]);
      }
    }
  }

 private:
  // Folds all blocks of 128 bits to one.
  template <class Fold>
  static HWY_INLINE hn::Vec<hn::Full128<std::int16_t>> folded(hn::Vec<D16> v, const Fold& fold) {
    const hn::Full128<std::int16_t> d;
    alignas(64) std::int16_t words[hn::MaxLanes(D16())];
    hn::Store(v, D16(), words);
    auto result = hn::Load(d, words);
    for (std::size_t i = 8; i < hn::Lanes(D16()); i += 8)
      result = fold(result, hn::Load(d, words + i));
    return result;
  }
  static HWY_INLINE hn::Vec<hn::Full128<std::int16_t>> least(hn::Vec<D16> v) {
    return folded(v, [](auto a, auto b) { return hn::Min(a, b); });
  }
  static HWY_INLINE hn::Vec<hn::Full128<std::int16_t>> most(hn::Vec<D16> v) {
    return folded(v, [](auto a, auto b) { return hn::Max(a, b); });
  }
};

#else  // one lane

// The types and functions above, without vectors.
HWY_INLINE VU xy_word(VU x, VU y) {
  return (x & u1(0xFFFFU)) | hn::ShiftLeft<16>(y);
}
HWY_INLINE VU z_word(VU z, VU light) {
  return (z & u1(0xFFFFU)) | (light & u1(0xFFFF0000U));
}

// Two words of the lane.
struct Pair {
  VU low, high;
};
HWY_INLINE Pair paired(VU a, VU b) {
  return {a, b};
}

// The vertex of the lane, four words.
struct Vertices {
  std::uint32_t words[4];
};
HWY_INLINE Vertices vertices_of(VU xy, VU z_light, Pair normal_colour) {
  return {{hn::GetLane(xy), hn::GetLane(z_light), hn::GetLane(normal_colour.low),
           hn::GetLane(normal_colour.high)}};
}
HWY_INLINE void store_in_block(const Vertices& v, std::size_t part, std::uint32_t* block) {
  std::memcpy(block + 4 * (4 * (part % 4) + part / 4), v.words, 16);
}
HWY_INLINE void store_apart(const Vertices& v, std::size_t, std::size_t, std::byte* to) {
  std::memcpy(to, v.words, 16);
}

// Smallest and largest packed positions so far. Undefined before clear().
struct Extent {
  std::int16_t least[3], most[3];
  HWY_INLINE void clear() {
    for (std::size_t c = 0; c < 3; ++c) {
      least[c] = 32767;
      most[c] = -32767;
    }
  }
  HWY_INLINE void add(VU xy, VU z) {
    const std::uint32_t words[3] = {hn::GetLane(xy), hn::GetLane(xy) >> 16, hn::GetLane(z)};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto v = static_cast<std::int16_t>(words[c] & 0xFFFFU);
      least[c] = std::min(least[c], v);
      most[c] = std::max(most[c], v);
    }
  }
  HWY_INLINE void widen(std::int16_t (&low)[3], std::int16_t (&high)[3]) const {
    for (std::size_t c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], least[c]);
      high[c] = std::max(high[c], most[c]);
    }
  }
};

#endif

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
