// Ridged noise with rows as lanes: the positions of all rows, and the samples of the last columns
// of a call, which would leave most lanes of a vector along x unused. Only ridged_kernel.cpp
// includes it, once per instruction set; hence the unusual include guard.
#if defined(PSYGEN_MODELS_RIDGED_ENDS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_RIDGED_ENDS_INL
#undef PSYGEN_MODELS_RIDGED_ENDS_INL
#else
#define PSYGEN_MODELS_RIDGED_ENDS_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/models/terrain/ridged_lattice-inl.hpp"
#include "engine/models/terrain/ridged_row-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

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

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
