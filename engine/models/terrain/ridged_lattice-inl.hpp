// The lattices of ridged noise under the samples of a call: exact positions of samples along an
// axis with their cells, fractions and fades; values and gradients of lattice points, and their
// blending along one lattice row. Only ridged_kernel.cpp includes it, once per instruction set;
// hence the unusual include guard.
#if defined(PSYGEN_MODELS_RIDGED_LATTICE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_RIDGED_LATTICE_INL
#undef PSYGEN_MODELS_RIDGED_LATTICE_INL
#else
#define PSYGEN_MODELS_RIDGED_LATTICE_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/models/kit/mix32-inl.hpp"
#include "engine/models/kit/mix32.hpp"
#include "engine/models/terrain/ridged_kernel.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

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

// Writes `count` zeros, rounded up to whole vectors, to aligned memory.
HWY_INLINE void clear_vectors(float* to, std::size_t count) {
  const FloatTag d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d))
    hn::Store(hn::Zero(d), d, to + i);
}

// The lattice lines of an octave around the samples of an axis, as keys before mixing. The line
// before sample i has the key first[start of its block] + slot[i]; slot[i] is less than the lanes
// of a vector. The line behind it is `to_next` keys further on. A block is a vector of samples.
struct LatticeLines {
  // The layout of a block's keys in vectors.
  enum class Fit {
    kOneVector,   // all keys lie in one vector, all blocks start at 0
    kEachVector,  // the keys before and behind the samples of a block lie in one vector
    kNone
  };
  std::uint32_t* key;
  std::size_t key_count, to_next;
  std::uint32_t* first;
  std::int32_t* slot;
  Fit fit;

  // Fills everything from the cells of `width` samples, padded to whole vectors.
  void place(const std::uint32_t* HWY_RESTRICT cell, std::size_t width, bool contiguous,
             std::uint32_t key_offset) {
    const UintTag du;
    const IntTag di;
    const std::size_t lanes = hn::Lanes(du);
    key_count = contiguous ? cell[width - 1] - cell[0] + 2 : 2 * width;
    to_next = contiguous ? 1 : width;
    const bool one_vector = contiguous && key_count <= lanes;
    std::uint32_t most = 0;  // lattice lines that a block of samples passes
    for (std::size_t i = 0; contiguous && i < key_count; i += lanes)
      hn::Store(counting_from(du, cell[0] + key_offset + static_cast<std::uint32_t>(i)), du,
                key + i);
    for (std::size_t i = 0; i < width; i += lanes) {
      const auto cells = hn::Load(du, cell + i);
      const std::uint32_t start = one_vector ? cell[0] : cell[i];
      most = std::max(most, cell[i + lanes - 1] - cell[i]);
      first[i] = contiguous ? start - cell[0] : static_cast<std::uint32_t>(i);
      const auto slots =
          contiguous ? hn::BitCast(di, hn::Sub(cells, hn::Set(du, start))) : hn::Iota(di, 0);
      hn::Store(slots, di, slot + i);
      if (contiguous) continue;
      hn::Store(hn::Add(cells, hn::Set(du, key_offset)), du, key + i);
      hn::Store(hn::Add(cells, hn::Set(du, key_offset + 1)), du, key + width + i);
    }
    fit = one_vector                        ? Fit::kOneVector
          : contiguous && most + 2 <= lanes ? Fit::kEachVector
                                            : Fit::kNone;
  }
};

// One octave on the columns of a call. Arrays have `stride` elements, or 2 · `stride` for pairs.
struct ColumnOctave {
  std::size_t stride;
  // Weights along x, of each column: of the gradients' x on the left and on the right, and of the
  // values and the gradients' z on the right.
  float *left_x, *right_x, *fade;
  LatticeLines lines;
  // The lower and the upper lattice row, blended along x (Blend): pairs of vectors, one of values
  // and one of slopes. A pair lies in one cache line, in different banks.
  float *lower, *upper;
  float* rise;                // c and d of ridged_kernel.cpp, in such pairs
  std::uint32_t lattice_row;  // number of the lower row

  // Sets the lower row and the rise to 0.
  void clear() const {
    clear_vectors(lower, 2 * stride);
    clear_vectors(rise, 2 * stride);
  }
};

// The value and the gradient of a lattice point.
struct LatticePoint {
  Float value, x, z;
};
// The lattice point of a hash. The value is uniform in ± length / 2. The gradient lies t quarter
// turns from the x axis, with t uniform in [−1, 1], and one more bit mirrors it at the z axis. Sine
// and cosine of quarter turns are polynomials (docs/models.md), so gradients have `length` up to
// one part in a thousand.
HWY_INLINE LatticePoint lattice_point(hn::Vec<UintTag> key, hn::Vec<UintTag> row_hash,
                                      Float length) {
  const FloatTag d;
  const IntTag di;
  const auto h = mix32(UintTag(), hn::Xor(key, row_hash));
  const Float t = hn::Mul(hn::ConvertTo(d, hn::BitCast(di, h)), hn::Set(d, 0x1.0p-31F));
  const Float y = hn::Mul(t, t);
  Float sine = hn::Set(d, 0.07186F), cosine = hn::Set(d, 0.224F);
  for (const float c : {-0.64211F, 1.57032F})
    sine = hn::Add(hn::Mul(sine, y), hn::Set(d, c));
  for (const float c : {-1.2228F, 0.9994F})
    cosine = hn::Add(hn::Mul(cosine, y), hn::Set(d, c));
  const Float mirrored = hn::Xor(length, hn::BitCast(d, hn::ShiftLeft<31>(h)));
  const Float signed_byte = hn::ConvertTo(d, hn::BitCast(di, hn::ShiftLeft<24>(h)));
  return {hn::Mul(signed_byte, hn::Mul(length, hn::Set(d, 0x1.0p-32F))), hn::Mul(cosine, mirrored),
          hn::Mul(hn::Mul(sine, t), length)};
}

