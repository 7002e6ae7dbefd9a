// The heights of the terrain: the noise or a river network, erosion, and all layers over them.
#include "engine/models/terrain/shape.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "engine/core/assert.hpp"
#include "engine/models/edits.hpp"
#include "engine/models/kit/exact_math.hpp"
#include "engine/models/kit/scratch.hpp"
#include "engine/models/network/network.hpp"
#include "engine/models/terrain/light.hpp"
#include "engine/models/terrain/terrain.hpp"

namespace psygen::models {
namespace {

using network::floor_div;

RidgedSettings settings_of(const Parameters& p) {
  return {.seed = static_cast<std::uint64_t>(p.integer(kTerrainSeed)),
          .height = p.real(kTerrainHeight),
          .lacunarity = p.real(kTerrainLacunarity),
          .octaves = static_cast<int>(p.integer(kTerrainOctaves)),
          .offset = p.real(kTerrainOffset),
          .gain = p.real(kTerrainGain),
          .cells_per_step = p.real(kTerrainCellM) / p.real(kTerrainFeatureM),
          .warp = p.real(kTerrainWarp)};
}

// The octaves of a noise that erosion follows, raised so that the land keeps its height: the other
// octaves, which are never negative, add about the same fraction to high and low ground.
class NoiseGuide final : public ErosionGuide {
 public:
  NoiseGuide(const RidgedNoise& noise, int octaves) : noise_(noise), octaves_(octaves) {}
  int octaves(double narrowest_cells) const {
    return std::min(octaves_, noise_.octaves_wider_than(narrowest_cells));
  }
  void heights(std::span<const std::int64_t> columns, std::span<const std::int64_t> rows,
               double narrowest_cells, std::span<float> values, std::size_t stride) const override {
    const int count = octaves(narrowest_cells);
    noise_.evaluate(columns, rows, values, stride, count);
    if (count == octaves_) return;
    const double ratio = noise_.max_value(octaves_) / noise_.max_value(count);
    const auto scale = static_cast<float>(exact_pow(ratio, kUsualFraction));
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t c = 0; c < columns.size(); ++c)
        values[r * stride + c] *= scale;
    }
  }

 private:
  // Measured in five noises with one to four octaves: 0.4 to 0.8, and within 2 % of the height at
  // the lowest and the highest tenth.
  static constexpr double kUsualFraction = 0.65;
  const RidgedNoise& noise_;
  int octaves_;
};

// The coarsest detail with all features at least so many cells wide.
GroundDetail detail_of_width(double narrowest_cells) {
  GroundDetail detail{.level = 1};
  while (detail.spacing_cells() < narrowest_cells)
    ++detail.level;
  return detail.level > 1 ? detail : GroundDetail{};
}

// The detail of a guide without features narrower than this, for ground of a detail. It is never
// the finer one: finer nodes would have wide samples read a patch each.
GroundDetail guide_detail(GroundDetail of_ground, double narrowest_cells) {
  return {.level = std::max(of_ground.level, detail_of_width(narrowest_cells).level)};
}

// The land of a river network before its channels, in units of the noise. Neighbouring blocks ask
// for the same lines, so squares of them are kept.
class NetworkGuide final : public ErosionGuide {
 public:
  static constexpr std::int64_t kSide = 32;  // lines of a square
  // `cache` may be null, and must be for heights of other places than lines of an erosion: at least
  // two, equally far apart, at multiples of their distance.
  NetworkGuide(const RiverNetwork& network, float unit_m, GroundDetail detail,
               core::ValueCache* cache)
      : network_(network), unit_m_(unit_m), detail_(detail), cache_(cache) {}
  bool follows_from_lines() const override { return true; }
  void heights(std::span<const std::int64_t> columns, std::span<const std::int64_t> rows,
               double narrowest_cells, std::span<float> values, std::size_t stride) const override {
    const GroundDetail detail = guide_detail(detail_, narrowest_cells);
    if (cache_ == nullptr) return evaluate(columns, rows, detail, values, stride);
    const std::int64_t step = columns[1] - columns[0];
    PSYGEN_ASSERT(are_lines(columns, step) && are_lines(rows, step), "only lines have a cache");
    const Squares x(columns, step), z(rows, step);
    for (std::int64_t j = z.first; j <= z.last; ++j) {
      for (std::int64_t i = x.first; i <= x.last; ++i)
        copy(*square(i, j, step, detail), x.part(i), z.part(j), values, stride);
    }
  }

