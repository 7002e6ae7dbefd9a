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

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, 16>;
using IntTag = hn::RebindToSigned<FloatTag>;
using UintTag = hn::RebindToUnsigned<FloatTag>;
using Float = hn::Vec<FloatTag>;

constexpr std::size_t kRow = kMaxTerrainSize + 16;  // a row of vertices and the padding of vectors

// Nearest integer, at most 65535, of a height that is not negative.
HWY_INLINE hn::Vec<IntTag> quantise(Float noise, Float quantum) {
  const FloatTag d;
  const Float scaled = hn::Add(hn::Mul(noise, quantum), hn::Set(d, 0.5F));
  return hn::ConvertTo(IntTag(), hn::Min(scaled, hn::Set(d, 65535.0F)));
}

// Heights of the next coarser level.
class CoarseHeights {
 public:
  explicit CoarseHeights(const TerrainSurface& surface) : s_(surface) {
    const std::size_t lanes = hn::Lanes(FloatTag());
    std::size_t cell = 0, along = 0;
    for (std::size_t x = 0; x < kRow; ++x) {
      along_[x] = static_cast<float>(along);
      if (x % lanes == 0) first_[x] = cell;
      slot_[x] = static_cast<std::int32_t>(cell - first_[x / lanes * lanes]);
      if (++along == s_.ratio && x + 1 < s_.n) {
        along = 0;
        ++cell;
      }
    }
    load(0);
  }

  // Moves on to a row of vertices, from 0 without gaps.
  void move_to(std::size_t z) {
    across_ = z % s_.ratio;
    if (across_ != 0) return;
    std::swap(near_, far_);
    load(z + s_.ratio < s_.n ? z + s_.ratio : z);
  }

