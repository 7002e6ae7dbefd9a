// The ridged multifractal on a grid. Between two lattice rows the noise of a column is
//   N = a + fz·b + u(fz)·(c + fz·d),
// where a … d are blended along x once per lattice row: three products a sample and octave, without
// hashing and without look-ups. A row of samples runs through all octaves in registers.
#include "engine/models/ridged_kernel.hpp"

#include <algorithm>
#include <bit>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/ridged_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "engine/models/ridged_lattice-inl.hpp"
#include "engine/models/ridged_warp-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

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
    clear_vectors(c.upper, 2 * width);
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
  std::optional<Warp> warp;
  std::uint32_t in_rows = ~0U;  // octaves whose samples lie in rows
  if (kernel.warp > 0) {
    warp.emplace(kernel, column_axis);
    in_rows <<= warp->octave_count;
    for (std::size_t o = 0; o < warp->octave_count; ++o)
      memory.columns[o].clear();
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (warp) warp->write(rows[r], kernel.cells_ratio, memory.columns);
    for (std::uint32_t changed = along_z.changed[r] & in_rows; changed != 0;
         changed &= changed - 1) {
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
