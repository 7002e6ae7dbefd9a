// A row of vertices at a time: heights are quantised, normals come from the samples on four sides,
// and the heights of the next coarser level from its triangles. Heights and their weighted sums are
// integers below 2^24, which single precision represents exactly.
#include "engine/models/terrain_kernel.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "engine/core/vertex_layout.hpp"
#include "engine/models/terrain_grid.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/terrain_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "engine/models/terrain_spread-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, 16>;
using IntTag = hn::RebindToSigned<FloatTag>;
using UintTag = hn::RebindToUnsigned<FloatTag>;
using Float = hn::Vec<FloatTag>;

constexpr std::size_t kRow = kMaxTerrainSize + 16;  // a row of vertices and the padding of vectors

HWY_INLINE Float set(float value) {
  return hn::Set(FloatTag(), value);
}

// Sums with this number have the nearest integer (halves to even) in their low bits, as in
// packing.hpp.
constexpr float kToInteger = 12582912.0F;

// A height, at most 65535, plus kToInteger.
HWY_INLINE Float quantise(Float noise, Float quantum) {
  return hn::Add(hn::Min(hn::Mul(noise, quantum), set(65535.0F)), set(kToInteger));
}

// Heights on the triangles of coarser samples, `ratio` vertices apart. On the lower left
// half of a cell the sum of the corners' heights with whole weights is linear in the row, and so it
// is on the upper right half: what depends on the column is found once per row of cells.
class CoarseHeights {
 public:
  explicit CoarseHeights(const TerrainSurface& surface)
      : s_(surface),
        c_(surface.coarse),
        columns_(last_of(c_.phase_x) + 1),
        last_row_(last_of(c_.phase_z)),
        ratio_(static_cast<float>(c_.ratio)) {
    const std::size_t lanes = hn::Lanes(FloatTag());
    std::size_t cell = 0, along = c_.phase_x;
    for (std::size_t x = 0; x < s_.n + lanes; ++x) {
      along_[x] = static_cast<float>(along);
      if (x % lanes == 0) first_[x / lanes] = cell;
      slot_[x] = static_cast<std::int32_t>(cell - first_[x / lanes]);
      if (++along == c_.ratio && cell + 1 < columns_) {
        along = 0;
        ++cell;
      }
    }
    load(0);
  }

  // Moves on to a row of vertices, from 0 without gaps.
  void move_to(std::size_t z) {
    const std::size_t row = (z + c_.phase_z) / c_.ratio;
    across_ = static_cast<float>((z + c_.phase_z) % c_.ratio);
    if (across_ != 0 && z != 0) return;
    std::swap(near_, far_);
    load(std::min(row + 1, last_row_));
    find_planes();
  }

  // The heights of the vertices from x on, in the low 16 bits: rounded to nearest, halves upwards.
  HWY_INLINE hn::Vec<IntTag> at(std::size_t x) const {
    const FloatTag d;
    const Float across = set(across_), rest = set(ratio_ - across_);
    const Float low = hn::Add(hn::Load(d, low_ + x), hn::Mul(across, hn::Load(d, low_rise_ + x)));
    const Float high = hn::Add(hn::Load(d, high_ + x), hn::Mul(rest, hn::Load(d, high_rise_ + x)));
    const Float sum = hn::IfThenElse(hn::Le(hn::Load(d, along_ + x), rest), low, high);
    // The quarter decides halves; up to this ratio it outweighs the errors of single precision.
    if (c_.ratio <= 32)
      return hn::BitCast(IntTag(), hn::Add(hn::Mul(hn::Add(sum, set(0.25F)), set(1.0F / ratio_)),
                                           set(kToInteger)));
    // An estimate from below is right or one too low, which the remainder tells.
    const Float divisor = set(2.0F * ratio_);
    const Float dividend = hn::Add(hn::Add(sum, sum), set(ratio_));
    const Float inverse = set((1.0F - 0x1p-20F) / (2.0F * ratio_));
    const auto estimate = hn::ConvertTo(IntTag(), hn::Mul(dividend, inverse));
    const Float remainder = hn::Sub(dividend, hn::Mul(hn::ConvertTo(d, estimate), divisor));
    const auto too_low = hn::RebindMask(IntTag(), hn::Ge(remainder, divisor));
    return hn::Sub(estimate, hn::VecFromMask(IntTag(), too_low));
  }

