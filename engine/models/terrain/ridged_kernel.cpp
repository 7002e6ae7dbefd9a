// The ridged multifractal on a grid. Between two lattice rows the noise of a column is
//   N = a + fz·b + u(fz)·(c + fz·d),
// where a … d are blended along x once per lattice row. So a sample takes three products per octave
// and neither hashing nor look-ups. A row of samples runs through all octaves in registers. The
// last columns of a call, which would leave most lanes along x unused, have rows as lanes. With a
// domain warp, a field of low frequency displaces the coarse octaves. Then every sample finds its
// own lattice points, which takes about ten times as long as sharing them.
#include "engine/models/terrain/ridged_kernel.hpp"

#include <algorithm>
#include <bit>

#include "engine/models/kit/scratch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/terrain/ridged_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "engine/models/terrain/ridged_lattice-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

// Adds an octave's ridges, squared, to the sums, and finds the weights of the next octave.
template <class V>
HWY_INLINE void add_octave(V square, V limit, V& weight, V& sum) {
  const V signal = hn::Mul(weight, square);
  sum = hn::Add(sum, signal);
  weight = hn::Min(signal, limit);
}

// The square of a ridge. `value` and `slope` are those of the noise on the lower lattice row;
// `value_rise` and `slope_rise` lead to the upper row; `f` and `fade` are the position between
// them.
template <class V>
HWY_INLINE V square_of(V value, V slope, V value_rise, V slope_rise, V f, V fade, V offset) {
  const V low = hn::Add(value, hn::Mul(f, slope));
  const V more = hn::Add(value_rise, hn::Mul(f, slope_rise));
  const V noise = hn::Add(low, hn::Mul(fade, more));
  const V ridge = hn::Sub(offset, hn::Abs(noise));
  return hn::Mul(ridge, ridge);
}

// The position of one row between two lattice rows of each octave, kMaxNoiseAxis elements apart.
struct RowPlace {
  const float *fraction, *fade;
};

// Settings that all rows share.
struct RowSettings {
  const float* next_limit;  // of each octave: largest weight of the next one
  std::size_t octave_count;
  float offset, scale;
};

// Computes one row of samples.
struct RowKernel {
  const ColumnOctave* columns;
  RowSettings settings;
  RowPlace row;

  // The squares of octave o's ridges, for the columns that are `at` elements into the pairs of
  // vectors (ColumnOctave).
  template <class D, class V = hn::Vec<D>>
  HWY_INLINE V square(D d, std::size_t o, std::size_t at, V f, V fade, V offset) const {
    const float *const lower = columns[o].lower + at, *const rise = columns[o].rise + at;
    const std::size_t second = hn::Lanes(FloatTag());
    return square_of(hn::Load(d, lower), hn::Load(d, lower + second), hn::Load(d, rise),
                     hn::Load(d, rise + second), f, fade, offset);
  }

  // One vector of samples from column i on. D may have fewer lanes than the kernel's vectors.
  template <class D>
  HWY_INLINE hn::Vec<D> one(D d, std::size_t i) const {
    const RowSettings& s = settings;
    const std::size_t at = 2 * i - i % hn::Lanes(FloatTag());
    auto weight = hn::Set(d, 1.0F), sum = hn::Zero(d);
    for (std::size_t o = 0; o < s.octave_count; ++o)
      add_octave(square(d, o, at, hn::Set(d, row.fraction[o * kMaxNoiseAxis]),
                        hn::Set(d, row.fade[o * kMaxNoiseAxis]), hn::Set(d, s.offset)),
                 hn::Set(d, s.next_limit[o]), weight, sum);
    return hn::Mul(sum, hn::Set(d, s.scale));
  }

