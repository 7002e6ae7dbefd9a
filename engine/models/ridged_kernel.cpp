// The ridged multifractal on a grid. Between two lattice rows the noise of a column is
//   N = a + fz·b + u(fz)·(c + fz·d),
// where a … d are blended along x once per lattice row: three products a sample and octave, without
// hashing and without look-ups. A row of samples runs through all octaves in registers.
#include "engine/models/ridged_kernel.hpp"

#include <algorithm>

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

// Positions of an axis on the lattice of one octave. Arrays of padded(axis.size()); the last
// position is repeated in the padding.
struct LatticeAxis {
  std::uint32_t* cell;
  float* fraction;  // [0, 1), 24 bits
  float* fade;

  void locate(std::span<const std::int64_t> axis, std::uint64_t step, std::uint64_t origin) const {
    HWY_ALIGN std::uint64_t position[kMaxNoiseAxis];
    const std::size_t count = axis.size();
    for (std::size_t i = 0; i < count; ++i)
      position[i] = static_cast<std::uint64_t>(axis[i]) * step + origin;
    std::fill(position + count, position + padded(count), position[count - 1]);
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
};

// One octave on the columns of a call.
struct ColumnOctave {
  float *fraction, *fade;  // along x, of each column
  // Lattice columns: keys before mixing; those to the left of column i start at first[block of i],
  // and slot[i] counts from there, less than the lanes of a vector. Those to the right are
  // `to_right` further on.
  std::uint32_t* key;
  std::size_t key_count, to_right;
  std::int32_t *first, *slot;
  // Of each column: the gradients of the upper lattice row blended along x, and a … d as above.
  float *blended_x, *blended_z;
  float* coefficients;  // a, b, c, d, `stride` elements each
  std::size_t stride;
  std::uint32_t lattice_row;  // the lower of the two