 private:
  // The coarse heights left and right of every vertex of one coarse row.
  struct Row {
    HWY_ALIGN float left[kRow];
    HWY_ALIGN float right[kRow];
  };

  // The number of the sample at the level's end or, where there is none, of the first beyond.
  std::size_t last_of(std::size_t phase) const {
    return (s_.n - 1 + phase + c_.ratio - 1) / c_.ratio;
  }

  // Makes a row of the samples the far one.
  void load(std::size_t row) {
    const FloatTag d;
    HWY_ALIGN float height[kRow + 33];
    const std::size_t count = columns_;
    const float* const samples = c_.first + row * c_.row_stride * c_.step;
    for (std::size_t i = 0; i < count; ++i)
      height[i] = samples[i * c_.step];
    std::fill(height + count, height + count + 33, height[count - 1]);
    const Float quantum = set(s_.quantum);
    for (std::size_t i = 0; i <= count; i += hn::Lanes(d))
      hn::Store(hn::Sub(quantise(hn::Load(d, height + i), quantum), set(kToInteger)), d,
                height + i);
    for (std::size_t x = 0, block = 0; x < s_.n; x += hn::Lanes(d), ++block) {
      const auto slots = hn::IndicesFromVec(d, hn::Load(IntTag(), slot_ + x));
      const float* const left = height + first_[block];
      hn::Store(hn::TableLookupLanes(hn::LoadU(d, left), slots), d, far_->left + x);
      hn::Store(hn::TableLookupLanes(hn::LoadU(d, left + 1), slots), d, far_->right + x);
    }
  }

  void find_planes() {
    const FloatTag d;
    for (std::size_t x = 0; x < s_.n; x += hn::Lanes(d)) {
      const Float h00 = hn::Load(d, near_->left + x), h10 = hn::Load(d, near_->right + x);
      const Float h01 = hn::Load(d, far_->left + x), h11 = hn::Load(d, far_->right + x);
      const Float along = hn::Load(d, along_ + x), ratio = set(ratio_);
      hn::Store(hn::Add(hn::Mul(h00, ratio), hn::Mul(along, hn::Sub(h10, h00))), d, low_ + x);
      hn::Store(hn::Sub(h01, h00), d, low_rise_ + x);
      hn::Store(hn::Add(hn::Mul(h11, ratio), hn::Mul(hn::Sub(ratio, along), hn::Sub(h01, h11))), d,
                high_ + x);
      hn::Store(hn::Sub(h10, h11), d, high_rise_ + x);
    }
  }

  const TerrainSurface& s_;
  const CoarseSamples& c_;
  const std::size_t columns_, last_row_;  // of the coarse samples
  const float ratio_;
  float across_ = 0;             // cells from the coarse row before
  HWY_ALIGN float along_[kRow];  // cells from the coarse vertex on the left
  // The coarse vertex on the left is number first + slot, first being that of the whole vector.
  HWY_ALIGN std::int32_t slot_[kRow];
  std::size_t first_[kRow];
  Row rows_[2];
  Row *near_ = &rows_[0], *far_ = &rows_[1];
  HWY_ALIGN float low_[kRow];
  HWY_ALIGN float low_rise_[kRow];
  HWY_ALIGN float high_[kRow];
  HWY_ALIGN float high_rise_[kRow];
};

// The light of one row of vertices after another.
class LightRows {
 public:
  explicit LightRows(const TerrainSurface& s)
      : s_(s), l_(s.light), spread_(s.n, l_.phase_x, s.stride, l_.spacing) {
    load(0, *near_);
    load(1, *far_);
  }

