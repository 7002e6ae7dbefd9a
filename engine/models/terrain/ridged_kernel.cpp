// The ridged multifractal on a grid. Between two lattice rows the noise of a column is
//   N = a + fz·b + u(fz)·(c + fz·d),
// where a … d are blended along x once per lattice row. So a sample takes three products per octave
// and neither hashing nor look-ups. A row of samples runs through all octaves in registers.
#include "engine/models/terrain/ridged_kernel.hpp"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/terrain/ridged_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "engine/models/terrain/ridged_ends-inl.hpp"
#include "engine/models/terrain/ridged_lattice-inl.hpp"
#include "engine/models/terrain/ridged_row-inl.hpp"
#include "engine/models/terrain/ridged_warp-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

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
  const RowOctaves along_z(kernel, Axis(rows));
  const std::size_t ends =
      warped || !along_z.contiguous ? 0 : EndColumns::count(columns.size(), rows.size());
  const std::size_t main_count = columns.size() - ends;
  const RowSettings settings{along_z.next_limit, octave_count, kernel.offset, kernel.result_scale};
  if (ends > 0)
    EndColumns(kernel, along_z, columns.last(ends)).write(settings, values + main_count, stride);
  Workspace memory;
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
