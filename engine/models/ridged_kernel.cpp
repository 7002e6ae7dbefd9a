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

// Rows of working memory are padded to this many elements, the most lanes that are used.
constexpr std::size_t kPad = 16;
constexpr std::size_t padded(std::size_t n) {
  return (n + kPad - 1) / kPad * kPad;
}
using FloatTag = hn::CappedTag<float, kPad>;
using IntTag = hn::RebindToSigned<FloatTag>;
using UintTag = hn::RebindToUnsigned<FloatTag>;
using Float = hn::Vec<FloatTag>;

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
  float *fraction, *fade;  // along x, of each column
  // Lattice columns: keys before mixing; those to the left of column i start at first[block of i],
  // and slot[i] counts from there, less than the lanes of a vector. Those to the right are
  // `to_right` further on. Narrow: all keys fit one vector, all blocks start at 0.
  std::uint32_t* key;
  std::size_t key_count, to_right;
  std::uint32_t* first;
  std::int32_t* slot;
  bool narrow;
  // Gradients blended along x, of the lower and the upper lattice row: x, then z.
  float *lower, *upper;
  float* rise;                // c, then d
  std::uint32_t lattice_row;  // the lower of the two

  // From the cells of the columns.
  void place_lattice(const std::uint32_t* HWY_RESTRICT cell, std::size_t count,
                     std::uint32_t key_x) {
    const UintTag du;
    const IntTag di;
    const std::size_t lanes = hn::Lanes(du);
    std::uint32_t far_apart = 0;
    for (std::size_t i = 0; i + 1 < count; ++i)
      far_apart |= cell[i + 1] - cell[i] > 1U ? 1U : 0U;
    const bool contiguous = far_apart == 0;  // else two lattice columns of its own for each column
    key_count = contiguous ? cell[count - 1] - cell[0] + 2 : 2 * stride;
    to_right = contiguous ? 1 : stride;
    narrow = contiguous && key_count <= lanes;
    for (std::size_t i = 0; contiguous && i < key_count; i += lanes)
      hn::Store(hn::Iota(du, cell[0] + key_x + static_cast<std::uint32_t>(i)), du, key + i);
    for (std::size_t i = 0; i < stride; i += lanes) {
      const auto cells = hn::Load(du, cell + i);
      const std::uint32_t start = narrow ? cell[0] : cell[i];
      first[i] = contiguous ? start - cell[0] : static_cast<std::uint32_t>(i);
      const auto slots = contiguous ? hn::BitCast(di, hn::Sub(cells, hn::Set(du, start)))
                                    : hn::Iota(di, 0);
      hn::Store(slots, di, slot + i);
      if (contiguous) continue;
      hn::Store(hn::Add(cells, hn::Set(du, key_x)), du, key + i);
      hn::Store(hn::Add(cells, hn::Set(du, key_x + 1)), du, key + stride + i);
    }
  }
};

// Gradients along one lattice row.
struct GradientRow {
  HWY_ALIGN float x[2 * kMaxNoiseAxis + 3 * kPad];
  HWY_ALIGN float z[2 * kMaxNoiseAxis + 3 * kPad];

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
  const Float one = hn::Set(d, 1.0F);
  const Float all_x = hn::Load(d, gradients.x), all_z = hn::Load(d, gradients.z);
  for (std::size_t i = 0; i < o.stride; i += hn::Lanes(d)) {
    const auto slots = hn::Load(di, o.slot + i);
    const Neighbours g = kNarrow ? narrow_neighbours(all_x, all_z, slots)
                                 : neighbours(o, gradients, slots, o.first[i]);
    const Float f = hn::Load(d, o.fraction + i), fade = hn::Load(d, o.fade + i);
    const Float left = hn::Mul(g.left_x, f), right = hn::Mul(g.right_x, hn::Sub(f, one));
    const Float x = hn::Add(left, hn::Mul(fade, hn::Sub(right, left)));
    const Float z = hn::Add(g.left_z, hn::Mul(fade, hn::Sub(g.right_z, g.left_z)));
    const Float below_x = hn::Load(d, below + i), below_z = hn::Load(d, below + o.stride + i);
    hn::Store(hn::Sub(hn::Sub(x, z), below_x), d, rise + i);
    hn::Store(hn::Sub(z, below_z), d, rise + o.stride + i);
    hn::Store(x, d, above + i);
    hn::Store(z, d, above + o.stride + i);
  }
  octave.lower = below;
  octave.upper = above;
}