  // Moves on to a row of vertices, upwards.
  void move_to(std::size_t z) {
    const std::size_t cell = l_.phase_z + z * s_.stride, row = cell / l_.spacing;
    weight_ = static_cast<float>(cell % l_.spacing) / static_cast<float>(l_.spacing);
    if (row == row_) return;
    std::swap(near_, far_);
    if (row != row_ + 1) load(row, *near_);
    load(row + 1, *far_);
    row_ = row;
  }

  // Sun in the low byte and ambient above it, of the vertices from x on.
  HWY_INLINE hn::Vec<UintTag> at(std::size_t x) const {
    return hn::Or(byte(near_->sun + x, far_->sun + x),
                  hn::ShiftLeft<8>(byte(near_->ambient + x, far_->ambient + x)));
  }

 private:
  struct Row {
    HWY_ALIGN float sun[kRow];
    HWY_ALIGN float ambient[kRow];
  };

  void load(std::size_t row, Row& to) const {
    const FloatTag d;
    const float* const sun = l_.sun + row * l_.row_stride;
    const float* const ambient = l_.ambient + row * l_.row_stride;
    for (std::size_t x = 0; x < s_.n; x += hn::Lanes(d)) {
      hn::Store(spread_.at(sun, x), d, to.sun + x);
      hn::Store(spread_.at(ambient, x), d, to.ambient + x);
    }
  }

  HWY_INLINE hn::Vec<UintTag> byte(const float* near, const float* far) const {
    const FloatTag d;
    const Float a = hn::Load(d, near), b = hn::Load(d, far);
    const Float value = hn::Add(a, hn::Mul(set(weight_), hn::Sub(b, a)));
    return hn::And(hn::BitCast(UintTag(), hn::Add(value, set(kToInteger))),
                   hn::Set(UintTag(), 0xFFU));
  }

  const TerrainSurface& s_;
  const LightSamples& l_;
  const Spread<kMaxTerrainSize> spread_;
  std::size_t row_ = 0;
  float weight_ = 0;
  Row rows_[2];
  Row *near_ = &rows_[0], *far_ = &rows_[1];
};

// The samples of one row of vertices and those on their four sides.
struct SampleRow {
  const float *centre, *west, *east, *north, *south;
  HWY_ALIGN float copies[5 * kRow];

  void load(const TerrainSurface& s, std::size_t z) {
    centre = s.first + z * s.row_stride * s.step;
    west = centre - 1;
    east = centre + 1;
    north = centre - s.row_stride;
    south = centre + s.row_stride;
    if (s.step == 1) return;
    float* to = copies;
    for (const float** side : {&centre, &west, &east, &north, &south}) {
      for (std::size_t x = 0; x < s.n; ++x)
        to[x] = (*side)[x * s.step];
      std::fill(to + s.n, to + kRow, to[s.n - 1]);
      *side = to;
      to += kRow;
    }
  }
};

// The component of an octahedral normal as snorm8 in the low byte.
HWY_INLINE hn::Vec<UintTag> component(Float slope, Float to_snorm8) {
  return hn::BitCast(UintTag(), hn::Add(hn::Mul(slope, to_snorm8), set(kToInteger)));
}

// Both components in the upper half of 32 bits.
HWY_INLINE hn::Vec<UintTag> normals(const SampleRow& row, std::size_t x, Float scale) {
  const FloatTag d;
  const UintTag du;
  const Float east_west = hn::Sub(hn::LoadU(d, row.west + x), hn::LoadU(d, row.east + x));
  const Float south_north = hn::Sub(hn::LoadU(d, row.north + x), hn::LoadU(d, row.south + x));
  const Float nx = hn::Mul(east_west, scale), nz = hn::Mul(south_north, scale);
  const Float length = hn::Add(hn::Add(hn::Abs(nx), set(1.0F)), hn::Abs(nz));
  const Float to_snorm8 = hn::Div(set(127.0F), length);
  const auto low = hn::And(component(nx, to_snorm8), hn::Set(du, 0xFFU));
  return hn::Or(hn::ShiftLeft<16>(low), hn::ShiftLeft<24>(component(nz, to_snorm8)));
}