  // Four vectors at once. They share the row's numbers and hide each other's latency.
  HWY_INLINE void four(std::size_t i, float* HWY_RESTRICT out) const {
    const FloatTag d;
    const RowSettings& s = settings;
    const std::size_t n = hn::Lanes(d);
    const Float offset = hn::Set(d, s.offset), scale = hn::Set(d, s.scale);
    Float weight0 = hn::Set(d, 1.0F), weight1 = weight0, weight2 = weight0, weight3 = weight0;
    Float sum0 = hn::Zero(d), sum1 = sum0, sum2 = sum0, sum3 = sum0;
    const std::size_t at = 2 * i;
    for (std::size_t o = 0; o < s.octave_count; ++o) {
      const Float f = hn::Set(d, row.fraction[o * kMaxNoiseAxis]),
                  u = hn::Set(d, row.fade[o * kMaxNoiseAxis]), limit = hn::Set(d, s.next_limit[o]);
      add_octave(square(d, o, at, f, u, offset), limit, weight0, sum0);
      add_octave(square(d, o, at + 2 * n, f, u, offset), limit, weight1, sum1);
      add_octave(square(d, o, at + 4 * n, f, u, offset), limit, weight2, sum2);
      add_octave(square(d, o, at + 6 * n, f, u, offset), limit, weight3, sum3);
    }
    hn::StoreU(hn::Mul(sum0, scale), d, out + i);
    hn::StoreU(hn::Mul(sum1, scale), d, out + i + n);
    hn::StoreU(hn::Mul(sum2, scale), d, out + i + 2 * n);
    hn::StoreU(hn::Mul(sum3, scale), d, out + i + 3 * n);
  }

  // Writes `count` samples to `out`, which needs no alignment.
  void run(std::size_t count, float* HWY_RESTRICT out) const {
    const FloatTag d;
    const hn::CappedTag<float, 4> few;
    const std::size_t n = hn::Lanes(d), few_lanes = hn::Lanes(few);
    std::size_t i = 0;
    for (; i + 4 * n <= count; i += 4 * n)
      four(i, out);
    for (; i + n <= count; i += n)
      hn::StoreU(one(d, i), d, out + i);
    if (count - i > n / 2) return hn::BlendedStore(one(d, i), hn::FirstN(d, count - i), d, out + i);
    for (; i < count; i += few_lanes)
      hn::BlendedStore(one(few, i), hn::FirstN(few, std::min(few_lanes, count - i)), few, out + i);
  }
};

// The positions of the rows on the lattices, octave after octave, kMaxNoiseAxis apart. They are all
// computed before the first row of samples, which would otherwise wait for them.
struct RowOctaves {
  std::size_t count, width;  // number of rows; the same padded to whole vectors
  HWY_ALIGN std::uint32_t cell[kMaxOctaves * kMaxNoiseAxis + kPad];
  HWY_ALIGN float fraction[kMaxOctaves * kMaxNoiseAxis];
  HWY_ALIGN float fade[kMaxOctaves * kMaxNoiseAxis];
  float next_limit[kMaxOctaves];
  bool contiguous = true;  // no row of samples skips a lattice row of any octave
  std::uint32_t
      changed[kMaxNoiseAxis + 1];  // of each row: bits of the octaves that enter another cell

  // At most kMaxNoiseAxis rows.
  RowOctaves(const RidgedKernel& kernel, const Axis& rows)
      : count(rows.at.size()), width(padded(rows.at.size())) {
    const auto octave_count = static_cast<std::size_t>(kernel.octave_count);
    HWY_ALIGN std::uint64_t position[kMaxNoiseAxis];
    for (std::size_t o = 0; o < octave_count; ++o) {
      const RidgedOctave& octave = kernel.octaves[o];
      next_limit[o] = o + 1 < octave_count ? kernel.octaves[o + 1].limit : 0.0F;
      contiguous = contiguous && rows.contiguous(octave.step);
      rows.place(octave.step, octave.origin_z, position);
      const std::size_t at = o * kMaxNoiseAxis;
      locate(position, width, cell + at, fraction + at, fade + at);
    }
    find_changes(octave_count);
  }

