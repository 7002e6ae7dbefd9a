// Light that is baked into the vertices of a terrain (docs/models.md, "Light"): how much of the sun
// and of the sky is seen over the hills around. A function of the place in the world: neighbouring
// nodes of one level agree bit for bit along their seams. Knows no vertices.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/models/terrain/grid.hpp"
#include "engine/models/terrain/kernel.hpp"
#include "engine/models/terrain/light_kernel.hpp"
#include "engine/models/terrain/shape.hpp"

namespace psygen::models {

// Points of the finest grid lie this many cells apart: on the vertices of level 1 of 64 per side.
inline constexpr int kLightCells = 3;
// Grids, each with points kLightRatio times as far apart as those of the one before.
inline constexpr std::size_t kMaxLightGrids = 5;
// Octaves count whose lattice cells are as wide as the distance of so many points.
inline constexpr double kOctavePoints = 2;
// Half the width of the sun's disc, softened to hide the distances between points.
inline constexpr double kSunSoftness = 2.5;  // degrees
// Grids whose points are further apart than so many times the relief see no horizon worth counting.
inline constexpr double kSkyReach = 2;

// The sun of `terrain`; azimuth from −Z (north) over +X (east), in degrees.
struct SunDirection {
  double azimuth_deg, elevation_deg;
  bool is_down() const { return elevation_deg <= 0; }
  bool is_overhead() const { return elevation_deg >= 90; }
};

class TerrainLight {
 public:
  // The light of a node whose points are those of grid number `finest`, 0 or 1. About 5 µs for 0.
  TerrainLight(const TerrainShape& shape, const SunDirection& sun, std::int64_t block_x,
               std::int64_t block_z, std::size_t finest);
  TerrainLight(const TerrainLight&) = delete;
  TerrainLight& operator=(const TerrainLight&) = delete;

  LightSamples samples() const;

  // Of the noise (RidgedNoise::work) that the heights for it take.
  static double noise_work(const TerrainShape& shape, const SunDirection& sun, std::int64_t block_x,
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