// A vertex as its bytes lie in memory.
struct PackedVertex {
  std::uint32_t low, high, light;
};
static_assert(sizeof(PackedVertex) == sizeof(core::TerrainVertex));

HeightRange pack(const TerrainSurface& s, std::byte* out) {
  const FloatTag d;
  const UintTag du;
  CoarseHeights coarse(s);
  LightRows light(s);
  SampleRow samples;
  HWY_ALIGN std::uint32_t grid_x[kRow];
  HWY_ALIGN PackedVertex row[kRow];
  PackedVertex skirt[4 * kMaxTerrainSize];
  for (std::size_t x = 0; x < s.n + hn::Lanes(d); ++x)
    grid_x[x] = static_cast<std::uint32_t>(x * s.stride) & 0xFFU;
  const Float quantum = set(s.quantum), slope_scale = set(s.slope_scale);
  Float lowest = set(65535.0F + kToInteger), highest = set(kToInteger);
  const std::size_t last = s.n - 1;
  for (std::size_t z = 0; z < s.n; ++z) {
    coarse.move_to(z);
    light.move_to(z);
    samples.load(s, z);
    const auto grid_z = hn::Set(du, static_cast<std::uint32_t>(z * s.stride) << 8);
    for (std::size_t x = 0; x < s.n; x += hn::Lanes(d)) {
      Float height = quantise(hn::LoadU(d, samples.centre + x), quantum);
      const auto low = hn::Or(hn::Or(hn::Load(du, grid_x + x), grid_z),
                              hn::ShiftLeft<16>(hn::BitCast(du, height)));
      const auto below = hn::And(hn::BitCast(du, coarse.at(x)), hn::Set(du, 0xFFFFU));
      const auto high = hn::Or(below, normals(samples, x, slope_scale));
      hn::StoreInterleaved3(low, high, light.at(x), du, reinterpret_cast<std::uint32_t*>(row + x));
      if (s.n - x < hn::Lanes(d)) height = hn::IfThenElse(hn::FirstN(d, s.n - x), height, lowest);
      lowest = hn::Min(lowest, height);
      if (s.n - x < hn::Lanes(d)) height = hn::IfThenElse(hn::FirstN(d, s.n - x), height, highest);
      highest = hn::Max(highest, height);
    }
    std::memcpy(out + z * s.n * sizeof(PackedVertex), row, s.n * sizeof(PackedVertex));
    // The border runs along +x, +z, −x and −z; every side has its first corner.
    if (z == 0) std::copy_n(row, last, skirt);
    if (z < last) skirt[last + z] = row[last];
    if (z == last) std::reverse_copy(row + 1, row + s.n, skirt + 2 * last);
    if (z > 0) skirt[4 * last - z] = row[0];
  }
  for (std::size_t k = 0; k < 4 * last; ++k)
    skirt[k].low |= core::kTerrainSkirtBit;
  std::memcpy(out + s.n * s.n * sizeof(PackedVertex), skirt, 4 * last * sizeof(PackedVertex));
  const float least = hn::GetLane(hn::MinOfLanes(d, lowest)) - kToInteger;
  const float most = hn::GetLane(hn::MaxOfLanes(d, highest)) - kToInteger;
  return {static_cast<std::uint16_t>(least), static_cast<std::uint16_t>(most)};
}

}  // namespace psygen::models::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace psygen::models {

HWY_EXPORT(pack);

HeightRange pack_terrain(const TerrainSurface& surface, std::byte* out) {
  return HWY_DYNAMIC_DISPATCH(pack)(surface, out);
}

}  // namespace psygen::models
#endif
