#include "engine/models/terrain/light.hpp"

#include <algorithm>
#include <cmath>

#include "engine/models/kit/exact_math.hpp"

namespace psygen::models {
namespace {

std::int64_t floor_divide(std::int64_t a, std::int64_t b) {
  return a / b - (a % b < 0 ? 1 : 0);
}

// The requested points of one grid along one axis, counted from the world's origin. `last`
// included.
struct LightAxis {
  std::int64_t first, last;
  LightAxis over(std::int64_t spacing) const {
    return {floor_divide(first, spacing), floor_divide(last, spacing) + 1};
  }
  std::size_t count() const { return static_cast<std::size_t>(last - first + 1); }
  std::size_t phase_in(const LightAxis& wider, std::int64_t spacing) const {
    return static_cast<std::size_t>(first - wider.first * spacing);
  }
};

// The first and the last vertex of a node along one axis, in cells.
LightAxis cells_of(const TerrainShape& shape, std::int64_t block) {
  const std::int64_t first = block * (shape.size - 1);
  return {first, first + shape.size - 1};
}

SunRays rays_of(const SunDirection& sun) {
  const auto tangent = [](double degrees) {
    return static_cast<float>(exact_sin_degrees(degrees) / exact_cos_degrees(degrees));
  };
  SunRays rays;
  rays.low = tangent(std::max(sun.elevation_deg - kSunSoftness, 0.0));
  rays.high = tangent(std::min(sun.elevation_deg + kSunSoftness, 89.0));
  const double x = exact_sin_degrees(sun.azimuth_deg), z = -exact_cos_degrees(sun.azimuth_deg);
  double length = 1;
  for (LightStep& step : rays.steps) {
    const double far_x = length * x, far_z = length * z;
    const double cell_x = std::floor(far_x), cell_z = std::floor(far_z);
    step = {static_cast<int>(cell_x), static_cast<int>(cell_z), static_cast<float>(far_x - cell_x),
            static_cast<float>(far_z - cell_z), static_cast<float>(length)};
    length *= 1.4142135623730951;
  }
  return rays;
}

// Returns the number of steps at which a hill as high as the whole height range could hide the sun.
std::size_t useful_steps(const SunRays& rays, float spacing_m, float relief_m) {
  std::size_t count = 0;
  while (count < kLightSteps && rays.steps[count].length * spacing_m * rays.low <= relief_m)
    ++count;
  return count;
}

// Makes a grid for these requested points, without heights.
LightGrid grid_over(const LightAxis& x, const LightAxis& z) {
  LightGrid grid{};
  grid.stride = (x.count() + 2 * kLightReach + 15) / 16 * 16 + 16;
  grid.count_x = x.count();
  grid.count_z = z.count();
  return grid;
}

// One grid of the light, without its heights.
struct PlannedGrid {
  LightGrid grid;
  LightAxis x, z;        // of its requested points
  std::int64_t spacing;  // in cells of the node
  GroundDetail detail;   // of its heights

  std::size_t columns() const { return grid.count_x + 2 * kLightReach; }
  std::size_t rows() const { return grid.count_z + 2 * kLightReach; }
  // Spacing in cells of node level 0, the unit of the noise.
  double spacing_of_noise(const TerrainShape& shape) const {
    return std::ldexp(static_cast<double>(spacing), shape.node_level);
  }
  // The range from the first to the last point along an axis.
  LatticeSpan lattice(const TerrainShape& shape, const LightAxis& axis) const {
    return {shape.world_of(0, (axis.first - kLightReach) * spacing),
            shape.world_of(0, (axis.last + kLightReach) * spacing)};
  }
};

// The grids and rays for the light of a node.
struct LightPlan {
  std::array<PlannedGrid, kMaxLightGrids> grids;
  std::size_t count = 0;
  bool shadows;
  SunRays rays{};

  LightPlan(const TerrainShape& shape, const SunDirection& sun, std::int64_t block_x,
            std::int64_t block_z, std::size_t finest);
};

LightPlan::LightPlan(const TerrainShape& shape, const SunDirection& sun, std::int64_t block_x,
                     std::int64_t block_z, std::size_t finest)
    : shadows(!sun.is_down() && !sun.is_overhead()) {
  if (shadows) rays = rays_of(sun);
  std::int64_t spacing = kLightCells;
  for (std::size_t g = 0; g < finest; ++g)
    spacing *= kLightRatio;
  LightAxis x = cells_of(shape, block_x).over(spacing), z = cells_of(shape, block_z).over(spacing);
  for (std::size_t g = finest; g < kMaxLightGrids; ++g) {
    const LightAxis wide_x = x.over(kLightRatio), wide_z = z.over(kLightRatio);
    LightGrid grid = grid_over(x, z);
    grid.phase_x = x.phase_in(wide_x, kLightRatio);
    grid.phase_z = z.phase_in(wide_z, kLightRatio);
    const auto spacing_m = static_cast<float>(static_cast<double>(spacing) * shape.cell_m);
    grid.spacing = spacing_m / shape.metres;
    grid.sun_steps = shadows ? useful_steps(rays, spacing_m, shape.relief_m) : 0;
    grid.sky = spacing_m <= static_cast<float>(kSkyReach) * shape.relief_m;
    if (grid.sun_steps == 0 && !grid.sky && count > 0) break;
    grids[count++] = {grid, x, z, spacing, shape.light_detail(static_cast<int>(g))};
    x = wide_x;
    z = wide_z;
    spacing *= kLightRatio;
  }
}

// The heights of all grids, in units of the noise.
class LightHeights {
 public:
  explicit LightHeights(const TerrainShape& shape) : shape_(shape) {}

