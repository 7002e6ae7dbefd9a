// The lattices of ridged noise under the samples of a call: positions, gradients, and their
// blending along one lattice row. Included once per instruction set, by ridged_kernel.cpp only;
// hence its include guard.
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

#include "engine/models/mix32.hpp"
#include "engine/models/ridged_kernel.hpp"
#include "engine/models/simd_hash-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The most lanes that are used; octaves of a row are padded to this number.
constexpr std::size_t kPad = 16;
using FloatTag = hn::CappedTag<float, kPad>;
using IntTag = hn::RebindToSigned<FloatTag>;
using UintTag = hn::RebindToUnsigned<FloatTag>;
using Float = hn::Vec<FloatTag>;

// Arrays over columns are padded to whole vectors.
HWY_INLINE std::size_t padded(std::size_t n) {
  const std::size_t lanes = hn::Lanes(FloatTag());
  return (n + lanes - 1) / lanes * lanes;
}

// The integers of an axis, and whether neighbours all have the same distance.
struct Axis {
  std::span<const std::int64_t> at;
  bool even = true;
  std::uint64_t distance = 1;

  explicit Axis(std::span<const std::int64_t> integers) : at(integers) {
    if (at.size() > 1) distance = difference(1);
    std::uint64_t odd = 0;
    for (std::size_t i = 1; i < at.size(); ++i)
      odd |= difference(i) ^ distance;
    even = odd == 0;
  }
  std::uint64_t difference(std::size_t i) const {
    return static_cast<std::uint64_t>(at[i]) - static_cast<std::uint64_t>(at[i - 1]);
  }
  // Whether each lies in the lattice cell of the one before or in the next.
  bool contiguous(std::uint64_t step) const {
    constexpr std::uint64_t kCell = std::uint64_t{1} << 32;
    return even && distance * step <= kCell && distance <= kCell && step <= kCell;
  }

  // 0, `of`, 2 · `of`, …: with the bits of a lane's number, for few sets multiply 64 bits, and
  // loading what single numbers have just been written to stalls.
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

  // Positions on a lattice of `step` from `origin`, padded.
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

// Where Q32.32 positions lie on a lattice: cell, fraction in [0, 1) of 24 bits, fade. All arrays
// are aligned and padded.
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

// Whole vectors of zeros.
HWY_INLINE void clear_vectors(float* to, std::size_t count) {
  const FloatTag d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d))
    hn::Store(hn::Zero(d), d, to + i);
}

// The lattice lines of an octave around the samples of an axis: keys before mixing; those of the
// lines before samples i … start at first[block of i], and slot[i] counts from there, less than the
// lanes of a vector. Those of the lines behind are `to_next` further on. Narrow: all keys fit one
// vector, all blocks start at 0.
struct LatticeLines {
  std::uint32_t* key;
  std::size_t key_count, to_next;
  std::uint32_t* first;
  std::int32_t* slot;
  bool narrow;

  // From the cells of `width` samples, padded.
  void place(const std::uint32_t* HWY_RESTRICT cell, std::size_t width, bool contiguous,
             std::uint32_t key_offset) {
    const UintTag du;
    const IntTag di;
    const std::size_t lanes = hn::Lanes(du);
    key_count = contiguous ? cell[width - 1] - cell[0] + 2 : 2 * width;
    to_next = contiguous ? 1 : width;
    narrow = contiguous && key_count <= lanes;
    for (std::size_t i = 0; contiguous && i < key_count; i += lanes)
      hn::Store(counting_from(du, cell[0] + key_offset + static_cast<std::uint32_t>(i)), du,
                key + i);
    for (std::size_t i = 0; i < width; i += lanes) {
      const auto cells = hn::Load(du, cell + i);
      const std::uint32_t start = narrow ? cell[0] : cell[i];
      first[i] = contiguous ? start - cell[0] : static_cast<std::uint32_t>(i);
      const auto slots =
          contiguous ? hn::BitCast(di, hn::Sub(cells, hn::Set(du, start))) : hn::Iota(di, 0);
      hn::Store(slots, di, slot + i);
      if (contiguous) continue;
      hn::Store(hn::Add(cells, hn::Set(du, key_offset)), du, key + i);
      hn::Store(hn::Add(cells, hn::Set(du, key_offset + 1)), du, key + width + i);
    }
  }
};

// One octave on the columns of a call, each array `stride` elements.
struct ColumnOctave {
  std::size_t stride;
  // Along x, of each column: how much the gradients' x to the left and right and z to the right
  // count.
  float *left_x, *right_x, *fade;
  LatticeLines lines;
  // Gradients blended along x, of the lower and the upper lattice row: pairs of vectors, a vector
  // of x and one of z. Pairs lie in one line of the cache, in different banks.
  float *lower, *upper;
  float* rise;                // c and d in such pairs
  std::uint32_t lattice_row;  // the lower of the two

  void clear() const {
    clear_vectors(lower, 2 * stride);
    clear_vectors(rise, 2 * stride);
  }
};

