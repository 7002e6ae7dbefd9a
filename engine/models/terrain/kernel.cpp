// Packs a row of vertices at a time. Heights are quantised, normals come from the samples on four
// sides, and the heights of the next coarser level come from its triangles. Heights and their
// weighted sums are integers below 2^24, which single precision represents exactly. So sums have
// the same bits with and without fused multiply-add.
#include "engine/models/terrain/kernel.hpp"

#include <algorithm>
#include <utility>

#include "engine/core/vertex_layout.hpp"
#include "engine/models/terrain/grid.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/terrain/kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "engine/models/terrain/spread-inl.hpp"
#include "engine/models/terrain/vertices-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

constexpr std::size_t kRow = kMaxTerrainSize + 16;  // a row of vertices and the padding of vectors

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

// The light of the vertices, row after row.
class LightRows {
 public:
  explicit LightRows(const TerrainSurface& s)
      : s_(s), l_(s.light), spread_(s.n, l_.phase_x, s.stride, l_.spacing), rest_(l_.phase_z) {
    load(0, *near_);
    load(1, *far_);
    find_weight();
  }

  // Moves on to the next row of vertices.
  void advance() {
    std::size_t row = row_;
    for (rest_ += s_.stride; rest_ >= l_.spacing; rest_ -= l_.spacing)
      ++row;
    find_weight();
    if (row == row_) return;
    std::swap(near_, far_);
    if (row != row_ + 1) load(row, *near_);
    load(row + 1, *far_);
    row_ = row;
  }

  // Light of the vertices from x on: sun in the low byte, ambient in the next.
  HWY_INLINE hn::Vec<UintTag> at(std::size_t x) const {
    const auto both = hn::Or(low_byte(near_->sun + x, far_->sun + x),
                             hn::ShiftLeft<8>(low_byte(near_->ambient + x, far_->ambient + x)));
    return hn::And(both, hn::Set(UintTag(), 0xFFFFU));
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

  void find_weight() { weight_ = static_cast<float>(rest_) / static_cast<float>(l_.spacing); }

  // The rounded light, at most 255, in the low 16 bits.
  HWY_INLINE hn::Vec<UintTag> low_byte(const float* near, const float* far) const {
    const FloatTag d;
    const Float a = hn::Load(d, near), b = hn::Load(d, far);
    const Float value = hn::Add(a, hn::Mul(set(weight_), hn::Sub(b, a)));
    return hn::BitCast(UintTag(), hn::Add(value, set(kToInteger)));
  }

  const TerrainSurface& s_;
  const LightSamples& l_;
  const Spread<kMaxTerrainSize> spread_;
  std::size_t row_ = 0, rest_;  // number of the light row above, and cells below it
  float weight_;
  Row rows_[2];
  Row *near_ = &rows_[0], *far_ = &rows_[1];
};

// The samples of one row of vertices, and the samples on their four sides.
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

// One component of an octahedral normal as snorm8, in the low byte.
HWY_INLINE hn::Vec<UintTag> component(Float slope, Float to_snorm8) {
  return hn::BitCast(UintTag(), hn::Add(hn::Mul(slope, to_snorm8), set(kToInteger)));
}

// Both components of the normals, in the upper 16 bits.
HWY_INLINE hn::Vec<UintTag> normals(const SampleRow& row, std::size_t x, Float scale) {
  const FloatTag d;
  const UintTag du;
  const Float east_west = hn::Sub(hn::LoadU(d, row.west + x), hn::LoadU(d, row.east + x));
  const Float south_north = hn::Sub(hn::LoadU(d, row.north + x), hn::LoadU(d, row.south + x));
  const Float nx = hn::Mul(east_west, scale), nz = hn::Mul(south_north, scale);
  const Float length = hn::Add(hn::Add(hn::Abs(nx), set(1.0F)), hn::Abs(nz));
  const Float to_snorm8 = hn::Div(set(127.0F), length);
  const auto low = hn::ShiftLeft<16>(component(nx, to_snorm8));
  return hn::Or(hn::And(low, hn::Set(du, 0xFF0000U)), hn::ShiftLeft<24>(component(nz, to_snorm8)));
}

// Writes the grid columns of the vertices, in the low bytes.
void number_columns(const TerrainSurface& s, std::uint32_t* to) {
  const UintTag du;
  const auto stride = hn::Set(du, static_cast<std::uint32_t>(s.stride));
  for (std::size_t x = 0; x < s.n; x += hn::Lanes(du)) {
    const auto column = hn::Add(hn::Iota(du, 0), hn::Set(du, static_cast<std::uint32_t>(x)));
    hn::Store(hn::And(hn::Mul(column, stride), hn::Set(du, 0xFFU)), du, to + x);
  }
}

HeightRange pack(const TerrainSurface& s, std::byte* out) {
  const FloatTag d;
  const UintTag du;
  CoarseHeights coarse(s);
  LightRows light(s);
  SampleRow samples;
  const Interleave3 interleave;
  HWY_ALIGN std::uint32_t grid_x[kRow];
  const std::size_t lanes = hn::Lanes(d), n = s.n, last = n - 1;
  Skirt skirt(last);
  const auto end_lane =
      hn::IndicesFromVec(du, hn::Set(IntTag(), static_cast<std::int32_t>(last % lanes)));
  number_columns(s, grid_x);
  const Float quantum = set(s.quantum), slope_scale = set(s.slope_scale);
  Float lowest = set(65535.0F + kToInteger), highest = set(kToInteger);
  for (std::size_t z = 0; z < n; ++z, out += n * kVertexBytes) {
    samples.load(s, z);
    const bool border = z == 0 || z == last;
    VertexWords row;  // only for the first and the last row
    const auto grid_z = hn::Set(du, static_cast<std::uint32_t>(z * s.stride) << 8);
    for (std::size_t x = 0; x < n; x += lanes) {
      Float height = quantise(hn::LoadU(d, samples.centre + x), quantum);
      const auto low =
          hn::Or3(hn::Load(du, grid_x + x), grid_z, hn::ShiftLeft<16>(hn::BitCast(du, height)));
      const auto below = hn::And(hn::BitCast(du, coarse.at(x)), hn::Set(du, 0xFFFFU));
      const auto high = hn::Or(below, normals(samples, x, slope_scale));
      const VertexVector vertices{low, high, light.at(x)};
      vertices.store(interleave, n - x, out + x * kVertexBytes);
      if (border) vertices.store_words(row, x);
      if (x == 0) skirt.add_first(z, vertices);
      if (x + lanes >= n) skirt.add_last(z, vertices, end_lane);
      if (n - x < lanes) height = hn::IfThenElse(hn::FirstN(d, n - x), height, lowest);
      lowest = hn::Min(lowest, height);
      if (n - x < lanes) height = hn::IfThenElse(hn::FirstN(d, n - x), height, highest);
      highest = hn::Max(highest, height);
    }
    if (border) skirt.add_row(z, row);
    if (z == last) break;
    coarse.advance();
    light.advance();
  }
  skirt.write(interleave, out + n * kVertexBytes);
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
