// The terrain of one block: a ridged multifractal heightfield (paper, section 5.2, eq. 3;
// docs/models.md, "Terrain"), its mesh at four levels, and the height of the ground anywhere.
// Positions are exact at any distance from the origin. Neighbouring blocks and levels agree bit for
// bit at shared vertices. All functions are pure and usable from any thread.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "engine/core/coordinates.hpp"
#include "engine/models/model_type.hpp"

namespace psygen::models {

// Indices into the schema of the type "terrain".
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

// The model type "terrain". Level 0 has every vertex, levels 1 … 3 every Nth one (terrain_strides()
// in grid.hpp). Vertices are core::TerrainVertex: n² of the surface, then 4·(n − 1) of the skirt.
// The first 3 · terrain_surface_triangles() indices are the surface, the others the skirt. bounds()
// and the result of synthesise() exclude the skirt. Synthesis needs 448 KiB of stack and no heap.
std::unique_ptr<ModelType> make_terrain_type();

// Triangles of a level without its skirts (7,938 for 64 vertices per side at level 0).
std::uint32_t terrain_surface_triangles(const Parameters& terrain, int level);

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

// The ground under one point: its height in metres, and its normal.
double ground_height_m(const Parameters& terrain, core::BlockCoord block, double local_x,
                       double local_z);
glm::vec3 ground_normal(const Parameters& terrain, core::BlockCoord block, double local_x,
                        double local_z);

}  // namespace psygen::models
