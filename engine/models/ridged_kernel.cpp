// The ridged multifractal on a grid. Between two lattice rows the noise of a column is
//   N = a + fz·b + u(fz)·(c + fz·d),
// where a … d are blended along x once per lattice row: three products a sample and octave, without
// hashing and without look-ups. A row of samples runs through all octaves in registers.
#include "engine/models/ridged_kernel.hpp"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/ridged_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

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
std::size_t padded(std::size_t n) {
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
    HWY_ALIGN std::uint64_t first[kPad / 2];
    for (std::size_t i = 0; i < lanes; ++i)
      first[i] = static_cast<std::uint64_t>(at[0]) * step + origin + i * distance * step;
    const auto advance = hn::Set(d, lanes * distance * step);
    auto now = hn::Load(d, first);
    for (std::size_t i = 0; i < padded(count); i += lanes) {
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

// One octave on the columns of a call, each array `stride` elements.
struct ColumnOctave {
  std::size_t stride;
  // Along x, of each column: how much the gradients' x to the left and right and z to the right
  // count.
  float *left_x, *right_x, *fade;
  // Lattice columns: keys before mixing; those to the left of column i start at first[block of i],
  // and slot[i] counts from there, less than the lanes of a vector. Those to the right are
  // `to_right` further on. Narrow: all keys fit one vector, all blocks start at 0.
  std::uint32_t* key;
  std::size_t key_count, to_right;
  std::uint32_t* first;
  std::int32_t* slot;
  bool narrow;
  // Gradients blended along x, of the lower and the upper lattice row: pairs of vectors, a vector
  // of x and one of z. Pairs lie in one line of the cache, in different banks.
  float *lower, *upper;
  float* rise;                // c and d in such pairs
  std::uint32_t lattice_row;  // the lower of the two

  // From the cells of the columns; `contiguous` where each is that of the column before or the
  // next.
  void place_lattice(const std::uint32_t* HWY_RESTRICT cell, bool contiguous, std::uint32_t key_x) {
    const UintTag du;
    const IntTag di;
    const std::size_t lanes = hn::Lanes(du);
    key_count = contiguous ? cell[stride - 1] - cell[0] + 2 : 2 * stride;
    to_right = contiguous ? 1 : stride;
    narrow = contiguous && key_count <= lanes;
    for (std::size_t i = 0; contiguous && i < key_count; i += lanes)
      hn::Store(hn::Iota(du, cell[0] + key_x + static_cast<std::uint32_t>(i)), du, key + i);
    for (std::size_t i = 0; i < stride; i += lanes) {
      const auto cells = hn::Load(du, cell + i);
      const std::uint32_t start = narrow ? cell[0] : cell[i];
      first[i] = contiguous ? start - cell[0] : static_cast<std::uint32_t>(i);
      const auto slots =
          contiguous ? hn::BitCast(di, hn::Sub(cells, hn::Set(du, start))) : hn::Iota(di, 0);
      hn::Store(slots, di, slot + i);
      if (contiguous) continue;
      hn::Store(hn::Add(cells, hn::Set(du, key_x)), du, key + i);
      hn::Store(hn::Add(cells, hn::Set(du, key_x + 1)), du, key + stride + i);
    }
  }
};

// Gradients along one lattice row.
struct GradientRow {
  HWY_ALIGN float x[2 * kMaxNoiseAxis + 2 * kPad];
  HWY_ALIGN float z[2 * kMaxNoiseAxis + 2 * kPad];

  // Direction a quarter turn times t from the x axis, t uniform in [−1, 1), turned round by a
  // further bit. Sine and cosine of quarter turns by polynomials, errors below 5e-8.
  void fill(const ColumnOctave& column, std::uint32_t row_key, float gradient_length) {
    const FloatTag d;
    const IntTag di;
    const UintTag du;
    const auto row_hash = hn::Set(du, mix32(row_key));
    const Float one = hn::Set(d, 1.0F), length = hn::Set(d, gradient_length);
    for (std::size_t i = 0; i < column.key_count; i += hn::Lanes(d)) {
      const auto h = mix32(du, hn::Xor(hn::Load(du, column.key + i), row_hash));
      const Float t = hn::Sub(
          hn::Mul(hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<8>(h))), hn::Set(d, 0x1.0p-23F)),
          one);
      const Float y = hn::Mul(t, t);
      Float sine = hn::Set(d, 0.000151671704F), cosine = hn::Set(d, 0.000858134467F);
      for (const float c : {-0.00467414384F, 0.0796899183F, -0.64596376F, 1.57079632F})
        sine = hn::Add(hn::Mul(sine, y), hn::Set(d, c));
      for (const float c : {-0.0208105152F, 0.253650674F, -1.2336982F, 0.999999953F})
        cosine = hn::Add(hn::Mul(cosine, y), hn::Set(d, c));
      const Float turned = hn::Xor(length, hn::BitCast(d, hn::ShiftLeft<31>(h)));
      hn::Store(hn::Mul(cosine, turned), d, x + i);
      hn::Store(hn::Mul(hn::Mul(sine, t), turned), d, z + i);
    }
  }
};