 private:
  static bool are_lines(std::span<const std::int64_t> axis, std::int64_t step) {
    return axis.front() % step == 0 &&
           std::ranges::adjacent_find(axis, [step](std::int64_t a, std::int64_t b) {
             return b - a != step;
           }) == axis.end();
  }
  struct Square {
    std::array<float, kSide * kSide> values;
    std::size_t bytes() const { return sizeof *this; }
  };
  // Lines along an axis that lie in one square: the first of them, its place in the square, and
  // their number.
  struct Part {
    std::size_t first, in_square, count;
  };
  struct Squares {
    std::int64_t line, end;    // of all lines, counted from the world's origin
    std::int64_t first, last;  // squares
    Squares(std::span<const std::int64_t> lines, std::int64_t step)
        : line(floor_div(lines.front(), step)),
          end(line + static_cast<std::int64_t>(lines.size())),
          first(floor_div(line, kSide)),
          last(floor_div(end - 1, kSide)) {}
    Part part(std::int64_t square) const {
      const std::int64_t begin = std::max(line, square * kSide);
      const std::int64_t beyond = std::min(end, (square + 1) * kSide);
      return {static_cast<std::size_t>(begin - line),
              static_cast<std::size_t>(begin - square * kSide),
              static_cast<std::size_t>(beyond - begin)};
    }
  };

  std::shared_ptr<const Square> square(std::int64_t i, std::int64_t j, std::int64_t step,
                                       GroundDetail detail) const {
    const std::uint64_t kind = core::combine(
        core::combine(network_.identity(), static_cast<std::uint64_t>(detail.level)),
        core::combine(static_cast<std::uint64_t>(step), std::bit_cast<std::uint32_t>(unit_m_)));
    return cache_->get<Square>(
        {kKind, kind, static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j)}, [&] {
          std::array<std::int64_t, kSide> x, z;
          for (std::int64_t k = 0; k < kSide; ++k) {
            x[static_cast<std::size_t>(k)] = (i * kSide + k) * step;
            z[static_cast<std::size_t>(k)] = (j * kSide + k) * step;
          }
          Square made;
          evaluate(x, z, detail, made.values, kSide);
          return made;
        });
  }
  static void copy(const Square& square, const Part& x, const Part& z, std::span<float> values,
                   std::size_t stride) {
    for (std::size_t r = 0; r < z.count; ++r)
      std::copy_n(&square.values[(z.in_square + r) * kSide + x.in_square], x.count,
                  &values[(z.first + r) * stride + x.first]);
  }
  void evaluate(std::span<const std::int64_t> columns, std::span<const std::int64_t> rows,
                GroundDetail detail, std::span<float> values, std::size_t stride) const {
    network_.base({columns, rows}, detail, {.height_m = values.data(), .stride = stride});
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t c = 0; c < columns.size(); ++c)
        values[r * stride + c] /= unit_m_;
    }
  }

  static constexpr std::uint64_t kKind = 0x6C696E6573ULL;  // apart from heights of blocks
  const RiverNetwork& network_;
  float unit_m_;
  GroundDetail detail_;
  core::ValueCache* cache_;
};

// Octaves of the noise that are narrower than a network's nodes are detail on its land, with this
// fraction of the height that they have without a network. Land less steep than kSteep has less.
constexpr float kDetailStrength = 0.16F, kSteep = 0.35F;

int octaves_of_nodes(const RidgedNoise& noise, const RiverNetwork& network) {
  return noise.octaves_wider_than(
      std::ldexp(network.settings().root_spacing_m, -network.settings().halvings) /
      network.frame().cell_m);
}

}  // namespace