  // From the cells of the columns, with room for padded(count) of them.
  void place_lattice(const std::uint32_t* cell, std::size_t count, std::uint32_t key_x) {
    const std::size_t lanes = hn::Lanes(FloatTag());
    std::uint32_t far_apart = 0;
    for (std::size_t i = 0; i + 1 < stride; ++i)
      far_apart |= cell[i + 1] - cell[i] > 1U ? 1U : 0U;
    if (far_apart != 0) {  // two lattice columns of its own for every column
      for (std::size_t i = 0; i < stride; ++i) {
        key[i] = cell[i] + key_x;
        key[stride + i] = cell[i] + key_x + 1;
        first[i] = static_cast<std::int32_t>(i / lanes * lanes);
        slot[i] = static_cast<std::int32_t>(i % lanes);
      }
      key_count = 2 * stride;
      to_right = stride;
      return;
    }
    key_count = cell[count - 1] - cell[0] + 2;
    to_right = 1;
    for (std::size_t i = 0; i < key_count; ++i)
      key[i] = cell[0] + key_x + static_cast<std::uint32_t>(i);
    for (std::size_t i = 0; i < stride; ++i) {
      first[i] = static_cast<std::int32_t>(cell[i / lanes * lanes] - cell[0]);
      slot[i] = static_cast<std::int32_t>(cell[i] - cell[0]) - first[i];
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

// Makes the gradients the octave's upper lattice row; what was the upper one becomes the lower.
void raise(const ColumnOctave& o, const GradientRow& gradients, bool has_lower) {
  const FloatTag d;
  const IntTag di;
  const Float one = hn::Set(d, 1.0F);
  for (std::size_t i = 0; i < o.stride; i += hn::Lanes(d)) {
    const auto slots = hn::IndicesFromVec(d, hn::Load(di, o.slot + i));
    const auto left = static_cast<std::size_t>(o.first[i]), right = left + o.to_right;
    const Float left_x = hn::TableLookupLanes(hn::LoadU(d, gradients.x + left), slots);
    const Float left_z = hn::TableLookupLanes(hn::LoadU(d, gradients.z + left), slots);
    const Float right_x = hn::TableLookupLanes(hn::LoadU(d, gradients.x + right), slots);
    const Float right_z = hn::TableLookupLanes(hn::LoadU(d, gradients.z + right), slots);
    const Float f = hn::Load(d, o.fraction + i), fade = hn::Load(d, o.fade + i);
    const Float from_left = hn::Mul(left_x, f), from_right = hn::Mul(right_x, hn::Sub(f, one));
    const Float x = hn::Add(from_left, hn::Mul(fade, hn::Sub(from_right, from_left)));
    const Float z = hn::Add(left_z, hn::Mul(fade, hn::Sub(right_z, left_z)));
    if (has_lower) {
      const Float a = hn::Load(d, o.blended_x + i), b = hn::Load(d, o.blended_z + i);
      hn::Store(a, d, o.coefficients + i);
      hn::Store(b, d, o.coefficients + o.stride + i);
      hn::Store(hn::Sub(hn::Sub(x, z), a), d, o.coefficients + 2 * o.stride + i);
      hn::Store(hn::Sub(z, b), d, o.coefficients + 3 * o.stride + i);
    }
    hn::Store(x, d, o.blended_x + i);
    hn::Store(z, d, o.blended_z + i);
  }
}

// What the samples of one row share in one octave.
struct RowOctave {
  float fraction, fade, next_limit;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE void add_octave(D d, const float* a, std::size_t stride, V f, V fade, V offset, V limit,
                           V& weight, V& sum) {
  const V low = hn::Add(hn::Load(d, a), hn::Mul(f, hn::Load(d, a + stride)));
  const V rise = hn::Add(hn::Load(d, a + 2 * stride), hn::Mul(f, hn::Load(d, a + 3 * stride)));
  const V noise = hn::Add(low, hn::Mul(fade, rise));
  const V ridge = hn::Sub(offset, hn::Abs(noise));
  const V signal = hn::Mul(weight, hn::Mul(ridge, ridge));
  sum = hn::Add(sum, signal);
  weight = hn::Min(signal, limit);
}

// The sums of one row. `a` are the coefficients of octave 0; octaves are 4 · stride apart.
struct RowKernel {
  const float* coefficients;
  std::size_t stride;
  const RowOctave* octaves;
  std::size_t octave_count;
  float offset, scale;

  // One vector from column i on.
  template <class D>
  HWY_INLINE hn::Vec<D> one(D d, std::size_t i) const {
    const auto vector_offset = hn::Set(d, offset);
    auto weight = hn::Set(d, 1.0F), sum = hn::Zero(d);
    const float* a = coefficients + i;
    for (std::size_t o = 0; o < octave_count; ++o, a += 4 * stride)
      add_octave(d, a, stride, hn::Set(d, octaves[o].fraction), hn::Set(d, octaves[o].fade),
                 vector_offset, hn::Set(d, octaves[o].next_limit), weight, sum);
    return hn::Mul(sum, hn::Set(d, scale));
  }

  // Four vectors at once, which share the row's numbers and hide each other's latency.
  HWY_INLINE void four(std::size_t i, float* out) const {
    const FloatTag d;
    const std::size_t n = hn::Lanes(d);
    const Float vector_offset = hn::Set(d, offset), vector_scale = hn::Set(d, scale);
    Float weight0 = hn::Set(d, 1.0F), weight1 = weight0, weight2 = weight0, weight3 = weight0;
    Float sum0 = hn::Zero(d), sum1 = sum0, sum2 = sum0, sum3 = sum0;
    const float* a = coefficients + i;
    for (std::size_t o = 0; o < octave_count; ++o, a += 4 * stride) {
      const Float f = hn::Set(d, octaves[o].fraction), fade = hn::Set(d, octaves[o].fade),
                  limit = hn::Set(d, octaves[o].next_limit);
      add_octave(d, a, stride, f, fade, vector_offset, limit, weight0, sum0);
      add_octave(d, a + n, stride, f, fade, vector_offset, limit, weight1, sum1);
      add_octave(d, a + 2 * n, stride, f, fade, vector_offset, limit, weight2, sum2);
      add_octave(d, a + 3 * n, stride, f, fade, vector_offset, limit, weight3, sum3);
    }
    hn::StoreU(hn::Mul(sum0, vector_scale), d, out + i);
    hn::StoreU(hn::Mul(sum1, vector_scale), d, out + i + n);
    hn::StoreU(hn::Mul(sum2, vector_scale), d, out + i + 2 * n);
    hn::StoreU(hn::Mul(sum3, vector_scale), d, out + i + 3 * n);
  }

  void run(std::size_t count, float* out) const {
    const FloatTag d;
    const hn::CappedTag<float, 4> small;
    const std::size_t n = hn::Lanes(d), few = hn::Lanes(small);
    std::size_t i = 0;
    for (; i + 4 * n <= count; i += 4 * n)
      four(i, out);
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

struct Workspace {
  HWY_ALIGN float floats[kMaxOctaves * 10 * kMaxNoiseAxis];
  HWY_ALIGN std::uint32_t cells[kMaxOctaves * kMaxNoiseAxis + kMaxNoiseAxis];
  HWY_ALIGN std::uint32_t keys[kMaxOctaves * (2 * kMaxNoiseAxis + kPad)];
  HWY_ALIGN std::int32_t slots[kMaxOctaves * 2 * kMaxNoiseAxis];
};

void evaluate(const RidgedKernel& kernel, std::span<const std::int64_t> columns,
              std::span<const std::int64_t> rows, float* values, std::size_t stride) {
  const auto octave_count = static_cast<std::size_t>(kernel.octave_count);
  const std::size_t width = padded(columns.size()), depth = padded(rows.size());
  Workspace memory;
  GradientRow gradients;
  ColumnOctave column[kMaxOctaves];
  LatticeAxis row_axis[kMaxOctaves];
  RowOctave shared[kMaxOctaves];
  float* floats = memory.floats + octave_count * 4 * width;
  std::uint32_t* const column_cells = memory.cells;
  for (std::size_t o = 0; o < octave_count; ++o) {
    const RidgedOctave& octave = kernel.octaves[o];
    ColumnOctave& c = column[o];
    c.coefficients = memory.floats + o * 4 * width;
    c.stride = width;
    c.fraction = floats;
    c.fade = floats + width;
    c.blended_x = floats + 2 * width;
    c.blended_z = floats + 3 * width;
    c.key = memory.keys + o * (2 * width + kPad);
    c.first = memory.slots + o * 2 * width;
    c.slot = c.first + width;
    LatticeAxis{column_cells, c.fraction, c.fade}.locate(columns, octave.step, octave.origin_x);
    c.place_lattice(column_cells, columns.size(), octave.key_x);
    row_axis[o] = {memory.cells + width + o * depth, floats + 4 * width,
                   floats + 4 * width + depth};
    row_axis[o].locate(rows, octave.step, octave.origin_z);
    floats += 4 * width + 2 * depth;
    shared[o].next_limit = o + 1 < octave_count ? kernel.octaves[o + 1].limit : 0.0F;
  }
  const RowKernel row_kernel{memory.floats, width,         shared,
                             octave_count,  kernel.offset, kernel.result_scale};
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t o = 0; o < octave_count; ++o) {
      const std::uint32_t cell = row_axis[o].cell[r];
      if (r == 0 || cell != column[o].lattice_row) {
        const std::uint32_t key_z = kernel.octaves[o].key_z;
        if (r == 0 || cell != column[o].lattice_row + 1) {
          gradients.fill(column[o], cell + key_z, kernel.gradient_length);
          raise(column[o], gradients, false);
        }
        gradients.fill(column[o], cell + 1 + key_z, kernel.gradient_length);
        raise(column[o], gradients, true);
        column[o].lattice_row = cell;
      }
      shared[o].fraction = row_axis[o].fraction[r];
      shared[o].fade = row_axis[o].fade[r];
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