 private:
  void find_changes(std::size_t octave_count) {
    const UintTag du;
    changed[0] = (1U << octave_count) - 1;
    for (std::size_t r = 0; r < width; r += hn::Lanes(du)) {
      auto bits = hn::Zero(du);
      for (std::size_t o = 0; o < octave_count; ++o) {
        const std::uint32_t* const cells = cell + o * kMaxNoiseAxis + r;
        const auto differs = hn::Ne(hn::LoadU(du, cells + 1), hn::Load(du, cells));
        bits = hn::Or(bits, hn::IfThenElseZero(differs, hn::Set(du, 1U << o)));
      }
      hn::StoreU(bits, du, changed + 1 + r);
    }
  }
};

// The last columns of a call. Requires RowOctaves::contiguous.
class EndColumns {
 public:
  // The number of columns, from the last, that are faster with rows as lanes.
  static std::size_t count(std::size_t columns, std::size_t rows) {
    const std::size_t lanes = hn::Lanes(FloatTag()), rest = columns % lanes;
    return rest <= kMax && columns > lanes && rows >= 16 * rest ? rest : 0;
  }

  // Prepares count() columns. `kernel` and `rows` must outlive it.
  EndColumns(const RidgedKernel& kernel, const RowOctaves& rows,
             std::span<const std::int64_t> columns)
      : kernel_(kernel), rows_(rows), count_(columns.size()) {
    for (std::size_t c = 0; c < count_; ++c)
      places_[c].find(kernel, columns[c]);
    for (std::size_t o = 0; o < static_cast<std::size_t>(kernel.octave_count); ++o)
      blend_rows(o);
  }

  // Writes values[r · stride + c] for all rows and these columns.
  void write(const RowSettings& settings, float* values, std::size_t stride) const {
    const FloatTag d;
    HWY_ALIGN float result[kMaxNoiseAxis];
    for (std::size_t c = 0; c < count_; ++c) {
      for (std::size_t r = 0; r < rows_.count; r += hn::Lanes(d))
        hn::Store(one(settings, c, r), d, result + r);
      for (std::size_t r = 0; r < rows_.count; ++r)
        values[r * stride + c] = result[r];
    }
  }

 private:
  static constexpr std::size_t kMax = 3;
  static constexpr std::size_t kLines = kMaxNoiseAxis + 3 * kPad;

  // The position of one column on the lattice of each octave.
  struct Place {
    HWY_ALIGN std::uint32_t cell[kPad];
    HWY_ALIGN float fraction[kPad], fade[kPad];

    void find(const RidgedKernel& kernel, std::int64_t column) {
      HWY_ALIGN std::uint64_t position[kPad];
      for (std::size_t o = 0; o < kPad; ++o)
        position[o] = static_cast<std::uint64_t>(column) * kernel.octaves[o].step +
                      kernel.octaves[o].origin_x;
      locate(position, kPad, cell, fraction, fade);
    }
  };

