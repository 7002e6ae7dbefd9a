// Packs a row of vertices at a time. Heights are quantised, normals come from the samples on four
// sides, and the heights of the next coarser level come from its triangles.
#include "engine/models/terrain/kernel.hpp"

#include <algorithm>
#include <utility>

#include "engine/core/vertex_layout.hpp"
#include "engine/models/terrain/grid.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/models/terrain/kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "engine/models/terrain/coarse-inl.hpp"
#include "engine/models/terrain/spread-inl.hpp"
#include "engine/models/terrain/vertices-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace psygen::models::HWY_NAMESPACE {

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