// Gradients left and right of the columns of one block.
struct Neighbours {
  Float left_x, left_z, right_x, right_z;
};
HWY_INLINE Neighbours neighbours(const ColumnOctave& o, const GradientRow& gradients,
                                 hn::Vec<IntTag> slots, std::size_t left) {
  const FloatTag d;
  const auto indices = hn::IndicesFromVec(d, slots);
  const std::size_t right = left + o.to_right;
  return {hn::TableLookupLanes(hn::LoadU(d, gradients.x + left), indices),
          hn::TableLookupLanes(hn::LoadU(d, gradients.z + left), indices),
          hn::TableLookupLanes(hn::LoadU(d, gradients.x + right), indices),
          hn::TableLookupLanes(hn::LoadU(d, gradients.z + right), indices)};
}
HWY_INLINE Neighbours narrow_neighbours(Float x, Float z, hn::Vec<IntTag> slots) {
  const FloatTag d;
  const auto left = hn::IndicesFromVec(d, slots);
  const auto right = hn::IndicesFromVec(d, hn::Add(slots, hn::Set(IntTag(), 1)));
  return {hn::TableLookupLanes(x, left), hn::TableLookupLanes(z, left),
          hn::TableLookupLanes(x, right), hn::TableLookupLanes(z, right)};
}

// Makes the gradients the octave's upper lattice row; what was the upper one becomes the lower.
template <bool kNarrow>
void raise(ColumnOctave& octave, const GradientRow& gradients) {
  const ColumnOctave o = octave;
  float *const HWY_RESTRICT below = o.upper, *const HWY_RESTRICT above = o.lower;
  float* const HWY_RESTRICT rise = o.rise;
  const FloatTag d;
  const IntTag di;
  const Float all_x = hn::Load(d, gradients.x), all_z = hn::Load(d, gradients.z);
  for (std::size_t i = 0; i < o.stride; i += hn::Lanes(d)) {
    const auto slots = hn::Load(di, o.slot + i);
    const Neighbours g = kNarrow ? narrow_neighbours(all_x, all_z, slots)
                                 : neighbours(o, gradients, slots, o.first[i]);
    const Float x = hn::Add(hn::Mul(g.left_x, hn::Load(d, o.left_x + i)),
                            hn::Mul(g.right_x, hn::Load(d, o.right_x + i)));
    const Float z =
        hn::Add(g.left_z, hn::Mul(hn::Load(d, o.fade + i), hn::Sub(g.right_z, g.left_z)));
    const std::size_t pair = 2 * i, second = pair + hn::Lanes(d);
    const Float below_x = hn::Load(d, below + pair), below_z = hn::Load(d, below + second);
    hn::Store(hn::Sub(hn::Sub(x, z), below_x), d, rise + pair);
    hn::Store(hn::Sub(z, below_z), d, rise + second);
    hn::Store(x, d, above + pair);
    hn::Store(z, d, above + second);
  }
  octave.lower = below;
  octave.upper = above;
}