  // Blends all lattice rows of an octave along x, at every column.
  void blend_rows(std::size_t o) {
    const FloatTag d;
    const UintTag du;
    const RidgedOctave& octave = kernel_.octaves[o];
    const std::uint32_t* const rows = rows_.cell + o * kMaxNoiseAxis;
    const std::size_t count = rows[rows_.width - 1] - rows[0] + 2;
    const Float length = hn::Set(d, kernel_.amplitude);
    for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
      const auto hash =
          mix32(du, counting_from(du, rows[0] + octave.key_z + static_cast<std::uint32_t>(k)));
      const auto along = [&](std::uint32_t cell) {
        return lattice_point(hn::Set(du, cell + octave.key_x), hash, length);
      };
      LatticePoint left = along(places_[0].cell[o]), right = along(places_[0].cell[o] + 1);
      for (std::size_t c = 0; c < count_; ++c) {
        const std::uint32_t cell = places_[c].cell[o];
        if (c > 0 && cell != places_[c - 1].cell[o]) {
          left = cell == places_[c - 1].cell[o] + 1 ? right : along(cell);
          right = along(cell + 1);
        }
        const float t = places_[c].fraction[o], u = places_[c].fade[o];
        const Blend b = blend(left, right, hn::Set(d, t * (1.0F - u)), hn::Set(d, (t - 1.0F) * u),
                              hn::Set(d, u));
        hn::Store(b.value, d, values_[c][o] + k);
        hn::Store(b.slope, d, slopes_[c][o] + k);
      }
    }
  }

  // The samples of column `c` for the vector of rows from r on.
  HWY_INLINE Float one(const RowSettings& settings, std::size_t c, std::size_t r) const {
    const FloatTag d;
    const UintTag du;
    const Float offset = hn::Set(d, settings.offset);
    Float weight = hn::Set(d, 1.0F), sum = hn::Zero(d);
    for (std::size_t o = 0; o < settings.octave_count; ++o) {
      const std::size_t at = o * kMaxNoiseAxis + r;
      const std::size_t lower = rows_.cell[at] - rows_.cell[at - r];
      const auto slots = hn::Sub(hn::Load(du, rows_.cell + at), hn::Set(du, rows_.cell[at]));
      const auto indices = hn::IndicesFromVec(d, hn::BitCast(IntTag(), slots));
      const auto row = [&](std::size_t first) -> Blend {
        return {hn::TableLookupLanes(hn::LoadU(d, values_[c][o] + first), indices),
                hn::TableLookupLanes(hn::LoadU(d, slopes_[c][o] + first), indices)};
      };
      const Blend below = row(lower), above = row(lower + 1);
      const Float rise = hn::Sub(hn::Sub(above.value, above.slope), below.value);
      add_octave(square_of(below.value, below.slope, rise, hn::Sub(above.slope, below.slope),
                           hn::Load(d, rows_.fraction + at), hn::Load(d, rows_.fade + at), offset),
                 hn::Set(d, settings.next_limit[o]), weight, sum);
    }
    return hn::Mul(sum, hn::Set(d, settings.scale));
  }

  const RidgedKernel& kernel_;
  const RowOctaves& rows_;
  const std::size_t count_;
  Place places_[kMax];
  HWY_ALIGN float values_[kMax][kMaxOctaves][kLines], slopes_[kMax][kMaxOctaves][kLines];
};

// The columns of an octave whose samples do not lie in rows, so nothing is shared.
struct FreeOctave {
  HWY_ALIGN std::uint32_t cell[kMaxNoiseAxis];
  HWY_ALIGN float fraction[kMaxNoiseAxis];
  RidgedOctave settings;
  float amplitude;

  // Finds the cells and fractions of the columns. `length` is that of gradients.
  void prepare(const RidgedOctave& octave, float length, const Axis& axis) {
    HWY_ALIGN std::uint64_t position[kMaxNoiseAxis];
    HWY_ALIGN float fade[kMaxNoiseAxis];
    settings = octave;
    amplitude = length;
    axis.place(octave.step, octave.origin_x, position);
    locate(position, padded(axis.at.size()), cell, fraction, fade);
  }

  // The noise of the columns from i on in row `row`, displaced by dx and dz cells.
  Float at(std::size_t i, std::int64_t row, Float dx, Float dz) const {
    const FloatTag d;
    const UintTag du;
    const std::uint64_t q = static_cast<std::uint64_t>(row) * settings.step + settings.origin_z;
    const auto bits = static_cast<std::int32_t>((q >> 8) & 0xFFFFFFU);
    auto ix = hn::Add(hn::Load(du, cell + i), hn::Set(du, settings.key_x));
    auto iz = hn::Set(du, static_cast<std::uint32_t>(q >> 32) + settings.key_z);
    const Float fx = move(hn::Load(d, fraction + i), dx, ix);
    const Float fz = move(hn::Set(d, static_cast<float>(bits) * 0x1.0p-24F), dz, iz);
    const auto one = hn::Set(du, 1U);
    const Float fade = fade_of(fx);
    const Float left = hn::Mul(fx, hn::Sub(hn::Set(d, 1.0F), fade));
    const Float right = hn::Mul(hn::Sub(fx, hn::Set(d, 1.0F)), fade);
    const auto along = [&](hn::Vec<UintTag> lattice_row) {
      const auto hash = mix32(du, lattice_row);
      const Float length = hn::Set(d, amplitude);
      return blend(lattice_point(ix, hash, length), lattice_point(hn::Add(ix, one), hash, length),
                   left, right, fade);
    };
    const Blend lower = along(iz), upper = along(hn::Add(iz, one));
    const Float low = hn::Add(lower.value, hn::Mul(fz, lower.slope));
    const Float rise = hn::Add(hn::Sub(hn::Sub(upper.value, upper.slope), lower.value),
                               hn::Mul(fz, hn::Sub(upper.slope, lower.slope)));
    return hn::Add(low, hn::Mul(fade_of(fz), rise));
  }

