// Positions of the samples of a call on the lattices of ridged noise, along one axis: exact
// positions, and the cells, fractions and fades that follow from them. Only ridged_kernel.cpp
// includes it, once per instruction set; hence the unusual include guard.
#if defined(PSYGEN_MODELS_RIDGED_AXIS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_RIDGED_AXIS_INL
#undef PSYGEN_MODELS_RIDGED_AXIS_INL
#else
#define PSYGEN_MODELS_RIDGED_AXIS_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Largest number of lanes. Octaves of a row are padded to it.
constexpr std::size_t kPad = 16;
using FloatTag = hn::CappedTag<float, kPad>;
using IntTag = hn::RebindToSigned<FloatTag>;
using UintTag = hn::RebindToUnsigned<FloatTag>;
using Float = hn::Vec<FloatTag>;

// `n` rounded up to whole vectors, the size of arrays over columns.
HWY_INLINE std::size_t padded(std::size_t n) {
  const std::size_t lanes = hn::Lanes(FloatTag());
  return (n + lanes - 1) / lanes * lanes;
}

// The integers of an axis; `even` is true if all neighbours have the same distance.
struct Axis {
  std::span<const std::int64_t> at;
  bool even = true;            // all distances are `distance`
  std::uint64_t distance = 1;  // between the first two

  // `integers` has at least one element and must outlive the axis.
  explicit Axis(std::span<const std::int64_t> integers) : at(integers) {
    if (at.size() > 1) distance = difference(1);
    std::uint64_t odd = 0;
    for (std::size_t i = 1; i < at.size(); ++i)
      odd |= difference(i) ^ distance;
    even = odd == 0;
  }
  // at[i] − at[i − 1], modulo 2^64. 1 <= i < at.size().
  std::uint64_t difference(std::size_t i) const {
    return static_cast<std::uint64_t>(at[i]) - static_cast<std::uint64_t>(at[i - 1]);
  }
  // True if each integer lies in the lattice cell of the previous one or in the next cell. `step`
  // is Q32.32 cells per integer.
  bool contiguous(std::uint64_t step) const {
    constexpr std::uint64_t kCell = std::uint64_t{1} << 32;
    return even && distance * step <= kCell && distance <= kCell && step <= kCell;
  }

  // 0, `of`, 2 · `of`, … Sums multiples for the bits of each lane's number: few instruction sets
  // multiply 64 bits, and a vector load stalls on memory that scalar stores have just written.
  template <class D>
  static HWY_INLINE hn::Vec<D> multiples(D d, std::uint64_t of) {
    const auto lane = hn::Iota(d, 0);
    auto sum = hn::Zero(d);
    for (std::uint64_t bit = 1; bit < hn::MaxLanes(d); bit *= 2) {
      const auto mask = hn::TestBit(lane, hn::Set(d, bit));
      sum = hn::Add(sum, hn::IfThenElseZero(mask, hn::Set(d, bit * of)));
    }
    return sum;
  }

  // Writes the Q32.32 positions on a lattice with this step and origin, padded to whole vectors.
  void place(std::uint64_t step, std::uint64_t origin, std::uint64_t* HWY_RESTRICT position) const {
    const std::size_t count = at.size();
    if (!even) {
      for (std::size_t i = 0; i < count; ++i)
        position[i] = static_cast<std::uint64_t>(at[i]) * step + origin;
      std::fill(position + count, position + padded(count), position[count - 1]);
      return;
    }
    const hn::CappedTag<std::uint64_t, kPad / 2> d;  // no more lanes than floats
    const std::size_t lanes = hn::Lanes(d);
    const auto advance = hn::Set(d, lanes * distance * step);
    auto now = hn::Add(hn::Set(d, static_cast<std::uint64_t>(at[0]) * step + origin),
                       multiples(d, distance * step));
    for (std::size_t i = 0, width = padded(count); i < width; i += lanes) {
      hn::Store(now, d, position + i);
      now = hn::Add(now, advance);
    }
  }
};

// Splits Q32.32 positions into cells, fractions in [0, 1) of 24 bits, and fades
// (6 f^5 − 15 f^4 + 10 f^3). All arrays are aligned and padded.
void locate(const std::uint64_t* HWY_RESTRICT position, std::size_t count,
            std::uint32_t* HWY_RESTRICT cell, float* HWY_RESTRICT fraction,
            float* HWY_RESTRICT fade) {
  const FloatTag d;
  const IntTag di;
  const UintTag du;
  const Float unit = hn::Set(d, 0x1.0p-24F), six = hn::Set(d, 6.0F), ten = hn::Set(d, 10.0F),
              fifteen = hn::Set(d, 15.0F);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    hn::Vec<UintTag> low, high;
    hn::LoadInterleaved2(du, reinterpret_cast<const std::uint32_t*>(position + i), low, high);
    hn::Store(high, du, cell + i);
    const Float f = hn::Mul(hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<8>(low))), unit);
    hn::Store(f, d, fraction + i);
    const Float cube = hn::Mul(hn::Mul(f, f), f);
    const Float inner = hn::Add(hn::Mul(f, hn::Sub(hn::Mul(f, six), fifteen)), ten);
    hn::Store(hn::Mul(cube, inner), d, fade + i);
  }
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