void raise_to(ColumnOctave& octave, GradientRow& gradients, std::uint32_t row_key, float length) {
  gradients.fill(octave, row_key, length);
  octave.narrow ? raise<true>(octave, gradients) : raise<false>(octave, gradients);
}

// Adds an octave to the sums. The pairs of vectors (ColumnOctave) are `second` elements apart.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void add_octave(D d, const float* lower, const float* rise, std::size_t second, V f,
                           V fade, V offset, V limit, V& weight, V& sum) {
  const V low = hn::Add(hn::Load(d, lower), hn::Mul(f, hn::Load(d, lower + second)));
  const V more = hn::Add(hn::Load(d, rise), hn::Mul(f, hn::Load(d, rise + second)));
  const V noise = hn::Add(low, hn::Mul(fade, more));
  const V ridge = hn::Sub(offset, hn::Abs(noise));
  const V signal = hn::Mul(weight, hn::Mul(ridge, ridge));
  sum = hn::Add(sum, signal);
  weight = hn::Min(signal, limit);
}

// The sums of one row of samples.
struct RowKernel {
  const ColumnOctave* columns;
  const float *fraction, *fade;  // along z, of each octave
  const float* next_limit;       // of each octave
  std::size_t octave_count;
  float offset, scale;

  // One vector from column i on; with fewer lanes than the kernel's vectors where D has fewer.
  template <class D>
  HWY_INLINE hn::Vec<D> one(D d, std::size_t i) const {
    const std::size_t n = hn::Lanes(FloatTag()), at = 2 * i - i % n;
    const auto vector_offset = hn::Set(d, offset);
    auto weight = hn::Set(d, 1.0F), sum = hn::Zero(d);
    for (std::size_t o = 0; o < octave_count; ++o)
      add_octave(d, columns[o].lower + at, columns[o].rise + at, n, hn::Set(d, fraction[o]),
                 hn::Set(d, fade[o]), vector_offset, hn::Set(d, next_limit[o]), weight, sum);
    return hn::Mul(sum, hn::Set(d, scale));
  }

  // Four vectors at once, which share the row's numbers and hide each other's latency, and
  // `rest` <= 4 further samples where kRest.
  template <bool kRest>
  HWY_INLINE void four(std::size_t i, std::size_t rest, float* HWY_RESTRICT out) const {
    const FloatTag d;
    const hn::CappedTag<float, 4> small;
    const std::size_t n = hn::Lanes(d);
    const Float vector_offset = hn::Set(d, offset), vector_scale = hn::Set(d, scale);
    Float weight0 = hn::Set(d, 1.0F), weight1 = weight0, weight2 = weight0, weight3 = weight0;
    Float sum0 = hn::Zero(d), sum1 = sum0, sum2 = sum0, sum3 = sum0;
    auto weight4 = hn::Set(small, 1.0F), sum4 = hn::Zero(small);
    for (std::size_t o = 0; o < octave_count; ++o) {
      const float *const lower = columns[o].lower + 2 * i, *const rise = columns[o].rise + 2 * i;
      const Float f = hn::Set(d, fraction[o]), u = hn::Set(d, fade[o]),
                  limit = hn::Set(d, next_limit[o]);
      add_octave(d, lower, rise, n, f, u, vector_offset, limit, weight0, sum0);
      add_octave(d, lower + 2 * n, rise + 2 * n, n, f, u, vector_offset, limit, weight1, sum1);
      add_octave(d, lower + 4 * n, rise + 4 * n, n, f, u, vector_offset, limit, weight2, sum2);
      add_octave(d, lower + 6 * n, rise + 6 * n, n, f, u, vector_offset, limit, weight3, sum3);
      if (kRest)
        add_octave(small, lower + 8 * n, rise + 8 * n, n, hn::Set(small, fraction[o]),
                   hn::Set(small, fade[o]), hn::Set(small, offset), hn::Set(small, next_limit[o]),
                   weight4, sum4);
    }
    hn::StoreU(hn::Mul(sum0, vector_scale), d, out + i);
    hn::StoreU(hn::Mul(sum1, vector_scale), d, out + i + n);
    hn::StoreU(hn::Mul(sum2, vector_scale), d, out + i + 2 * n);
    hn::StoreU(hn::Mul(sum3, vector_scale), d, out + i + 3 * n);
    if (kRest)
      hn::BlendedStore(hn::Mul(sum4, hn::Set(small, scale)), hn::FirstN(small, rest), small,
                       out + i + 4 * n);
  }

