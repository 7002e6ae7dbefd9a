#include "engine/models/ground/erosion.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/core/assert.hpp"
#include "engine/core/hash.hpp"
#include "engine/models/kit/exact_math.hpp"
#include "engine/models/kit/scratch.hpp"

namespace psygen::models {
namespace {

// Changes with every change of the algorithm's results.
constexpr std::uint64_t kEdition = 1;

constexpr double kTwoPi = 6.283185307179586;
constexpr double kCellsPerWave = 0.65;  // side of a pivot's cell over the distance of its stripes
constexpr double kDepth = 0.2;          // half the depth over the width of gullies, at strength 1
constexpr double kDepthRatio = 0.45;    // of an octave to the one before
constexpr double kReach = 0.1;          // slopes around count up to this fraction of the width
constexpr double kGuideWidth = 1.5;     // narrowest features of the guide over gully_m
constexpr double kLowering = 0.2;       // mean depth of gullies over the sum of half depths
constexpr double kNarrowestGully = 4;   // cells
constexpr double kMaxFill = 0.12;       // sediment over sediment_m
constexpr double kScreeSlope = 0.3, kCliffSlope = 0.8;
// Sums the two waves of the layers of rock (erosion_kernel.cpp), over 2π.
constexpr double kStrataSum = 0.2668;

double tangent(double degrees) {
  return exact_sin_degrees(degrees) / exact_cos_degrees(degrees);
}
ErosionRamp ramp(double from, double to) {
  return {static_cast<float>(from), static_cast<float>(1 / std::max(to - from, 1e-6))};
}
template <class Real>
Real smooth(Real v) {
  const Real t = std::clamp(v, Real{0}, Real{1});
  return t * t * (3 - 2 * t);
}
// Returns the fraction of features of this width that a detail shows.
double shown(double cells, int detail) {
  return detail == 0 ? 1 : smooth(2 * (cells / (3 * std::ldexp(1.0, detail)) - 1));
}

std::int64_t floor_divide(std::int64_t a, std::int64_t b) {
  return a / b - (a % b < 0 ? 1 : 0);
}

}  // namespace

std::uint64_t Erosion::identity() const {
  std::uint64_t hash = core::mix64(kEdition);
  visit_erosion(*this, [&](std::string_view, const auto& field, const NumberSpec&) {
    hash = core::combine(hash, std::bit_cast<std::uint64_t>(field));
  });
  return hash == 0 ? 1 : hash;
}

ErosionFilter::ErosionFilter(const Erosion& e, const ErosionScale& scale, int detail)
    : cell_m_(scale.cell_m) {
  ErosionKernel& k = kernel_;
  const double gully_cells = e.gully_m / scale.cell_m;
  narrowest_cells_ = kGuideWidth * gully_cells;
  while (static_cast<double>(8 * line_cells_) <= gully_cells)
    line_cells_ *= 2;
  // All octaves have halves of one size, so that their cells nest exactly.
  const auto halves = static_cast<int>(e.octaves - 1);
  const double finest = std::ldexp(gully_cells * kCellsPerWave * kErosionUnits, -halves);
  const auto smallest = static_cast<std::int64_t>(std::max(finest + 0.5, 1.0));
  double depth = kDepth * e.strength * e.gully_m, width = e.gully_m, full_depths = 0, depths = 0;
  for (std::int64_t o = 0; o < e.octaves && width >= kNarrowestGully * scale.cell_m; ++o) {
    const double part = shown(width / scale.cell_m, detail);
    full_depths += depth;
    if (part > 0) {
      ErosionOctave& octave = k.octaves[k.octave_count++];
      const std::uint64_t key =
          core::combine(core::combine(scale.seed, 0xE205109), static_cast<std::uint64_t>(o));
      octave.size = smallest << (halves - o);
      octave.origin_x =
          static_cast<std::int64_t>(core::mix64(key) % static_cast<std::uint64_t>(octave.size));
      octave.origin_z =
          static_cast<std::int64_t>(core::mix64(key + 1) % static_cast<std::uint64_t>(octave.size));
      octave.key = static_cast<std::uint32_t>(core::mix64(key + 2));
      octave.depth_m = static_cast<float>(depth * part);
      octave.side = static_cast<float>(1.3 * e.branching * depth * kTwoPi / width);
      depths += depth * part;
    }
    depth *= kDepthRatio;
    width /= 2;
  }
  for (std::size_t o = 0; o < k.octaves.size(); ++o) {
    const double reach = kReach * std::ldexp(e.gully_m, -static_cast<int>(o));
    k.octaves[o].reach2_m2 = static_cast<float>(reach * reach);
  }
  // Without gullies the guide may have wider cells.
  if (k.octave_count == 0 && detail > 0)
    line_cells_ = std::max(line_cells_, std::int64_t{4} << (detail - 1));
  // Weak erosion wears and fills less too.
  const double begun = std::min(1.0, 10 * e.strength);
  const double blur = shown(std::min(gully_cells, 1e6), detail);
  const auto soft = [&](double rounding) {
    const double coarse = detail == 0 ? 0 : std::ldexp(0.5, detail) / gully_cells;
    const double r = std::max(rounding, std::min(coarse, 1.0));
    return static_cast<float>(r * r);
  };
  k.turns = static_cast<float>(kCellsPerWave);
  k.ridge_softness = soft(e.ridge_rounding);
  k.bed_softness = soft(e.valley_rounding);
  k.profile_scale = 1 / std::sqrt(1 + std::max(k.ridge_softness, k.bed_softness));
  k.carve_m = static_cast<float>(kLowering * full_depths);
  k.lowest = ramp(e.min_height_m, e.min_height_m + e.height_fade_m);
  k.highest = ramp(e.max_height_m - e.height_fade_m, e.max_height_m);
  k.slope =
      ramp(tangent(e.min_slope_deg), tangent(std::min(e.min_slope_deg + e.slope_fade_deg, 85.0)));
  k.full = ramp(0, 0.6);
  k.wear = static_cast<float>(e.wear * begun);
  const double sediment_m = std::min(e.sediment_m, 0.75 * e.gully_m);
  if (sediment_m > 0 && blur > 0) {
    const double lines = sediment_m / (2 * static_cast<double>(line_cells_) * scale.cell_m);
    passes_ = std::clamp(static_cast<int>(2 * lines * lines + 0.5), 1, 18);
    k.floor_share = static_cast<float>(e.valley_floor * begun * blur);
    k.scree_share = static_cast<float>(e.scree * begun * blur);
    k.max_fill_m = static_cast<float>(kMaxFill * sediment_m);
    k.bury = static_cast<float>(1 / (0.04 * sediment_m));
  }
  k.scree = ramp(kScreeSlope, kScreeSlope + 0.2);
  k.cliff = ramp(kCliffSlope, kCliffSlope + 0.25);
  k.strata_m = static_cast<float>(e.strata_m);
  k.strata_turns = static_cast<float>(1 / e.strata_m);
  k.strata = static_cast<float>(e.strata * begun * shown(e.strata_m / scale.cell_m, detail) *
                                e.strata_m / kTwoPi);
  k.unit_m = static_cast<float>(scale.unit_m);
  k.highest_value = scale.highest;
  const double fill = static_cast<double>(std::max(k.floor_share, k.scree_share)) *
                      static_cast<double>(k.max_fill_m);
  // The polynomials of waves exceed 1 by less than a part in a thousand.
  max_strata_m_ = 1.001 * kStrataSum * kTwoPi * static_cast<double>(k.strata);
  max_fill_m_ = fill;
  min_m_ = -(depths + static_cast<double>(k.carve_m) + max_strata_m_);
  max_m_ = std::max(depths - static_cast<double>(k.carve_m), 0.0) + fill + max_strata_m_;
}

double ErosionFilter::error_m(const ErosionFilter& other) const {
  const ErosionKernel &a = kernel_, &b = other.kernel_;
  const double apart = std::max(max_m_ - other.min_m_, other.max_m_ - min_m_);
  if (line_cells_ != other.line_cells_) return apart;
  const auto root = [](float softness) { return std::sqrt(static_cast<double>(softness)); };
  const double rounding = std::abs(root(a.ridge_softness) - root(b.ridge_softness)) +
                          std::abs(root(a.bed_softness) - root(b.bed_softness)) +
                          static_cast<double>(std::abs(a.profile_scale - b.profile_scale));
  double error = std::abs(max_fill_m_ - other.max_fill_m_);
  for (std::size_t o = 0; o < a.octaves.size(); ++o) {
    const auto at_a = static_cast<double>(a.octaves[o].depth_m);
    const auto at_b = static_cast<double>(b.octaves[o].depth_m);
    error += std::abs(at_a - at_b) + rounding * std::min(at_a, at_b);
  }
  if (error > 0) error += max_strata_m_ + other.max_strata_m_;
  return std::min(error, apart);
}

double ErosionFilter::usual_error_m(const ErosionFilter& other) const {
  double depths = 0;
  for (std::size_t o = 0; o < kernel_.octaves.size(); ++o)
    depths += static_cast<double>(
        std::abs(kernel_.octaves[o].depth_m - other.kernel_.octaves[o].depth_m));
  return 0.5 * depths;
}

// The memory of one call.
struct ErosionFilter::Lattices {
  ErosionAxis x, z;
  alignas(64) std::array<float, kMaxErosionAxis * kMaxErosionAxis> guide;
  alignas(64) std::array<float, kMaxErosionAxis * kMaxErosionAxis> worn;
  std::array<std::int64_t, kMaxErosionAxis> line_x, line_z;
};

namespace {

// Places samples on the octaves' cells and on the guide's lines along one axis. Returns false if
// they are too far apart for one call.
bool place(const ErosionKernel& k, std::span<const std::int64_t> at,
           std::int64_t ErosionOctave::*origin, std::int64_t line, int margin, ErosionAxis& axis) {
  const auto [least, most] = std::ranges::minmax(at);
  axis.count = at.size();
  std::int64_t first = least * kErosionUnits, last = most * kErosionUnits;
  const auto spread = [&](std::int64_t from, std::int64_t size, auto& cells, auto& fractions) {
    constexpr std::size_t kLanes = 16;  // the padding to whole vectors repeats the last sample
    for (std::size_t i = 0; i < (at.size() + kLanes - 1) / kLanes * kLanes; ++i) {
      const std::int64_t units = at[std::min(i, at.size() - 1)] * kErosionUnits - from;
      const std::int64_t cell = floor_divide(units, size);
      cells[i] = static_cast<std::int32_t>(cell);
      fractions[i] = static_cast<float>(units - cell * size) / static_cast<float>(size);
    }
  };
  // Every sample needs the pivots of the cells around its own, and each pivot those of the wider
  // octaves around it.
  for (std::size_t o = k.octave_count; o-- > 0;) {
    const ErosionOctave& octave = k.octaves[o];
    const std::int64_t begin = octave.*origin;
    const std::int64_t low = floor_divide(first - begin, octave.size) - 1;
    const std::int64_t high = floor_divide(last - begin, octave.size) + 1;
    axis.first_cell[o] = low;
    axis.cells[o] = static_cast<std::size_t>(high - low + 1);
    if (axis.cells[o] > kMaxPivots) return false;
    spread(begin + low * octave.size, octave.size, axis.cell[o], axis.fraction[o]);
    first = low * octave.size + begin;
    last = (high + 1) * octave.size + begin;
  }
  const std::int64_t low = floor_divide(first, line) - 1 - margin;
  const std::int64_t high = floor_divide(last, line) + 2 + margin;
  axis.first_line = low;
  axis.lines = static_cast<std::size_t>(high - low + 1);
  if (axis.lines > kMaxErosionAxis) return false;
  spread((low + 1) * line, line, axis.line, axis.share);
  return true;
}

void fill_lines(const ErosionAxis& axis, std::int64_t cells, std::span<std::int64_t> lines) {
  for (std::size_t i = 0; i < axis.lines; ++i)
    lines[i] = (axis.first_line + static_cast<std::int64_t>(i)) * cells;
}

}  // namespace

bool ErosionFilter::is_plain() const {
  return kernel_.octave_count == 0 && passes_ == 0 && kernel_.strata == 0;
}

float ErosionFilter::plain(float value, const PlainGuide& guide) const {
  const auto at = [](const ErosionRamp& ramp, float v) {
    return smooth((v - ramp.from) * ramp.per);
  };
  const ErosionKernel& k = kernel_;
  const float band = at(k.lowest, guide.height_m) * (1 - at(k.highest, guide.height_m));
  const float slope = std::sqrt(guide.slope_x * guide.slope_x + guide.slope_z * guide.slope_z);
  const float lowered_m = k.carve_m * at(k.full, slope) * band;
  const float base = value + (guide.worn - value) * (band * k.wear);
  return std::clamp(base - lowered_m / k.unit_m, 0.0F, k.highest_value);
}

void ErosionFilter::apply(const ErosionGuide& guide, std::span<const std::int64_t> columns,
                          std::span<const std::int64_t> rows, std::span<float> values,
                          std::size_t stride) const {
  PSYGEN_ASSERT(columns.size() <= kMaxErosionAxis && rows.size() <= kMaxErosionAxis,
                "axes are short enough");
  PSYGEN_ASSERT(
      stride >= columns.size() && values.size() >= (rows.size() - 1) * stride + columns.size(),
      "the values have room for every row");
  if (columns.empty() || rows.empty()) return;
  const Scratch<Lattices> scratch;
  erode(*scratch, guide, columns, rows, values, stride);
}

// Samples that are too far apart for one set of pivots go in halves.
void ErosionFilter::erode(Lattices& m, const ErosionGuide& guide,
                          std::span<const std::int64_t> columns, std::span<const std::int64_t> rows,
                          std::span<float> values, std::size_t stride) const {
  const std::int64_t line = line_cells_ * kErosionUnits;
  if (!place(kernel_, columns, &ErosionOctave::origin_x, line, passes_, m.x)) {
    const std::size_t half = columns.size() / 2;
    erode(m, guide, columns.first(half), rows, values, stride);
    return erode(m, guide, columns.subspan(half), rows, values.subspan(half), stride);
  }
  if (!place(kernel_, rows, &ErosionOctave::origin_z, line, passes_, m.z)) {
    const std::size_t half = rows.size() / 2;
    erode(m, guide, columns, rows.first(half), values, stride);
    return erode(m, guide, columns, rows.subspan(half), values.subspan(half * stride), stride);
  }
  fill_lines(m.x, line_cells_, m.line_x);
  fill_lines(m.z, line_cells_, m.line_z);
  const std::span line_x(m.line_x.data(), m.x.lines), line_z(m.line_z.data(), m.z.lines);
  guide.heights(line_x, line_z, lines_show_cells(), m.guide, kMaxErosionAxis);
  for (std::size_t z = 0; z < m.z.lines; ++z) {
    for (std::size_t x = 0; x < m.x.lines; ++x)
      m.guide[z * kMaxErosionAxis + x] *= kernel_.unit_m;
  }
  ErosionCall call{.kernel = &kernel_,
                   .x = &m.x,
                   .z = &m.z,
                   .guide = m.guide.data(),
                   .passes = passes_,
                   .spacing = line,
                   .spacing_m = static_cast<float>(static_cast<double>(line_cells_) * cell_m_)};
  call.wears_to_guide = guide.follows_from_lines();
  if (kernel_.wear > 0 && !call.wears_to_guide) {
    guide.heights(columns, rows, narrowest_cells_, m.worn, kMaxErosionAxis);
    call.worn = m.worn.data();
    call.worn_stride = kMaxErosionAxis;
  }
  erode_rows(call, values.data(), stride);
}

// Measured (AVX-512, Zen 5).
double ErosionFilter::work(std::size_t columns, std::size_t rows, double spacing) const {
  constexpr double kSample = 16, kOctave = 27, kPivot = 40, kBlur = 1;
  double width_x = static_cast<double>(columns) * spacing,
         width_z = static_cast<double>(rows) * spacing;
  double work = static_cast<double>(columns) * static_cast<double>(rows) *
                (kSample + kOctave * static_cast<double>(kernel_.octave_count));
  for (std::size_t o = kernel_.octave_count; o-- > 0;) {
    const double size = static_cast<double>(kernel_.octaves[o].size) / kErosionUnits;
    width_x += 3 * size;
    width_z += 3 * size;
    work += kPivot * (1 + static_cast<double>(o)) * (width_x / size) * (width_z / size);
  }
  return work + kBlur * passes_ * guide_points(columns, rows, spacing);
}

// Three cells of each octave: its pivots need those of the wider octaves around them.
double ErosionFilter::pivot_margin_cells() const {
  double margin = 0;
  for (std::size_t o = 0; o < kernel_.octave_count; ++o)
    margin += 3 * static_cast<double>(kernel_.octaves[o].size) / kErosionUnits;
  return margin;
}

double ErosionFilter::guide_margin_cells() const {
  return pivot_margin_cells() + (passes_ + 3) * static_cast<double>(line_cells_);
}

double ErosionFilter::guide_points(std::size_t columns, std::size_t rows, double spacing) const {
  const double margin = pivot_margin_cells();
  const auto lines = [&](std::size_t count) {
    return (static_cast<double>(count) * spacing + margin) / static_cast<double>(line_cells_) + 4 +
           2 * passes_;
  };
  return lines(columns) * lines(rows);
}

}  // namespace psygen::models