struct Gradient {
  Float x, z;
};
// Direction a quarter turn times t from the x axis, t uniform in [−1, 1), turned round by a further
// bit. Sine and cosine of quarter turns by polynomials, errors below 5e-8.
HWY_INLINE Gradient gradient(hn::Vec<UintTag> key, hn::Vec<UintTag> row_hash, Float length) {
  const FloatTag d;
  const auto h = mix32(UintTag(), hn::Xor(key, row_hash));
  const Float t = hn::Sub(hn::Mul(hn::ConvertTo(d, hn::BitCast(IntTag(), hn::ShiftRight<8>(h))),
                                  hn::Set(d, 0x1.0p-23F)),
                          hn::Set(d, 1.0F));
  const Float y = hn::Mul(t, t);
  Float sine = hn::Set(d, 0.000151671704F), cosine = hn::Set(d, 0.000858134467F);
  for (const float c : {-0.00467414384F, 0.0796899183F, -0.64596376F, 1.57079632F})
    sine = hn::Add(hn::Mul(sine, y), hn::Set(d, c));
  for (const float c : {-0.0208105152F, 0.253650674F, -1.2336982F, 0.999999953F})
    cosine = hn::Add(hn::Mul(cosine, y), hn::Set(d, c));
  const Float turned = hn::Xor(length, hn::BitCast(d, hn::ShiftLeft<31>(h)));
  return {hn::Mul(cosine, turned), hn::Mul(hn::Mul(sine, t), turned)};
}

// Gradients along one lattice row of an octave.
struct GradientRow {
  HWY_ALIGN float x[2 * kMaxNoiseAxis + 3 * kPad];
  HWY_ALIGN float z[2 * kMaxNoiseAxis + 3 * kPad];
  std::uint32_t key;  // of the lattice row
  bool filled = false;

  // Fills it unless it has those of this lattice row already.
  void hold(const ColumnOctave& column, std::uint32_t row_key, float gradient_length) {
    if (filled && key == row_key) return;
    fill(column, row_key, gradient_length);
    key = row_key;
    filled = true;
  }

 private:
  void fill(const ColumnOctave& column, std::uint32_t row_key, float gradient_length) {
    const FloatTag d;
    const UintTag du;
    const auto row_hash = hn::Set(du, models::mix32(row_key));
    const Float length = hn::Set(d, gradient_length);
    for (std::size_t i = 0; i < column.lines.key_count; i += hn::Lanes(d)) {
      const Gradient g = gradient(hn::Load(du, column.lines.key + i), row_hash, length);
      hn::Store(g.x, d, x + i);
      hn::Store(g.z, d, z + i);
    }
  }
};

// Gradients on the lattice lines before and behind the samples of one block.
struct Neighbours {
  Float left_x, left_z, right_x, right_z;
};
HWY_INLINE Neighbours neighbours(const float* x, const float* z, hn::Vec<IntTag> slots,
                                 std::size_t left, std::size_t right) {
  const FloatTag d;
  const auto indices = hn::IndicesFromVec(d, slots);
  return {hn::TableLookupLanes(hn::LoadU(d, x + left), indices),
          hn::TableLookupLanes(hn::LoadU(d, z + left), indices),
          hn::TableLookupLanes(hn::LoadU(d, x + right), indices),
          hn::TableLookupLanes(hn::LoadU(d, z + right), indices)};
}
HWY_INLINE Neighbours narrow_neighbours(Float x, Float z, hn::Vec<IntTag> slots) {
  const FloatTag d;
  const auto left = hn::IndicesFromVec(d, slots);
  const auto right = hn::IndicesFromVec(d, hn::Add(slots, hn::Set(IntTag(), 1)));
  return {hn::TableLookupLanes(x, left), hn::TableLookupLanes(z, left),
          hn::TableLookupLanes(x, right), hn::TableLookupLanes(z, right)};
}

// Gradients blended along x at the columns of one block.
template <bool kNarrow>
HWY_INLINE Gradient blended(const ColumnOctave& o, const GradientRow& gradients, Float all_x,
                            Float all_z, std::size_t i) {
  const FloatTag d;
  const auto slots = hn::Load(IntTag(), o.lines.slot + i);
  const std::size_t left = o.lines.first[i];
  const Neighbours g =
      kNarrow ? narrow_neighbours(all_x, all_z, slots)
              : neighbours(gradients.x, gradients.z, slots, left, left + o.lines.to_next);
  return {hn::Add(hn::Mul(g.left_x, hn::Load(d, o.left_x + i)),
                  hn::Mul(g.right_x, hn::Load(d, o.right_x + i))),
          hn::Add(g.left_z, hn::Mul(hn::Load(d, o.fade + i), hn::Sub(g.right_z, g.left_z)))};
}

// Makes the gradients the octave's upper lattice row; unless it is the first, what was the upper
// one becomes the lower.
template <bool kNarrow, bool kFirst>
void raise(ColumnOctave& octave, const GradientRow& gradients) {
  const ColumnOctave o = octave;
  float *const HWY_RESTRICT below = o.upper, *const HWY_RESTRICT above = o.lower;
  float* const HWY_RESTRICT rise = o.rise;
  const FloatTag d;
  const Float all_x = hn::Load(d, gradients.x), all_z = hn::Load(d, gradients.z);
  for (std::size_t i = 0; i < o.stride; i += hn::Lanes(d)) {
    const auto [x, z] = blended<kNarrow>(o, gradients, all_x, all_z, i);
    const std::size_t pair = 2 * i, second = pair + hn::Lanes(d);
    hn::Store(x, d, above + pair);
    hn::Store(z, d, above + second);
    if constexpr (kFirst) continue;
    const Float below_x = hn::Load(d, below + pair), below_z = hn::Load(d, below + second);
    hn::Store(hn::Sub(hn::Sub(x, z), below_x), d, rise + pair);
    hn::Store(hn::Sub(z, below_z), d, rise + second);
  }
  octave.lower = below;
  octave.upper = above;
}

template <bool kFirst>
void raise_to(ColumnOctave& octave, GradientRow& gradients, std::uint32_t row_key, float length) {
  gradients.hold(octave, row_key, length);
  octave.lines.narrow ? raise<true, kFirst>(octave, gradients)
                      : raise<false, kFirst>(octave, gradients);
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