  void run(std::size_t count, float* HWY_RESTRICT out) const {
    const FloatTag d;
    const hn::CappedTag<float, 4> small;
    const std::size_t n = hn::Lanes(d), few = hn::Lanes(small);
    std::size_t i = 0;
    for (; i + 4 * n <= count; i += 4 * n) {
      const std::size_t rest = count - i - 4 * n;
      if (rest > 0 && rest <= few) return four<true>(i, rest, out);
      four<false>(i, 0, out);
    }
    for (; i + n <= count; i += n)
      hn::StoreU(one(d, i), d, out + i);
    if (count - i > n / 2) return hn::BlendedStore(one(d, i), hn::FirstN(d, count - i), d, out + i);
    for (; i < count; i += few)
      hn::BlendedStore(one(small, i), hn::FirstN(small, std::min(few, count - i)), small, out + i);
  }
};

// The working memory of one call; everything starts at a multiple of 64 bytes.
struct Workspace {
  HWY_ALIGN float floats[kMaxOctaves * 9 * kMaxNoiseAxis];
  HWY_ALIGN float fractions[kMaxNoiseAxis];
  HWY_ALIGN std::uint32_t integers[kMaxOctaves * (4 * kMaxNoiseAxis + kPad)];
  HWY_ALIGN std::int32_t slots[kMaxOctaves * kMaxNoiseAxis];
  HWY_ALIGN std::uint64_t positions[kMaxNoiseAxis];
  HWY_ALIGN std::uint32_t cells[kMaxNoiseAxis];
  GradientRow gradients;
  ColumnOctave columns[kMaxOctaves];

  void prepare(std::size_t index, const RidgedOctave& octave, const Axis& axis) {
    const std::size_t width = padded(axis.at.size());
    ColumnOctave& c = columns[index];
    float* const f = floats + index * 9 * width;
    std::uint32_t* const u = integers + index * (3 * width + kPad);
    c.stride = width;
    c.rise = f;
    c.lower = f + 2 * width;
    c.upper = f + 4 * width;
    c.left_x = f + 6 * width;
    c.right_x = f + 7 * width;
    c.fade = f + 8 * width;
    c.key = u;
    c.first = u + 2 * width + kPad;
    c.slot = slots + index * width;
    axis.place(octave.step, octave.origin_x, positions);
    locate(positions, width, cells, fractions, c.fade);
    const FloatTag d;
    const Float one = hn::Set(d, 1.0F);
    for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
      const Float t = hn::Load(d, fractions + i), fade = hn::Load(d, c.fade + i);
      hn::Store(hn::Mul(t, hn::Sub(one, fade)), d, c.left_x + i);
      hn::Store(hn::Mul(hn::Sub(t, one), fade), d, c.right_x + i);
    }
    constexpr std::uint64_t kCell = std::uint64_t{1} << 32;
    c.place_lattice(cells,
                    axis.even && axis.distance * octave.step <= kCell && axis.distance <= kCell &&
                        octave.step <= kCell,
                    octave.key_x);
    std::fill(c.upper, c.upper + 2 * width, 0.0F);
  }
};

// The rows' positions on the lattices: kPad elements for each row, of which one per octave is used.
// All computed before the first row of samples, which would otherwise wait for them.
struct RowOctaves {
  HWY_ALIGN std::uint32_t cell[kMaxNoiseAxis * kPad];
  HWY_ALIGN float fraction[kMaxNoiseAxis * kPad];
  HWY_ALIGN float fade[kMaxNoiseAxis * kPad];
  HWY_ALIGN float next_limit[kPad];
  std::uint32_t changed[kMaxNoiseAxis];  // a bit for each octave in another cell than a row before