  // On the triangles, rounded to nearest, of the vertices from x on.
  HWY_INLINE hn::Vec<IntTag> at(std::size_t x) const {
    const FloatTag d;
    const auto ratio = static_cast<float>(s_.ratio), fz = static_cast<float>(across_);
    const Float fx = hn::Load(d, along_ + x), rest = hn::Set(d, ratio - fz);
    const Float w00 = hn::Max(hn::Sub(rest, fx), hn::Zero(d));
    const Float w10 = hn::Min(fx, rest);
    const Float w01 = hn::Min(hn::Set(d, fz), hn::Sub(hn::Set(d, ratio), fx));
    const Float w11 = hn::Max(hn::Sub(fx, rest), hn::Zero(d));
    const Float sum = hn::Add(hn::Add(hn::Mul(hn::Load(d, near_->left + x), w00),
                                      hn::Mul(hn::Load(d, near_->right + x), w10)),
                              hn::Add(hn::Mul(hn::Load(d, far_->left + x), w01),
                                      hn::Mul(hn::Load(d, far_->right + x), w11)));
    // (2 · sum + ratio) / (2 · ratio) in whole numbers: an estimate that is right or one too low.
    const Float divisor = hn::Set(d, 2.0F * ratio);
    const Float dividend = hn::Add(hn::Add(sum, sum), hn::Set(d, ratio));
    const Float inverse = hn::Set(d, (1.0F - 0x1p-20F) / (2.0F * ratio));
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

  // Makes the coarse row through row z of the vertices the far one.
  void load(std::size_t z) {
    const FloatTag d;
    const IntTag di;
    HWY_ALIGN float height[kRow + 17];
    const std::size_t count = (s_.n - 1) / s_.ratio + 1;
    const float* const samples = s_.first + z * s_.row_stride * s_.step;
    for (std::size_t i = 0; i < count; ++i)
      height[i] = samples[i * s_.ratio * s_.step];
    std::fill(height + count, height + count + 33, height[count - 1]);
    const Float quantum = hn::Set(d, s_.quantum);
    for (std::size_t i = 0; i <= count; i += hn::Lanes(d))
      hn::Store(hn::ConvertTo(d, quantise(hn::Load(d, height + i), quantum)), d, height + i);
    for (std::size_t x = 0; x < s_.n; x += hn::Lanes(d)) {
      const auto slots = hn::IndicesFromVec(d, hn::Load(di, slot_ + x));
      const float* const left = height + first_[x];
      hn::Store(hn::TableLookupLanes(hn::LoadU(d, left), slots), d, far_->left + x);
      hn::Store(hn::TableLookupLanes(hn::LoadU(d, left + 1), slots), d, far_->right + x);
    }
  }

  const TerrainSurface& s_;
  std::size_t across_ = 0;
  HWY_ALIGN float along_[kRow];  // cells from the coarse vertex on the left
  // The coarse vertex on the left is number first + slot, first being that of the whole vector.
  HWY_ALIGN std::int32_t slot_[kRow];
  std::size_t first_[kRow];
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

// The component of an octahedral normal as snorm8 + 128: 1 … 255.
HWY_INLINE hn::Vec<IntTag> component(Float slope, Float to_snorm8) {
  return hn::ConvertTo(IntTag(), hn::Add(hn::Mul(slope, to_snorm8), hn::Set(FloatTag(), 128.5F)));
}

// Both components in the upper half of 32 bits, as int8.
HWY_INLINE hn::Vec<UintTag> normals(const SampleRow& row, std::size_t x, Float scale) {
  const FloatTag d;
  const Float east_west = hn::Sub(hn::LoadU(d, row.west + x), hn::LoadU(d, row.east + x));
  const Float south_north = hn::Sub(hn::LoadU(d, row.north + x), hn::LoadU(d, row.south + x));
  const Float nx = hn::Mul(east_west, scale), nz = hn::Mul(south_north, scale);
  const Float length = hn::Add(hn::Add(hn::Abs(nx), hn::Set(d, 1.0F)), hn::Abs(nz));
  const Float to_snorm8 = hn::Div(hn::Set(d, 127.0F), length);
  const auto both = hn::Or(hn::ShiftLeft<16>(component(nx, to_snorm8)),
                           hn::ShiftLeft<24>(component(nz, to_snorm8)));
  return hn::Xor(hn::BitCast(UintTag(), both), hn::Set(UintTag(), 0x80800000U));
}

// A vertex as its bytes lie in memory.
struct PackedVertex {
  std::uint32_t low, high;
};
static_assert(sizeof(PackedVertex) == sizeof(core::TerrainVertex));

HeightRange pack(const TerrainSurface& s, std::byte* out) {
  const FloatTag d;
  const IntTag di;
  const UintTag du;
  CoarseHeights coarse(s);
  SampleRow samples;
  HWY_ALIGN std::uint32_t grid_x[kRow];
  HWY_ALIGN PackedVertex row[kRow];
  PackedVertex skirt[4 * kMaxTerrainSize];
  for (std::size_t x = 0; x < kRow; ++x)
    grid_x[x] = static_cast<std::uint32_t>(x * s.stride) & 0xFFU;
  const Float quantum = hn::Set(d, s.quantum), slope_scale = hn::Set(d, s.slope_scale);
  auto lowest = hn::Set(di, 65535), highest = hn::Zero(di);
  const std::size_t last = s.n - 1;
  for (std::size_t z = 0; z < s.n; ++z) {
    coarse.move_to(z);
    samples.load(s, z);
    const auto grid_z = hn::Set(du, static_cast<std::uint32_t>(z * s.stride) << 8);
    for (std::size_t x = 0; x < s.n; x += hn::Lanes(d)) {
      const auto height = quantise(hn::LoadU(d, samples.centre + x), quantum);
      const auto inside = hn::FirstN(di, s.n - x);
      lowest = hn::Min(lowest, hn::IfThenElse(inside, height, lowest));
      highest = hn::Max(highest, hn::IfThenElse(inside, height, highest));
      const auto low = hn::Or(hn::Or(hn::Load(du, grid_x + x), grid_z),
                              hn::BitCast(du, hn::ShiftLeft<16>(height)));
      const auto high = hn::Or(hn::BitCast(du, coarse.at(x)), normals(samples, x, slope_scale));
      hn::StoreInterleaved2(low, high, du, reinterpret_cast<std::uint32_t*>(row + x));
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
  return {static_cast<std::uint16_t>(hn::GetLane(hn::MinOfLanes(di, lowest))),
          static_cast<std::uint16_t>(hn::GetLane(hn::MaxOfLanes(di, highest)))};
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