 private:
  static HWY_INLINE Float fade_of(Float f) {
    const FloatTag d;
    const Float inner = hn::Sub(hn::Mul(f, hn::Set(d, 6.0F)), hn::Set(d, 15.0F));
    return hn::Mul(hn::Mul(hn::Mul(f, f), f), hn::Add(hn::Mul(f, inner), hn::Set(d, 10.0F)));
  }
  static HWY_INLINE Float move(Float f, Float by, hn::Vec<UintTag>& cells) {
    const Float sum = hn::Add(f, by), whole = hn::Floor(sum);
    cells = hn::Add(cells, hn::BitCast(UintTag(), hn::ConvertTo(IntTag(), whole)));
    return hn::Sub(sum, whole);
  }
};

// Displaces the coarse octaves by a field of low frequency.
struct Warp {
  FreeOctave field_x, field_z;
  FreeOctave octaves[kWarpedOctaves];
  std::size_t octave_count;

  // For the columns of `axis`. Requires kernel.warp > 0.
  Warp(const RidgedKernel& kernel, const Axis& axis)
      : octave_count(static_cast<std::size_t>(std::min(kernel.octave_count, kWarpedOctaves))) {
    constexpr float kLength = 0.828427125F;  // with it, noise is at most 1
    field_x.prepare(kernel.warp_field[0], kernel.warp * kLength, axis);
    field_z.prepare(kernel.warp_field[1], kernel.warp * kLength, axis);
    for (std::size_t o = 0; o < octave_count; ++o)
      octaves[o].prepare(kernel.octaves[o], kernel.amplitude, axis);
  }

  // Writes the noise of one row into the columns, as octaves that are constant along z.
  void write(std::int64_t row, const std::array<float, kWarpedOctaves>& cells_ratio,
             ColumnOctave* columns) const {
    const FloatTag d;
    for (std::size_t i = 0; i < columns[0].stride; i += hn::Lanes(d)) {
      const Float dx = field_x.at(i, row, hn::Zero(d), hn::Zero(d));
      const Float dz = field_z.at(i, row, hn::Zero(d), hn::Zero(d));
      for (std::size_t o = 0; o < octave_count; ++o) {
        const Float ratio = hn::Set(d, cells_ratio[o]);
        hn::Store(octaves[o].at(i, row, hn::Mul(dx, ratio), hn::Mul(dz, ratio)), d,
                  columns[o].lower + 2 * i);
      }
    }
  }
};

// The working memory of one call. Every array starts at a multiple of 64 bytes.
struct Workspace {
  HWY_ALIGN float floats[kMaxOctaves * 9 * kMaxNoiseAxis];
  HWY_ALIGN float fractions[kMaxNoiseAxis];
  HWY_ALIGN std::uint32_t integers[kMaxOctaves * (4 * kMaxNoiseAxis + kPad)];
  HWY_ALIGN std::int32_t slots[kMaxOctaves * kMaxNoiseAxis];
  HWY_ALIGN std::uint64_t positions[kMaxNoiseAxis];
  HWY_ALIGN std::uint32_t cells[kMaxNoiseAxis];
  LatticeRow lattice_rows[kMaxOctaves];
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
    c.lines.key = u;
    c.lines.first = u + 2 * width + kPad;
    c.lines.slot = slots + index * width;
    axis.place(octave.step, octave.origin_x, positions);
    locate(positions, width, cells, fractions, c.fade);
    const FloatTag d;
    const Float one = hn::Set(d, 1.0F);
    for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
      const Float t = hn::Load(d, fractions + i), fade = hn::Load(d, c.fade + i);
      hn::Store(hn::Mul(t, hn::Sub(one, fade)), d, c.left_x + i);
      hn::Store(hn::Mul(hn::Sub(t, one), fade), d, c.right_x + i);
    }
    c.lines.place(cells, width, axis.contiguous(octave.step), octave.key_x);
  }
};

