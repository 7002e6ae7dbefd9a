// The terrain of one block: a ridged multifractal heightfield (paper, section 5.2, eq. 3;
// docs/models.md, "Terrain"), its mesh at four levels, and the height of the ground anywhere.
// Positions are exact at any distance from the origin. Neighbouring blocks and levels agree bit for
// bit at shared vertices. All functions are pure and usable from any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <iterator>
#include <limits>
#include <memory>
#include <span>

#include "engine/core/coordinates.hpp"
#include "engine/models/model_type.hpp"
#include "engine/models/terrain/grid.hpp"
#include "engine/models/terrain/ridged_kernel.hpp"

namespace psygen::models {

// Indices into kTerrainSchema.
enum TerrainParameter : std::size_t {
  kTerrainSeed = 0,
  kTerrainBlockX,
  kTerrainBlockZ,
  kTerrainNodeLevel,
  kTerrainSize,
  kTerrainCellM,
  kTerrainHeight,
  kTerrainLacunarity,
  kTerrainOctaves,
  kTerrainOffset,
  kTerrainGain,
  kTerrainFeatureM,
  kTerrainReliefM,
  kTerrainWarp,
  kTerrainSunAzimuth,
  kTerrainSunElevation,
  kTerrainParameterCount
};

// The limits of a block's index along an axis.
inline constexpr double kMinBlock = std::numeric_limits<std::int32_t>::min();
inline constexpr double kMaxBlock = std::numeric_limits<std::int32_t>::max();

// The schema of the type "terrain", by TerrainParameter.
inline constexpr ParameterSpec kTerrainSchema[] = {
    placed(integer_parameter("seed", "", 1, {-0x1.0p63, 0x1.0p63}, {0, 1000},
                             "selects one of all terrains")),
    placed(integer_parameter("block_x", "blocks", 0, {kMinBlock, kMaxBlock}, {-1000, 1000},
                             "block along x")),
    placed(integer_parameter("block_z", "blocks", 0, {kMinBlock, kMaxBlock}, {-1000, 1000},
                             "block along z")),
    placed(integer_parameter(
        "node_level", "", 0, {0, 20}, {0, 10},
        "cells are 2^node_level times as wide; blocks are counted in these wider ones")),
    integer_parameter("size", "vertices", 64, {kMinTerrainSize, kMaxTerrainSize}, {16, 128},
                      "vertices per side of a block"),
    real_parameter("cell_m", "m", 1, {0.01, 1000}, {0.25, 16},
                   "distance between neighbouring vertices"),
    real_parameter(
        "height", "1", 1.2, {0, 4}, {0.5, 1.5},
        "fractal increment H: the larger, the smoother; octave o counts lacunarity^(-H o)"),
    real_parameter("lacunarity", "1", 2, {1, 4}, {1.5, 3},
                   "ratio of the frequencies of two octaves"),
    integer_parameter("octaves", "", 9, {1, kMaxOctaves}, {1, 12}, "number of layers of noise"),
    real_parameter("offset", "1", 0.88, {0, 4}, {0.7, 1.2}, "height of the ridges before squaring"),
    real_parameter("gain", "1", 2, {0, 100}, {1, 4}, "influence of an octave on the next"),
    real_parameter("feature_m", "m", 600, {1, 1e5}, {50, 2000}, "width of the largest features"),
    real_parameter("relief_m", "m", 120, {0.01, 1e5}, {10, 500}, "largest possible height"),
    real_parameter(
        "warp", "1", 0, {0, 1}, {0, 0.5},
        "bends the coarse ridges: largest displacement, in parts of feature_m; 0 is fastest"),
    placed(real_parameter("sun_azimuth_deg", "degrees", 0, {-360, 360}, {0, 360},
                          "direction of the sun that casts shadows, from north over east")),
    placed(real_parameter("sun_elevation_deg", "degrees", 90, {-90, 90}, {0, 90},
                          "of the sun that casts shadows: at 90 none, at 0 and below all is dark")),
};
static_assert(std::size(kTerrainSchema) == kTerrainParameterCount);

// The model type "terrain". Level 0 has every vertex, levels 1 … 3 every Nth one (terrain_strides()
// in grid.hpp). Vertices are core::TerrainVertex: n² of the surface, then 4·(n − 1) of the skirt.
// The first 3 · terrain_surface_triangles() indices are the surface, the others the skirt. bounds()
// and the result of synthesise() exclude the skirt.
std::unique_ptr<ModelType> make_terrain_type();

// Triangles of a level without its skirts (7,938 for 64 vertices per side at level 0).
std::uint32_t terrain_surface_triangles(const Parameters& terrain, int level);

// Differences in metres between the heights of a node and those of nodes `levels` node levels above
// it, because coarser nodes leave out small gullies and read fewer nodes of a river network: a
// bound (of a network it holds for 99.9 % of places), and a usual one. Both are 0 on noise alone.
// The levels of both are at least 0.
struct DetailErrors {
  double bound_m = 0, usual_m = 0;
};
DetailErrors terrain_detail_errors_m(const Parameters& terrain, int levels);

// Metres from one corner of a block to the next: (size − 1) · cell_m · 2^node_level.
double terrain_block_size_m(const Parameters& terrain);

// A point of the ground. The normal is that of the triangle and has unit length.
struct GroundPoint {
  double height_m = 0;
  glm::vec3 normal{0, 1, 0};
};

// Writes the ground under points of `block`, on the triangles of level 0. Points are in metres from
// the block's corner and may be outside the block (within 10^6 cells). `ground` has as many
// elements as `local_xz`. About 1 µs a point; not much more than 20 µs in total for points inside
// the block. The block coordinates in `terrain` are ignored.
void sample_ground(const Parameters& terrain, core::BlockCoord block,
                   std::span<const glm::dvec2> local_xz, std::span<GroundPoint> ground);

// The height in metres of the ground under one point.
double ground_height_m(const Parameters& terrain, core::BlockCoord block, double local_x,
                       double local_z);

}  // namespace psygen::models