// The points along one lattice row of an octave.
struct LatticeRow {
  HWY_ALIGN float value[2 * kMaxNoiseAxis + 3 * kPad];
  HWY_ALIGN float x[2 * kMaxNoiseAxis + 3 * kPad];
  HWY_ALIGN float z[2 * kMaxNoiseAxis + 3 * kPad];
  std::uint32_t key;  // of the lattice row
  bool filled = false;

  // Fills it with the points of a lattice row, unless it holds them already.
  void hold(const ColumnOctave& column, std::uint32_t row_key, float amplitude) {
    if (filled && key == row_key) return;
    fill(column, row_key, amplitude);
    key = row_key;
    filled = true;
  }

 private:
  void fill(const ColumnOctave& column, std::uint32_t row_key, float amplitude) {
    const FloatTag d;
    const UintTag du;
    const auto row_hash = hn::Set(du, models::mix32(row_key));
    const Float length = hn::Set(d, amplitude);
    for (std::size_t i = 0; i < column.lines.key_count; i += hn::Lanes(d)) {
      const LatticePoint p = lattice_point(hn::Load(du, column.lines.key + i), row_hash, length);
      hn::Store(p.value, d, value + i);
      hn::Store(p.x, d, x + i);
      hn::Store(p.z, d, z + i);
    }
  }
};

// Noise on a lattice row, blended along x: its value and its slope along z.
struct Blend {
  Float value, slope;
};
// Blends two neighbouring lattice points. `left_x`, `right_x` and `fade` as in ColumnOctave.
HWY_INLINE Blend blend(const LatticePoint& left, const LatticePoint& right, Float left_x,
                       Float right_x, Float fade) {
  const Float value = hn::Add(left.value, hn::Mul(fade, hn::Sub(right.value, left.value)));
  return {hn::Add(value, hn::Add(hn::Mul(left.x, left_x), hn::Mul(right.x, right_x))),
          hn::Add(left.z, hn::Mul(fade, hn::Sub(right.z, left.z)))};
}

// A vector of the row's points from `first` on.
HWY_INLINE LatticePoint load(const LatticeRow& row, std::size_t first) {
  const FloatTag d;
  return {hn::LoadU(d, row.value + first), hn::LoadU(d, row.x + first),
          hn::LoadU(d, row.z + first)};
}
// Of each lane, the point in the lane `slots`.
HWY_INLINE LatticePoint look_up(const LatticePoint& points, hn::Vec<IntTag> slots) {
  const auto indices = hn::IndicesFromVec(FloatTag(), slots);
  return {hn::TableLookupLanes(points.value, indices), hn::TableLookupLanes(points.x, indices),
          hn::TableLookupLanes(points.z, indices)};
}

// Makes `row` the octave's upper lattice row; the previous upper row becomes the lower one. With
// kFirst there is no previous row, and the rise is not computed.
template <LatticeLines::Fit kFit, bool kFirst>
void raise(ColumnOctave& octave, const LatticeRow& row) {
  const ColumnOctave o = octave;
  float *const HWY_RESTRICT below = o.upper, *const HWY_RESTRICT above = o.lower;
  float* const HWY_RESTRICT rise = o.rise;
  const FloatTag d;
  const IntTag di;
  LatticePoint before = load(row, 0), behind = before;
  for (std::size_t i = 0; i < o.stride; i += hn::Lanes(d)) {
    const auto slots = hn::Load(di, o.lines.slot + i);
    if constexpr (kFit != LatticeLines::Fit::kOneVector)
      behind = before = load(row, o.lines.first[i]);
    if constexpr (kFit == LatticeLines::Fit::kNone)
      behind = load(row, o.lines.first[i] + o.lines.to_next);
    const auto next = kFit == LatticeLines::Fit::kNone ? slots : hn::Add(slots, hn::Set(di, 1));
    const auto [value, slope] =
        blend(look_up(before, slots), look_up(behind, next), hn::Load(d, o.left_x + i),
              hn::Load(d, o.right_x + i), hn::Load(d, o.fade + i));
    const std::size_t pair = 2 * i, second = pair + hn::Lanes(d);
    hn::Store(value, d, above + pair);
    hn::Store(slope, d, above + second);
    if constexpr (kFirst) continue;
    const Float below_value = hn::Load(d, below + pair), below_slope = hn::Load(d, below + second);
    hn::Store(hn::Sub(hn::Sub(value, slope), below_value), d, rise + pair);
    hn::Store(hn::Sub(slope, below_slope), d, rise + second);
  }
  octave.lower = below;
  octave.upper = above;
}

// The same for the lattice row of a key, which `row` is filled with.
template <bool kFirst>
void raise_to(ColumnOctave& octave, LatticeRow& row, std::uint32_t row_key, float length) {
  using Fit = LatticeLines::Fit;
  row.hold(octave, row_key, length);
  switch (octave.lines.fit) {
    case Fit::kOneVector:
      return raise<Fit::kOneVector, kFirst>(octave, row);
    case Fit::kEachVector:
      return raise<Fit::kEachVector, kFirst>(octave, row);
    case Fit::kNone:
      return raise<Fit::kNone, kFirst>(octave, row);
  }
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
