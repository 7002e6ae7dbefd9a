// Placement: the models of a block with their parameters, as a pure function of the world
// definition, its edits and the block. The same on every machine and in any order of blocks. Any
// thread. Knows no meshes. docs/models.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/models/registry.hpp"
#include "engine/models/terrain/ground.hpp"
#include "engine/world/place_search.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// The index of a block's terrain among its meshes. Indices of models start at 0.
inline constexpr std::uint32_t kTerrainIndex = UINT32_MAX;
// A model that an edit has placed has this index plus its id. Ids end at kMaxEditId.
inline constexpr std::uint32_t kPlacedIndex = 1U << 30;
inline constexpr std::uint32_t kMaxEditId = (1U << 30) - 1;
// A model that the world file places (places.hpp) has this index plus its number, from 1.
inline constexpr std::uint32_t kFilePlacedIndex = 1U << 31;

// One model on a block.
struct Placement {
  models::ModelIndex model = 0;
  std::uint32_t index = 0;   // within the block
  glm::vec3 position{0.0F};  // metres from the block's corner; y is the ground at the base point
  models::Parameters parameters;
};

// Indices of the parameters `slope_x` and `slope_z` in a schema; −1 if the type lacks them.
using SlopeParameters = std::array<int, 2>;
// The indices for a model type.
SlopeParameters slope_parameters(const models::ModelType& type);

// One scatter on one block, with the single steps of place_models().
class Scattering {
 public:
  // All arguments must outlive it.
  Scattering(const World& world, const models::ModelType& type, const Scatter& scatter,
             BlockObstacles& block);

  // The position of an instance, as PlaceSearch::find(). Nothing also if it must give way to
  // another one (Spacing).
  std::optional<Foothold> place(const models::BlockGround& ground, std::uint32_t index,
                                glm::dvec2 corner_m = {0, 0}) const;
  // The parameters of instance `index` on ground with this normal. Types with the parameters
  // `slope_x` and `slope_z` get the slope.
  models::Parameters parameters(std::uint32_t index, const glm::vec3& normal = {0, 1, 0}) const;

 private:
  std::uint64_t seed_;
  const models::ModelType& type_;
  const Scatter& scatter_;
  std::span<const models::ParameterSpec> specs_;
  models::Parameters defaults_;
  BlockObstacles& obstacles_;
  PlaceSearch search_;
  SlopeParameters slope_;
};

// The terrain's shadows follow the sun in steps of this many degrees. Every step needs new meshes.
inline constexpr double kSunAzimuthStep = 2, kSunElevationStep = 1;

// Sets the sun of a terrain to the nearest step. All suns below the horizon give the same values,
// and so do all suns in the zenith.
void set_sun(models::Parameters& terrain, double azimuth_deg, double elevation_deg);

// The parameters of the terrain of a node of 2^level × 2^level blocks under the world's sky, with
// the edits that reach it. `node` counts nodes of this level; at level 0 it is a block.
models::Parameters terrain_parameters(const World& world, core::BlockCoord node,
                                      int node_level = 0);
// The parameters of the surface of the rivers and lakes of such a node (models::make_water_type());
// nothing if it has none. O(log n) without water.
std::optional<models::Parameters> water_parameters(const World& world, core::BlockCoord node,
                                                   int node_level = 0);
// The quantised heights of the vertices of a block's finest mesh, row by row: the ground of
// queries, physics and saves. About 15 µs for 64 x 64 vertices.
std::vector<std::uint16_t> ground_of_block(const World& world, core::BlockCoord block);
// Distance beyond a node's border up to which heights affect the node's ground mesh, in blocks.
double ground_margin(const World& world, int node_level);

// Distance beyond a block up to which its instances look at the ground, in metres. Other blocks
// answer as a whole about the candidates that keep apart.
double ground_reach_m(const World& world);

// An upper bound of the placements of one block without edits: the sum of all counts. Exact for
// worlds in which no scatter has a filter or a spacing and no road or water crosses the block.
std::size_t models_per_block(const World& world);

// Replaces `out` by the placements of `block`, by ascending index. An instance that finds no
// allowed position (PlaceSearch) or gives way (Spacing) is skipped; the indices of the others do
// not change. Takes about 10 µs for the block's heights and 0.1 µs for each model, and 15 µs where
// models keep apart. Does not check that the world contains the block. Edits: instances find their
// positions on the unedited ground and stand on the edited ground. Removed instances are skipped.
// The models placed by edits follow, by ascending id, then those placed by the world file.
void place_models(const World& world, const models::Registry& registry, core::BlockCoord block,
                  std::vector<Placement>& out);
// The same for a caller that already has the block's ground, with the block's edits.
void place_models(const World& world, const models::Registry& registry, core::BlockCoord block,
                  const models::BlockGround& ground, std::vector<Placement>& out);

// The same without the instances of the scatters whose entry in `wanted` is false (one entry for
// each of World::scatter). Models placed by hand are included. Takes correspondingly less time.
void place_models(const World& world, const models::Registry& registry, core::BlockCoord block,
                  const std::vector<bool>& wanted, std::vector<Placement>& out);

// The fraction of the ground that is road at a point of a block, 0 … 1. O(log n + road pieces
// there).
float road_at(const World& world, core::BlockCoord block, glm::dvec2 local_m);

// The mean number of instances per block that find a position, for each scatter. Exact if no
// scatter has a filter or a spacing and there are no roads; otherwise the mean over kSizeBlocks
// blocks, always the same ones. `known` holds results that the caller already has, such as those of
// a world with the same scatters (world_parts.hpp).
std::vector<double> placed_per_block(const World& world, const models::Registry& registry,
                                     std::span<const std::optional<double>> known = {});

// Sets parameter `i`, integer or real. Integers are rounded to nearest and limited to 64 bits.
void set_parameter(const models::ModelType& type, models::Parameters& parameters, std::size_t i,
                   double value);

// Sets the slope parameters at `indices` to the rise of the ground per metre along x and z, limited
// to their hard ranges.
void set_slope(const models::ModelType& type, const SlopeParameters& indices, glm::vec2 slope,
               models::Parameters& parameters);

// The parameters of a scatter with every value at the low end of its range.
models::Parameters scatter_parameters(const models::Registry& registry, const Scatter& scatter);

// The parameters of instance `index` of `block`, which must belong to `scatter`: those of
// place_models() on level ground.
models::Parameters draw_parameters(const World& world, const models::Registry& registry,
                                   const Scatter& scatter, core::BlockCoord block,
                                   std::uint32_t index);

// The largest extent of any scattered model from its base point in metres: sideways along x or z,
// and up. Takes the largest bounds (ModelType::bounds) over the corners of every scatter's
// parameter ranges; up to 4096 bounds a scatter.
glm::vec2 models_reach_m(const World& world, const models::Registry& registry);

// The maximum of `scattered`, a result of models_reach_m(), and the extents of the models that
// edits have placed. O(1).
glm::vec2 with_placed_models(glm::vec2 scattered, const World& world);

}  // namespace psygen::world