void raise_to(ColumnOctave& octave, GradientRow& gradients, std::uint32_t row_key, float length) {
  gradients.fill(octave, row_key, length);
  octave.narrow ? raise<true>(octave, gradients) : raise<false>(octave, gradients);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE void add_octave(D d, const float* lower, const float* rise, std::size_t stride, V f,
                           V fade, V offset, V limit, V& weight, V& sum) {
  const V low = hn::Add(hn::Load(d, lower), hn::Mul(f, hn::Load(d, lower + stride)));
  const V more = hn::Add(hn::Load(d, rise), hn::Mul(f, hn::Load(d, rise + stride)));
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
  std::size_t octave_count, stride;
  float offset, scale;

  // One vector from column i on.
  template <class D>
  HWY_INLINE hn::Vec<D> one(D d, std::size_t i) const {
    const auto vector_offset = hn::Set(d, offset);
    auto weight = hn::Set(d, 1.0F), sum = hn::Zero(d);
    for (std::size_t o = 0; o < octave_count; ++o)
      add_octave(d, columns[o].lower + i, columns[o].rise + i, stride, hn::Set(d, fraction[o]),
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
      const float *const lower = columns[o].lower + i, *const rise = columns[o].rise + i;
      const Float f = hn::Set(d, fraction[o]), u = hn::Set(d, fade[o]),
                  limit = hn::Set(d, next_limit[o]);
      add_octave(d, lower, rise, stride, f, u, vector_offset, limit, weight0, sum0);
      add_octave(d, lower + n, rise + n, stride, f, u, vector_offset, limit, weight1, sum1);
      add_octave(d, lower + 2 * n, rise + 2 * n, stride, f, u, vector_offset, limit, weight2, sum2);
      add_octave(d, lower + 3 * n, rise + 3 * n, stride, f, u, vector_offset, limit, weight3, sum3);
      if (kRest)
        add_octave(small, lower + 4 * n, rise + 4 * n, stride, hn::Set(small, fraction[o]),
                   hn::Set(small, fade[o]), hn::Set(small, offset), hn::Set(small, next_limit[o]),
                   weight4, sum4);
    }
    hn::StoreU(hn::Mul(sum0, vector_scale), d, out + i);
    hn::StoreU(hn::Mul(sum1, vector_scale), d, out + i + n);
    hn::StoreU(hn::Mul(sum2, vector_scale), d, out + i + 2 * n);
    hn::StoreU(hn::Mul(sum3, vector_scale), d, out + i + 3 * n);
    if (!kRest) return;
    HWY_ALIGN float last[4];
    hn::Store(hn::Mul(sum4, hn::Set(small, scale)), small, last);
    std::copy_n(last, rest, out + i + 4 * n);
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
    HWY_ALIGN float last[kPad];
    if (count - i > n / 2) {
      hn::Store(one(d, i), d, last);
      std::copy_n(last, count - i, out + i);
      return;
    }
    for (; i < count; i += few) {
      hn::Store(one(small, i), small, last);
      std::copy_n(last, std::min(few, count - i), out + i);
    }
  }
};

// The working memory of one call; everything starts at a multiple of 64 bytes.
struct Workspace {
  HWY_ALIGN float floats[kMaxOctaves * 8 * kMaxNoiseAxis];
  HWY_ALIGN std::uint32_t integers[kMaxOctaves * (4 * kMaxNoiseAxis + kPad)];
  HWY_ALIGN std::int32_t slots[kMaxOctaves * kMaxNoiseAxis];
  HWY_ALIGN std::uint64_t positions[kMaxNoiseAxis];
  HWY_ALIGN std::uint32_t cells[kMaxNoiseAxis];
  GradientRow gradients;
  ColumnOctave columns[kMaxOctaves];

  void prepare(std::size_t index, const RidgedOctave& octave,
               std::span<const std::int64_t> axis) {
    const std::size_t count = axis.size(), width = padded(count);
    ColumnOctave& c = columns[index];
    float* const f = floats + index * 8 * width;
    std::uint32_t* const u = integers + index * (3 * width + kPad);
    c.stride = width;
    c.rise = f;
    c.lower = f + 2 * width;
    c.upper = f + 4 * width;
    c.fraction = f + 6 * width;
    c.fade = f + 7 * width;
    c.key = u;
    c.first = u + 2 * width + kPad;
    c.slot = slots + index * width;
    for (std::size_t i = 0; i < count; ++i)
      positions[i] = static_cast<std::uint64_t>(axis[i]) * octave.step + octave.origin_x;
    std::fill(positions + count, positions + width, positions[count - 1]);
    locate(positions, width, cells, c.fraction, c.fade);
    c.place_lattice(cells, count, octave.key_x);
    std::fill(c.upper, c.upper + 2 * width, 0.0F);
  }
};

// The rows' positions on the lattices: arrays over octaves.
struct RowOctaves {
  HWY_ALIGN std::uint64_t step[kPad];
  HWY_ALIGN std::uint64_t origin[kPad];
  HWY_ALIGN std::uint64_t position[kPad];
  HWY_ALIGN std::uint32_t cell[kPad];
  HWY_ALIGN std::uint32_t previous_cell[kPad];
  HWY_ALIGN float fraction[kPad];
  HWY_ALIGN float fade[kPad];
  HWY_ALIGN float next_limit[kPad];

  explicit RowOctaves(const RidgedKernel& kernel) {
    for (std::size_t o = 0; o < kPad; ++o) {
      const bool used = o < static_cast<std::size_t>(kernel.octave_count);
      step[o] = used ? kernel.octaves[o].step : 0;
      origin[o] = used ? kernel.octaves[o].origin_z : 0;
      previous_cell[o] = 0;
      next_limit[o] = o + 1 < static_cast<std::size_t>(kernel.octave_count)
                          ? kernel.octaves[o + 1].limit
                          : 0.0F;
    }
  }
  // Moves on to a row; returns a bit for each octave that is in another cell than before.
  std::uint32_t move_to(std::int64_t row) {
    for (std::size_t o = 0; o < kPad; ++o)
      position[o] = static_cast<std::uint64_t>(row) * step[o] + origin[o];
    locate(position, kPad, cell, fraction, fade);
    const UintTag du;
    std::uint32_t changed = 0;
    for (std::size_t o = 0; o < kPad; o += hn::Lanes(du)) {
      const auto now = hn::Load(du, cell + o), before = hn::Load(du, previous_cell + o);
      hn::Store(now, du, previous_cell + o);
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(du, hn::Ne(now, before), bits);
      changed |= static_cast<std::uint32_t>(bits[0] | bits[1] << 8) << o;
    }
    return changed;
  }
};
static_assert(kPad >= kMaxOctaves);

void evaluate(const RidgedKernel& kernel, std::span<const std::int64_t> columns,
              std::span<const std::int64_t> rows, float* values, std::size_t stride) {
  const auto octave_count = static_cast<std::size_t>(kernel.octave_count);
  Workspace memory;
  for (std::size_t o = 0; o < octave_count; ++o)
    memory.prepare(o, kernel.octaves[o], columns);
  RowOctaves along_z(kernel);
  const RowKernel row_kernel{memory.columns,       along_z.fraction, along_z.fade,
                             along_z.next_limit,   octave_count,     padded(columns.size()),
                             kernel.offset,        kernel.result_scale};
  const std::uint32_t all = (1U << octave_count) - 1;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::uint32_t changed = along_z.move_to(rows[r]) & all;
    if (r == 0) changed = all;
    for (; changed != 0; changed &= changed - 1) {
      const auto o = static_cast<std::size_t>(std::countr_zero(changed));
      ColumnOctave& octave = memory.columns[o];
      const std::uint32_t cell = along_z.cell[o], key = cell + kernel.octaves[o].key_z;
      if (r == 0 || cell != octave.lattice_row + 1)
        raise_to(octave, memory.gradients, key, kernel.gradient_length);
      raise_to(octave, memory.gradients, key + 1, kernel.gradient_length);
      octave.lattice_row = cell;
    }
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