  RowOctaves(const RidgedKernel& kernel, const Axis& rows) {
    const auto octave_count = static_cast<std::size_t>(kernel.octave_count);
    HWY_ALIGN std::uint64_t step[kPad] = {};
    HWY_ALIGN std::uint64_t origin[kPad] = {};
    HWY_ALIGN std::uint64_t position[kMaxNoiseAxis * kPad];
    for (std::size_t o = 0; o < octave_count; ++o) {
      step[o] = kernel.octaves[o].step;
      origin[o] = kernel.octaves[o].origin_z;
      next_limit[o] = o + 1 < octave_count ? kernel.octaves[o + 1].limit : 0.0F;
    }
    for (std::size_t o = 0; o < kPad; ++o)
      position[o] = static_cast<std::uint64_t>(rows.at[0]) * step[o] + origin[o];
    HWY_ALIGN std::uint64_t advance[kPad] = {};
    std::uint64_t distance = 0;
    for (std::size_t r = 1; r < rows.at.size(); ++r) {
      const std::uint64_t by = rows.difference(r);
      const std::uint64_t* HWY_RESTRICT before = position + (r - 1) * kPad;
      std::uint64_t* HWY_RESTRICT now = position + r * kPad;
      if (by != distance) {
        distance = by;
        for (std::size_t o = 0; o < kPad; ++o)
          advance[o] = step[o] * by;
      }
      for (std::size_t o = 0; o < kPad; ++o)
        now[o] = before[o] + advance[o];
    }
    locate(position, rows.at.size() * kPad, cell, fraction, fade);
    const std::uint32_t all = (1U << octave_count) - 1;
    changed[0] = all;
    for (std::size_t r = 1; r < rows.at.size(); ++r)
      changed[r] = different(cell + r * kPad, cell + (r - 1) * kPad) & all;
  }
  static std::uint32_t different(const std::uint32_t* a, const std::uint32_t* b) {
    const UintTag du;
    std::uint32_t result = 0;
    for (std::size_t o = 0; o < kPad; o += hn::Lanes(du)) {
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(du, hn::Ne(hn::Load(du, a + o), hn::Load(du, b + o)), bits);
      result |= static_cast<std::uint32_t>(bits[0] | bits[1] << 8) << o;
    }
    return result;
  }
};
static_assert(kPad >= kMaxOctaves);

void evaluate(const RidgedKernel& kernel, std::span<const std::int64_t> columns,
              std::span<const std::int64_t> rows, float* values, std::size_t stride) {
  const auto octave_count = static_cast<std::size_t>(kernel.octave_count);
  Workspace memory;
  const Axis column_axis(columns);
  for (std::size_t o = 0; o < octave_count; ++o)
    memory.prepare(o, kernel.octaves[o], column_axis);
  const RowOctaves along_z(kernel, Axis(rows));
  RowKernel row_kernel{memory.columns,     nullptr,      nullptr,
                       along_z.next_limit, octave_count, kernel.offset,
                       kernel.result_scale};
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::uint32_t changed = along_z.changed[r]; changed != 0; changed &= changed - 1) {
      const auto o = static_cast<std::size_t>(std::countr_zero(changed));
      ColumnOctave& octave = memory.columns[o];
      const std::uint32_t cell = along_z.cell[r * kPad + o], key = cell + kernel.octaves[o].key_z;
      if (r == 0 || cell != octave.lattice_row + 1)
        raise_to(octave, memory.gradients, key, kernel.gradient_length);
      raise_to(octave, memory.gradients, key + 1, kernel.gradient_length);
      octave.lattice_row = cell;
    }
    row_kernel.fraction = along_z.fraction + r * kPad;
    row_kernel.fade = along_z.fade + r * kPad;
    row_kernel.run(columns.size(), values + r * stride);
  }
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace psygen::models {

HWY_EXPORT(evaluate);

void evaluate_ridged(const RidgedKernel& kernel, std::span<const std::int64_t> columns,
                     std::span<const std::int64_t> rows, float* values, std::size_t stride) {
  HWY_DYNAMIC_DISPATCH(evaluate)(kernel, columns, rows, values, stride);
}

}  // namespace psygen::models
#endif
