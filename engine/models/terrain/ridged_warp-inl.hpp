// Domain warp: the coarse octaves of ridged noise, sampled at points that a field of low frequency
// displaces. Every sample finds its own lattice points, which takes about ten times as long as
// sharing them. Only ridged_kernel.cpp includes it, once per instruction set; hence the unusual
// include guard.
#if defined(PSYGEN_MODELS_RIDGED_WARP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_RIDGED_WARP_INL
#undef PSYGEN_MODELS_RIDGED_WARP_INL
#else
#define PSYGEN_MODELS_RIDGED_WARP_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>

#include "engine/models/terrain/ridged_lattice-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

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

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
