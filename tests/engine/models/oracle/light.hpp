// An independent light of a terrain, as docs/models.md defines it: one point at a time,
// recursively, in double precision, with the library's sine and tangent.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

#include "tests/engine/models/oracle/terrain.hpp"

namespace psygen::models::test {

struct LightOracle {
  TerrainOracle terrain;
  double cell_m = 1, relief_m = 120;
  int node_level = 0;
  double azimuth = 0, elevation = 90;

  struct Seen {
    double lit_above = -1e30, dark_below = -1e30;
    std::array<double, 8> horizon{};
  };
  mutable std::map<std::tuple<int, std::int64_t, std::int64_t>, Seen> known = {};

  static std::int64_t cells(int grid) { return 3 * (std::int64_t{1} << (2 * grid)); }
  static std::int64_t floor_divide(std::int64_t a, std::int64_t b) {
    return a / b - (a % b < 0 ? 1 : 0);
  }
  double spacing_m(int grid) const {
    return static_cast<double>(cells(grid)) * std::ldexp(cell_m, node_level);
  }
  // Height of point (x, z) of a grid, counted from the world's origin.
  double height_m(int grid, std::int64_t x, std::int64_t z) const {
    TerrainOracle coarse = terrain;
    const double feature_m = cell_m / terrain.cells_per_step;
    coarse.octaves = 1;
    while (coarse.octaves < terrain.octaves &&
           feature_m / std::pow(terrain.lacunarity, coarse.octaves) >= 2 * spacing_m(grid))
      ++coarse.octaves;
    const std::int64_t steps = cells(grid) << node_level;
    return coarse.value(x * steps, z * steps) / terrain.max_value() * relief_m;
  }
  double tangent(double degrees) const { return std::tan(degrees * std::acos(-1.0) / 180); }
  double lower_slope() const { return tangent(std::max(elevation - 2.5, 0.0)); }
  double upper_slope() const { return tangent(std::min(elevation + 2.5, 89.0)); }
  bool casts_shadows() const { return elevation > 0 && elevation < 90; }
  bool looks_for_sun(int grid, double points) const {
    return casts_shadows() && points * spacing_m(grid) * lower_slope() <= relief_m;
  }
  bool looks_for_sky(int grid) const { return spacing_m(grid) <= 2 * relief_m; }

  template <class At>
  static double bilinear(double x, double z, const At& at) {
    const auto ix = static_cast<std::int64_t>(std::floor(x));
    const auto iz = static_cast<std::int64_t>(std::floor(z));
    const double fx = x - std::floor(x), fz = z - std::floor(z);
    return (at(ix, iz) * (1 - fx) + at(ix + 1, iz) * fx) * (1 - fz) +
           (at(ix, iz + 1) * (1 - fx) + at(ix + 1, iz + 1) * fx) * fz;
  }

  Seen seen(int grid, std::int64_t x, std::int64_t z) const {
    const auto [it, is_new] = known.try_emplace({grid, x, z});
    if (!is_new) return it->second;
    Seen s;
    if (grid < 4 && (looks_for_sun(grid + 1, 1) || looks_for_sky(grid + 1))) {
      const double wide_x = static_cast<double>(x) / 4, wide_z = static_cast<double>(z) / 4;
      const auto of = [&](const auto& field) {
        return bilinear(wide_x, wide_z, [&](std::int64_t i, std::int64_t k) {
          return field(seen(grid + 1, i, k));
        });
      };
      s.lit_above = of([](const Seen& w) { return w.lit_above; });
      s.dark_below = of([](const Seen& w) { return w.dark_below; });
      for (std::size_t k = 0; k < 8; ++k)
        s.horizon[k] = of([k](const Seen& w) { return w.horizon[k]; });
    }
    const double angle = azimuth * std::acos(-1.0) / 180;
    for (const double points : {1.0, std::sqrt(2.0), 2.0, 2 * std::sqrt(2.0)}) {
      if (!looks_for_sun(grid, points)) break;
      const double h =
          bilinear(static_cast<double>(x) + points * std::sin(angle),
                   static_cast<double>(z) - points * std::cos(angle),
                   [&](std::int64_t i, std::int64_t k) { return height_m(grid, i, k); });
      s.lit_above = std::max(s.lit_above, h - points * spacing_m(grid) * lower_slope());
      s.dark_below = std::max(s.dark_below, h - points * spacing_m(grid) * upper_slope());
    }
    const double own = height_m(grid, x, z);
    constexpr int kX[8] = {1, -1, 0, 0, 1, -1, -1, 1}, kZ[8] = {0, 0, 1, -1, 1, 1, -1, -1};
    for (std::size_t k = 0; k < 8 && looks_for_sky(grid); ++k) {
      for (const int far : {1, k < 4 ? 3 : 2}) {
        const double distance = far * spacing_m(grid) * (k < 4 ? 1 : std::sqrt(2.0));
        s.horizon[k] = std::max(
            s.horizon[k], (height_m(grid, x + far * kX[k], z + far * kZ[k]) - own) / distance);
      }
    }
    return known[{grid, x, z}] = s;
  }

  // Visible fractions in [0, 1] at a point of a grid.
  double sun_at_point(int grid, std::int64_t x, std::int64_t z) const {
    if (elevation <= 0) return 0;
    const Seen s = seen(grid, x, z);
    const double h = height_m(grid, x, z);
    if (h >= s.lit_above) return 1;
    return std::clamp((h - s.dark_below) / (s.lit_above - s.dark_below), 0.0, 1.0);
  }
  double sky_at_point(int grid, std::int64_t x, std::int64_t z) const {
    double sum = 0;
    for (const double slope : seen(grid, x, z).horizon)
      sum += 1 / (1 + slope * slope);
    return sum / 8;
  }

  // Light at a cell, counted from the world's origin; the mesh uses the points of `grid`.
  double sun(int grid, std::int64_t x, std::int64_t z) const {
    const auto at = [&](std::int64_t i, std::int64_t k) { return sun_at_point(grid, i, k); };
    return bilinear(static_cast<double>(x) / static_cast<double>(cells(grid)),
                    static_cast<double>(z) / static_cast<double>(cells(grid)), at);
  }
  double sky(int grid, std::int64_t x, std::int64_t z) const {
    const auto at = [&](std::int64_t i, std::int64_t k) { return sky_at_point(grid, i, k); };
    return bilinear(static_cast<double>(x) / static_cast<double>(cells(grid)),
                    static_cast<double>(z) / static_cast<double>(cells(grid)), at);
  }
};

}  // namespace psygen::models::test