TerrainShape::TerrainShape(const Parameters& p)
    : noise(settings_of(p)),
      size(static_cast<int>(p.integer(kTerrainSize))),
      node_level(static_cast<int>(p.integer(kTerrainNodeLevel))),
      cell_m(std::ldexp(p.real(kTerrainCellM), node_level)),
      relief_m(static_cast<float>(p.real(kTerrainReliefM))),
      quantum(static_cast<float>(65535.0 / noise.max_value())),
      metres(static_cast<float>(p.real(kTerrainReliefM) / noise.max_value())),
      seed(static_cast<std::uint64_t>(p.integer(kTerrainSeed))),
      stack(p.edits() != nullptr ? &p.edits()->ground : nullptr) {}

GroundScale TerrainShape::scale() const {
  return {.cells_per_block = size - 1,
          .cell_m = std::ldexp(cell_m, -node_level),
          .unit_m = metres,
          .highest = 65535.0F / quantum};
}

int TerrainShape::octaves(GroundDetail detail) const {
  return detail.light ? noise.octaves_wider_than(kOctavePoints * detail.spacing_cells())
                      : kMaxOctaves;
}

std::optional<ErosionFilter> TerrainShape::filter(GroundDetail detail) const {
  if (stack == nullptr || stack->erosion == nullptr) return std::nullopt;
  const GroundScale of = scale();
  return ErosionFilter(
      *stack->erosion,
      {.seed = seed, .cell_m = of.cell_m, .unit_m = of.unit_m, .highest = of.highest},
      detail.level);
}

void TerrainShape::evaluate(std::span<const std::int64_t> columns,
                            std::span<const std::int64_t> rows, std::span<float> values,
                            std::size_t stride, GroundDetail detail) const {
  if (stack != nullptr && stack->network != nullptr) {
    evaluate_network(columns, rows, values, stride, detail);
    stack->apply(scale(), columns, rows, values, stride, detail,
                 NetworkGuide(*stack->network, metres, detail, nullptr));
  } else {
    noise.evaluate(columns, rows, values, stride, octaves(detail));
    if (stack == nullptr) return;
    if (const std::optional<ErosionFilter> erosion = filter(detail))
      erosion->apply(NoiseGuide(noise, octaves(detail)), columns, rows, values, stride);
    stack->apply(scale(), columns, rows, values, stride, detail, NoiseGuide(noise, kMaxOctaves));
  }
}

// The land of the network with the detail of the noise and with erosion, which both fade at
// channels and lakes; these are cut last.
void TerrainShape::evaluate_network(std::span<const std::int64_t> columns,
                                    std::span<const std::int64_t> rows, std::span<float> values,
                                    std::size_t stride, GroundDetail detail) const {
  const RiverNetwork& network = *stack->network;
  const std::size_t width = columns.size(), count = width * rows.size();
  const ScratchMemory memory(6 * count * sizeof(float));
  const std::span all(static_cast<float*>(memory.get()), 6 * count);
  const auto plane = [&](std::size_t i) { return all.subspan(i * count, count); };
  const std::span<float> base = plane(0), clear = plane(1), slope_x = plane(2), slope_z = plane(3);
  const std::span<float> fine = plane(4), other = plane(5);
  network.base({columns, rows}, detail,
               {.height_m = base.data(),
                .slope_x = slope_x.data(),
                .slope_z = slope_z.data(),
                .clear = clear.data(),
                .stride = width});
  noise.evaluate(columns, rows, fine, width, octaves(detail));
  noise.evaluate(columns, rows, other, width,
                 std::min(octaves(detail), octaves_of_nodes(noise, network)));
  for (std::size_t i = 0; i < count; ++i) {
    const float steep =
        std::min((std::abs(slope_x[i]) + std::abs(slope_z[i])) * (1 / kSteep), 1.0F);
    const float detail_m = (fine[i] - other[i]) * (kDetailStrength * metres) * steep * clear[i];
    fine[i] = std::clamp(base[i] + detail_m, 0.0F, relief_m) / metres;
  }
  if (const std::optional<ErosionFilter> erosion = filter(detail)) {
    if (erosion->is_plain()) {
      for (std::size_t i = 0; i < count; ++i)
        other[i] = erosion->plain(fine[i], {base[i] / metres, base[i], slope_x[i], slope_z[i]});
    } else {
      std::copy(fine.begin(), fine.end(), other.begin());
      erosion->apply(NetworkGuide(network, metres, detail, stack->heights.get()), columns, rows,
                     other, width);
    }
    for (std::size_t i = 0; i < count; ++i)
      fine[i] += (other[i] - fine[i]) * clear[i];
  }
  for (float& value : fine)
    value *= metres;
  network.carve(
      {columns, rows}, detail,
      {.base_m = base.data(), .base_stride = width, .height_m = fine.data(), .stride = width});
  const float highest = 65535.0F / quantum;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < width; ++c)
      values[r * stride + c] = std::clamp(fine[r * width + c] / metres, 0.0F, highest);
  }
}

