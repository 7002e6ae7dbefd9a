// Light that is baked into the vertices of a terrain (docs/models.md, "Light"): the fractions of
// the sun and of the sky that are visible over the surrounding hills. A pure function of the
// position in the world, so neighbouring nodes of one level agree bit for bit along their seams.
// Any thread. Knows no vertices.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "engine/models/terrain/grid.hpp"
#include "engine/models/terrain/kernel.hpp"
#include "engine/models/terrain/light_kernel.hpp"
#include "engine/models/terrain/shape.hpp"

namespace psygen::models {

// Cells between the points of the finest grid. For 64 vertices per side these are the vertices of
// level 1.
inline constexpr int kLightCells = 3;
// Largest number of grids. Each has its points kLightRatio times as far apart as the one before.
inline constexpr std::size_t kMaxLightGrids = 5;
// A grid uses the octaves whose lattice cells are at least this many points wide.
inline constexpr double kOctavePoints = 2;
// Half the width of the sun's disc, softened to hide the distances between points.
inline constexpr double kSunSoftness = 2.5;  // degrees
// Grids ignore the horizon if their points are further apart than this many times the height range.
inline constexpr double kSkyReach = 2;

// The sun of a terrain. Azimuth from −Z (north) over +X (east), elevation above the horizon.
struct SunDirection {
  double azimuth_deg, elevation_deg;
  // True for no sunlight at all, or for no shadows.
  bool is_down() const { return elevation_deg <= 0; }
  bool is_overhead() const { return elevation_deg >= 90; }
};

// The light of one node, computed by the constructor. About 23 KiB, no heap.
class TerrainLight {
 public:
  // Evaluates the light at the points of grid number `finest`, 0 or 1. About 5 µs for 0.
  TerrainLight(const TerrainShape& shape, const SunDirection& sun, std::int64_t block_x,
               std::int64_t block_z, std::size_t finest);
  TerrainLight(const TerrainLight&) = delete;
  TerrainLight& operator=(const TerrainLight&) = delete;

  // The light for pack_terrain(). Points into this object.
  LightSamples samples() const;

  // Calls visit(x, z, detail) with the heights that each grid reads, in cells of node level 0.
  static void each_grid(
      const TerrainShape& shape, const SunDirection& sun, std::int64_t block_x,
      std::int64_t block_z, std::size_t finest,
      const std::function<void(LatticeSpan x, LatticeSpan z, GroundDetail detail)>& visit);

  // Part of the constructor's time for heights, of noise and edits, in units of
  // RidgedNoise::work().
  static double work(const TerrainShape& shape, const SunDirection& sun, std::int64_t block_x,
                     std::int64_t block_z, std::size_t finest);

 private:
  static constexpr std::size_t kRows = (kMaxTerrainSize - 1) / kLightCells + 3;
  static constexpr std::size_t kStride = kLightRow + 16;
  static_assert(kRows <= kLightRow);

  alignas(64) std::array<float, kRows * kStride> sun_;
  alignas(64) std::array<float, kRows * kStride> ambient_;
  std::size_t spacing_, phase_x_, phase_z_;
};

}  // namespace psygen::models