  const float* evaluate(const PlannedGrid& planned) {
    const LightGrid& grid = planned.grid;
    const std::size_t columns = planned.columns(), rows = planned.rows();
    std::array<std::int64_t, kLongest> world_x, world_z;
    fill(planned.x, columns, planned.spacing, world_x);
    fill(planned.z, rows, planned.spacing, world_z);
    const std::span values = std::span(memory_).subspan(used_, rows * grid.stride);
    used_ += values.size();
    shape_.evaluate({world_x.data(), columns}, {world_z.data(), rows}, values, grid.stride,
                    planned.detail);
    for (std::size_t r = 0; r < rows; ++r)
      std::fill_n(&values[r * grid.stride + columns], grid.stride - columns, 0.0F);
    return values.data();
  }

 private:
  static constexpr std::size_t kLongest = kLightRow + 2 * kLightReach;
  static constexpr std::size_t kWideLongest = kLightCoarseRow + 2 * kLightReach;

  void fill(const LightAxis& axis, std::size_t count, std::int64_t spacing,
            std::array<std::int64_t, kLongest>& world) const {
    for (std::size_t i = 0; i < count; ++i)
      world[i] =
          shape_.world_of(0, (axis.first - kLightReach + static_cast<std::int64_t>(i)) * spacing);
  }

  const TerrainShape& shape_;
  std::size_t used_ = 0;
  alignas(64) std::array<float, kLongest * 80 + (kMaxLightGrids - 1) * kWideLongest * 48> memory_;
};

}  // namespace

TerrainLight::TerrainLight(const TerrainShape& shape, const SunDirection& sun, std::int64_t block_x,
                           std::int64_t block_z, std::size_t finest) {
  const LightPlan plan(shape, sun, block_x, block_z, finest);
  const PlannedGrid& nearest = plan.grids[0];
  spacing_ = static_cast<std::size_t>(nearest.spacing);
  phase_x_ = cells_of(shape, block_x).phase_in(nearest.x, nearest.spacing);
  phase_z_ = cells_of(shape, block_z).phase_in(nearest.z, nearest.spacing);
  LightHeights heights(shape);
  std::array<LightGrid, kMaxLightGrids> grids;
  for (std::size_t g = 0; g < plan.count; ++g) {
    grids[g] = plan.grids[g].grid;
    grids[g].heights = heights.evaluate(plan.grids[g]);
  }
  light_terrain(grids.data(), plan.count, plan.shadows ? &plan.rays : nullptr,
                {sun_.data(), ambient_.data(), kStride});
  if (sun.is_down()) sun_.fill(0);
}

void TerrainLight::each_grid(
    const TerrainShape& shape, const SunDirection& sun, std::int64_t block_x, std::int64_t block_z,
    std::size_t finest,
    const std::function<void(LatticeSpan x, LatticeSpan z, GroundDetail detail)>& visit) {
  const LightPlan plan(shape, sun, block_x, block_z, finest);
  for (std::size_t g = 0; g < plan.count; ++g) {
    const PlannedGrid& grid = plan.grids[g];
    visit(grid.lattice(shape, grid.x), grid.lattice(shape, grid.z), grid.detail);
  }
}

double TerrainLight::work(const TerrainShape& shape, const SunDirection& sun, std::int64_t block_x,
                          std::int64_t block_z, std::size_t finest) {
  const LightPlan plan(shape, sun, block_x, block_z, finest);
  double work = 0;
  for (std::size_t g = 0; g < plan.count; ++g) {
    const PlannedGrid& grid = plan.grids[g];
    work += shape.noise.work(grid.columns(), grid.rows(), grid.spacing_of_noise(shape),
                             shape.octaves(grid.detail));
    const auto heights = static_cast<double>(grid.columns() * grid.rows());
    work += shape.layer_work(grid.lattice(shape, grid.x), grid.lattice(shape, grid.z), heights,
                             grid.detail);
  }
  return work;
}

LightSamples TerrainLight::samples() const {
  return {sun_.data(), ambient_.data(), kStride, spacing_, phase_x_, phase_z_};
}

}  // namespace psygen::models
