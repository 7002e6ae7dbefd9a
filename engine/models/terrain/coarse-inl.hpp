// Quantised heights, and the heights that the next coarser level has at the same vertices. Heights
// and their weighted sums are integers below 2^24, which single precision represents exactly. So
// sums have the same bits with and without fused multiply-add. Only kernel.cpp includes it, once
// per instruction set; hence the unusual include guard.
#if defined(PSYGEN_MODELS_TERRAIN_COARSE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PSYGEN_MODELS_TERRAIN_COARSE_INL
#undef PSYGEN_MODELS_TERRAIN_COARSE_INL
#else
#define PSYGEN_MODELS_TERRAIN_COARSE_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "engine/models/terrain/grid.hpp"
#include "engine/models/terrain/kernel.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Vectors of at most 16 numbers.
using FloatTag = hn::CappedTag<float, 16>;
using IntTag = hn::RebindToSigned<FloatTag>;
using UintTag = hn::RebindToUnsigned<FloatTag>;
using Float = hn::Vec<FloatTag>;

constexpr std::size_t kRow = kMaxTerrainSize + 16;  // a row of vertices and the padding of vectors

// `value` in every lane.
HWY_INLINE Float set(float value) {
  return hn::Set(FloatTag(), value);
}

// Adding this number leaves the nearest integer (halves to even) in the low bits, as in
// kit/packing.hpp.
constexpr float kToInteger = 12582912.0F;

// A quantised height, at most 65535, plus kToInteger.
HWY_INLINE Float quantise(Float noise, Float quantum) {
  return hn::Add(hn::Min(hn::Mul(noise, quantum), set(65535.0F)), set(kToInteger));
}

// Heights on the triangles of coarser samples, `ratio` vertices apart, row after row. On each of
// the two triangles of a cell, the sum of the corners' heights with integer weights is linear in
// the row. So the part that depends on the column is computed once per row of cells.
class CoarseHeights {
 public:
  // Starts at the first row. `surface` must outlive it.
  explicit CoarseHeights(const TerrainSurface& surface)
      : s_(surface),
        c_(surface.coarse),
        columns_(last_of(c_.phase_x) + 1),
        last_row_(last_of(c_.phase_z)),
        ratio_(static_cast<float>(c_.ratio)),
        inverse_(1.0F / ratio_),
        across_(static_cast<float>(c_.phase_z)) {
    quantise_samples();
    place_columns();
    for (std::size_t x = 0; x < s_.n; x += hn::Lanes(FloatTag())) {
      hn::Store(height(0, x), FloatTag(), left_ + x);
      hn::Store(height(1, x), FloatTag(), right_ + x);
    }
    find_planes(std::min<std::size_t>(1, last_row_));
  }

  // Moves on to the next row of vertices.
  void advance() {
    across_ += 1;
    if (across_ < ratio_) return;
    across_ = 0;
    ++row_;
    find_planes(std::min(row_ + 1, last_row_));
  }

  // Coarse heights of the vertices from x on, in the low 16 bits: rounded to nearest, halves up.
  HWY_INLINE hn::Vec<IntTag> at(std::size_t x) const {
    const FloatTag d;
    const Float across = set(across_), rest = set(ratio_ - across_);
    const Float low = hn::MulAdd(across, hn::Load(d, low_rise_ + x), hn::Load(d, low_ + x));
    const Float high = hn::MulAdd(rest, hn::Load(d, high_rise_ + x), hn::Load(d, high_ + x));
    const Float sum = hn::IfThenElse(hn::Le(hn::Load(d, along_ + x), rest), low, high);
    if (c_.ratio <= kLargestRatio)
      return hn::BitCast(IntTag(), hn::MulAdd(sum, set(inverse_), set(kToInteger)));
    // An estimate from below is correct or one too low. The remainder shows which.
    const Float divisor = set(2.0F * ratio_);
    const Float dividend = hn::Add(hn::Add(sum, sum), set(ratio_));
    const Float inverse = set((1.0F - 0x1p-20F) / (2.0F * ratio_));
    const auto estimate = hn::ConvertTo(IntTag(), hn::Mul(dividend, inverse));
    const Float remainder = hn::Sub(dividend, hn::Mul(hn::ConvertTo(d, estimate), divisor));
    const auto too_low = hn::RebindMask(IntTag(), hn::Ge(remainder, divisor));
    return hn::Sub(estimate, hn::VecFromMask(IntTag(), too_low));
  }

 private:
  // The number of the sample at the level's end, or of the first one beyond if there is none.
  std::size_t last_of(std::size_t phase) const {
    return (s_.n - 1 + phase + c_.ratio - 1) / c_.ratio;
  }

  // All samples beforehand: a vector load stalls on memory that scalar stores have just written.
  void quantise_samples() {
    const FloatTag d;
    stride_ = columns_ / 16 * 16 + 16;
    for (std::size_t row = 0; row <= last_row_; ++row)
      copy_samples(c_.first + row * c_.row_stride * c_.step, heights_ + row * stride_);
    const Float quantum = set(s_.quantum);
    for (std::size_t i = 0; i < (last_row_ + 1) * stride_; i += hn::Lanes(d))
      hn::Store(hn::Sub(quantise(hn::Load(d, heights_ + i), quantum), set(kToInteger)), d,
                heights_ + i);
  }