// Moves the octaves in the bit set `in_rows`, whose samples lie in rows, to the lattice cells of
// row r.
void move_to(std::size_t r, std::uint32_t in_rows, const RidgedKernel& kernel,
             const RowOctaves& along_z, Workspace& memory) {
  for (std::uint32_t changed = along_z.changed[r] & in_rows; changed != 0; changed &= changed - 1) {
    const auto o = static_cast<std::size_t>(std::countr_zero(changed));
    ColumnOctave& octave = memory.columns[o];
    LatticeRow& row = memory.lattice_rows[o];
    const std::uint32_t cell = along_z.cell[o * kMaxNoiseAxis + r],
                        key = cell + kernel.octaves[o].key_z;
    const bool next = r > 0 && cell == octave.lattice_row + 1;
    if (!next) raise_to<true>(octave, row, key, kernel.amplitude);
    raise_to<false>(octave, row, key + 1, kernel.amplitude);
    // Hashes the next lattice row ahead of its use, to hide the latency.
    const std::uint32_t last = along_z.cell[o * kMaxNoiseAxis + along_z.count - 1];
    if (next && along_z.contiguous && cell != last) row.hold(octave, key + 2, kernel.amplitude);
    octave.lattice_row = cell;
  }
}

// Writes all rows of samples. `warp` may be null.
void write_rows(const RidgedKernel& kernel, std::span<const std::int64_t> rows,
                const RowOctaves& along_z, const RowSettings& settings, std::size_t column_count,
                const Warp* warp, Workspace& memory, float* values, std::size_t stride) {
  RowKernel row_kernel{memory.columns, settings, {}};
  const std::uint32_t in_rows = warp == nullptr ? ~0U : ~0U << warp->octave_count;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (warp != nullptr) warp->write(rows[r], kernel.cells_ratio, memory.columns);
    move_to(r, in_rows, kernel, along_z, memory);
    row_kernel.row = {along_z.fraction + r, along_z.fade + r};
    row_kernel.run(column_count, values + r * stride);
  }
}

void evaluate(const RidgedKernel& kernel, std::span<const std::int64_t> columns,
              std::span<const std::int64_t> rows, float* values, std::size_t stride) {
  const auto octave_count = static_cast<std::size_t>(kernel.octave_count);
  const bool warped = kernel.warp > 0;
  const Scratch<RowOctaves> scratch_z(kernel, Axis(rows));
  const RowOctaves& along_z = *scratch_z;
  const std::size_t ends =
      warped || !along_z.contiguous ? 0 : EndColumns::count(columns.size(), rows.size());
  const std::size_t main_count = columns.size() - ends;
  const RowSettings settings{along_z.next_limit, octave_count, kernel.offset, kernel.result_scale};
  if (ends > 0)
    Scratch<EndColumns>(kernel, along_z, columns.last(ends))
        ->write(settings, values + main_count, stride);
  const Scratch<Workspace> scratch;
  Workspace& memory = *scratch;
  const Axis column_axis(columns.first(main_count));
  for (std::size_t o = 0; o < octave_count; ++o)
    memory.prepare(o, kernel.octaves[o], column_axis);
  if (!warped)
    return write_rows(kernel, rows, along_z, settings, main_count, nullptr, memory, values, stride);
  const Warp warp(kernel, column_axis);
  for (std::size_t o = 0; o < warp.octave_count; ++o)
    memory.columns[o].clear();
  write_rows(kernel, rows, along_z, settings, main_count, &warp, memory, values, stride);
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