void TerrainShape::each_patch(LatticeSpan x, LatticeSpan z, GroundDetail detail,
                              const std::function<void(const network::TileKey&)>& visit) const {
  if (stack == nullptr || stack->network == nullptr) return;
  stack->network->each_tile({x.first, x.last}, {z.first, z.last}, detail, visit);
  const std::optional<ErosionFilter> erosion = filter(detail);
  if (!erosion || erosion->is_plain()) return;
  // Lines are made in whole squares.
  const auto wide =
      static_cast<std::int64_t>(erosion->guide_margin_cells() +
                                static_cast<double>(NetworkGuide::kSide) * erosion->line_cells());
  stack->network->each_tile({x.first - wide, x.last + wide}, {z.first - wide, z.last + wide},
                            guide_detail(detail, erosion->lines_show_cells()), visit);
}

// Measured: one edit takes 8 times as long for a height as an octave of the noise.
double TerrainShape::layer_work(LatticeSpan x, LatticeSpan z, double heights,
                                GroundDetail detail) const {
  constexpr double kWorkPerEdit = 8;
  if (stack == nullptr) return 0;
  const HeightWork of_height = stack->work_per_height(scale(), x, z);
  double work = kWorkPerEdit * heights * of_height.edits;
  const auto side = static_cast<std::size_t>(std::sqrt(heights));
  const double spacing =
      static_cast<double>(x.last - x.first) / static_cast<double>(std::max<std::size_t>(side, 1));
  const RiverNetwork* const network = stack->network.get();
  const double reads = of_height.guide_reads;
  if (network == nullptr) {
    const int wide = NoiseGuide(noise, kMaxOctaves).octaves(GroundMask::kGuideCells);
    work += reads * noise.work(side, side, spacing, wide);
  } else {
    work += network->work(reads * heights, guide_detail(detail, GroundMask::kGuideCells));
    work += network->work(heights, detail) +
            noise.work(side, side, spacing,
                       std::min(octaves(detail), octaves_of_nodes(noise, *network)));
  }
  const std::optional<ErosionFilter> erosion = filter(detail);
  if (!erosion || (network != nullptr && erosion->is_plain())) return work;
  work += erosion->work(side, side, spacing);
  const double points = erosion->guide_points(side, side, spacing);
  if (network != nullptr)
    return work + network->work(points, guide_detail(detail, erosion->lines_show_cells()));
  const int wide = NoiseGuide(noise, octaves(detail)).octaves(erosion->narrowest_cells());
  const auto line_count = static_cast<std::size_t>(std::sqrt(points));
  return work + noise.work(line_count, line_count, erosion->line_cells(), wide) +
         noise.work(side, side, spacing, wide);
}

DetailErrors terrain_detail_errors_m(const Parameters& terrain, int levels) {
  const TerrainShape shape(terrain);
  const GroundDetail other = GroundDetail::of_node(shape.node_level + levels);
  DetailErrors errors;
  if (const auto here = shape.filter(shape.detail())) {
    const auto there = shape.filter(other);
    errors = {here->error_m(*there), here->usual_error_m(*there)};
  }
  if (shape.stack == nullptr || shape.stack->network == nullptr) return errors;
  const RiverNetwork& network = *shape.stack->network;
  return {errors.bound_m + double{network.error_m(shape.detail(), other)},
          errors.usual_m + double{network.usual_error_m(shape.detail(), other)}};
}

}  // namespace psygen::models