  HWY_INLINE void copy_samples(const float* from, float* to) const {
    const FloatTag d;
    std::size_t i = 0;
    // Level 1 of a block of 64 vertices has every third of them.
    if (c_.step == 2 || c_.step == 3) {
      for (; i + hn::Lanes(d) < columns_; i += hn::Lanes(d)) {
        Float wanted, second, third;
        if (c_.step == 2) {
          hn::LoadInterleaved2(d, from + 2 * i, wanted, second);
        } else {
          hn::LoadInterleaved3(d, from + 3 * i, wanted, second, third);
        }
        hn::Store(wanted, d, to + i);
      }
    }
    for (; i < columns_; ++i)
      to[i] = from[i * c_.step];
    to[columns_] = to[columns_ - 1];  // right of the last; vertices read nothing further right
  }

  void place_columns() {
    const FloatTag d;
    const IntTag di;
    for (std::size_t x = 0, block = 0; x < s_.n; x += hn::Lanes(d), ++block) {
      const Float along = hn::Add(hn::Iota(d, 0), set(static_cast<float>(x + c_.phase_x)));
      const Float cells = hn::Floor(hn::Mul(hn::Add(along, set(0.5F)), set(inverse_)));
      const Float cell = hn::Min(cells, set(static_cast<float>(columns_ - 1)));
      const auto number = hn::ConvertTo(di, cell);
      const std::int32_t first = hn::GetLane(number);
      first_[block] = static_cast<std::size_t>(first);
      hn::Store(hn::Sub(number, hn::Set(di, first)), di, slot_ + x);
      hn::Store(hn::Sub(along, hn::Mul(cell, set(ratio_))), d, along_ + x);
    }
  }

  // Heights of the coarse samples to the left of the vertices from x on, in the coarse row that
  // starts at `from`. With `from` + 1: of the samples to their right.
  HWY_INLINE Float height(std::size_t from, std::size_t x) const {
    const FloatTag d;
    const auto slots = hn::IndicesFromVec(d, hn::Load(IntTag(), slot_ + x));
    return hn::TableLookupLanes(hn::LoadU(d, heights_ + from + first_[x / hn::Lanes(d)]), slots);
  }

  // Finds the planes between the previous row of samples, whose heights it replaces, and this one.
  void find_planes(std::size_t row) {
    const FloatTag d;
    const Float quarter = set(c_.ratio <= kLargestRatio ? 0.25F : 0.0F);
    for (std::size_t x = 0; x < s_.n; x += hn::Lanes(d)) {
      const Float h00 = hn::Load(d, left_ + x), h10 = hn::Load(d, right_ + x);
      const Float h01 = height(row * stride_, x), h11 = height(row * stride_ + 1, x);
      const Float along = hn::Load(d, along_ + x), ratio = set(ratio_);
      hn::Store(h01, d, left_ + x);
      hn::Store(h11, d, right_ + x);
      const Float low = hn::MulAdd(h00, ratio, quarter), high = hn::MulAdd(h11, ratio, quarter);
      hn::Store(hn::MulAdd(along, hn::Sub(h10, h00), low), d, low_ + x);
      hn::Store(hn::Sub(h01, h00), d, low_rise_ + x);
      hn::Store(hn::MulAdd(hn::Sub(ratio, along), hn::Sub(h01, h11), high), d, high_ + x);
      hn::Store(hn::Sub(h10, h11), d, high_rise_ + x);
    }
  }

  // Up to this ratio, sums are a quarter too large. The quarter rounds halves up and is larger than
  // the rounding errors of single precision.
  static constexpr std::size_t kLargestRatio = 32;
  // Largest number of coarse samples along one side.
  static constexpr std::size_t kMax = kMaxTerrainSize / 2 + 2;

  const TerrainSurface& s_;
  const CoarseSamples& c_;
  const std::size_t columns_, last_row_;  // of the coarse samples
  const float ratio_, inverse_;
  float across_;                 // cells from the previous coarse row
  std::size_t row_ = 0;          // number of that row
  HWY_ALIGN float along_[kRow];  // cells from the coarse vertex on the left
  // The coarse vertex on the left has number first + slot; `first` is the same for a whole vector.
  HWY_ALIGN std::int32_t slot_[kRow];
  std::size_t first_[kRow];
  std::size_t stride_;
  HWY_ALIGN float heights_[kMax * (kMax + 16) + 32];
  HWY_ALIGN float left_[kRow], right_[kRow];  // coarse heights beside the vertices, of one row
  HWY_ALIGN float low_[kRow];
  HWY_ALIGN float low_rise_[kRow];
  HWY_ALIGN float high_[kRow];
  HWY_ALIGN float high_rise_[kRow];
};

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
