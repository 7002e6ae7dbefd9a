// Places models: the models of a block with their parameters, as a pure function of world, its
// edits and block. The same on every machine and in any order of blocks. Any thread. Knows no
// meshes. docs/models.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/models/terrain/ground.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// The index of a block's terrain among its meshes. Models count from 0.
inline constexpr std::uint32_t kTerrainIndex = UINT32_MAX;
// Models that edits have placed have this index plus their id. Ids end at kMaxEditId.
inline constexpr std::uint32_t kPlacedIndex = 1U << 30;
inline constexpr std::uint32_t kMaxEditId = (1U << 30) - 1;
// Those of the world's file (places.hpp) have this index plus their number, from 1.
inline constexpr std::uint32_t kFilePlacedIndex = 1U << 31;

// One model on a block.
struct Placement {
  models::ModelIndex model = 0;
  std::uint32_t index = 0;   // of the instance within the block
  glm::vec3 position{0.0F};  // metres from the block's corner; y is the ground under the foot
  models::Parameters parameters;
};

// Number of random places that an instance tries until its Scatter allows one.
inline constexpr int kPlacementTries = 24;

// Positions of the placed parameters `slope_x` and `slope_z` in a schema; −1 where it has none.
using SlopeParameters = std::array<int, 2>;
// The positions in the schema of a type.
SlopeParameters slope_parameters(const models::ModelType& type);

// One scatter on one block: the steps of place_models(), instance by instance.
class Scattering {
 public:
  // All arguments must outlive it, except `block`.
  Scattering(const World& world, const models::ModelType& type, const Scatter& scatter,
             core::BlockCoord block);

  // A place of an instance, in metres from the block's corner.
  struct Foothold {
    glm::vec3 position{0.0F};
    glm::vec3 normal{0, 1, 0};  // of the ground
  };
  // The first allowed place that instance `index` of the block tries, or nothing, also where a mask
  // or a road leaves it out there. `ground` is that of the block, or of a larger node that has the
  // block's corner at `corner_m`.
  std::optional<Foothold> place(const models::BlockGround& ground, std::uint32_t index,
                                glm::dvec2 corner_m = {0, 0}) const;
  // The parameters of instance `index` on ground with this normal. Types with the placed parameters
  // `slope_x` and `slope_z` get the slope.
  models::Parameters parameters(std::uint32_t index, const glm::vec3& normal = {0, 1, 0}) const;

 private:
  bool may_stand(const models::GroundPoint& ground, glm::dvec2 local_m) const;
  bool is_left_out(std::uint32_t index, glm::dvec2 local_m) const;

  std::uint64_t seed_;
  float size_m_;
  const models::ModelType& type_;
  const Scatter& scatter_;
  std::span<const models::ParameterSpec> specs_;
  models::Parameters defaults_;
  core::BlockCoord block_;
  float min_up_;
  std::optional<Palette> palette_;                // where kinds of ground matter
  std::vector<const models::GroundEdit*> roads_;  // that may pass the block
  SlopeParameters slope_;
};

// Steps in degrees in which the terrain's shadows follow the sun. Every step needs new meshes.
inline constexpr double kSunAzimuthStep = 2, kSunElevationStep = 1;

// Sets the sun of a terrain to the nearest step. All suns below the horizon get the same values,
// and so do all suns in the zenith.
void set_sun(models::Parameters& terrain, double azimuth_deg, double elevation_deg);

// The terrain of one block in the light of the world's sky, with the edits that reach it.
models::Parameters terrain_parameters(const World& world, core::BlockCoord block);
// The same for a node of 2^level × 2^level blocks, counted in nodes of its level.
models::Parameters terrain_parameters(const World& world, core::BlockCoord node, int node_level);
// How far beyond a node's border its ground mesh depends on heights, in blocks.
double ground_margin(const World& world, int node_level);

// An upper bound of the placements of one block without edits: the sum of all counts. Exact where
// no scatter has a filter and no road passes.
std::size_t models_per_block(const World& world);

// Replaces `out` by the placements of `block`, by growing index. An instance that finds no allowed
// place in kPlacementTries tries is left out; the indices of the others do not change. About 10 µs
// for the block's heights and 0.1 µs for each model. Does not check whether the world contains the
// block. Needs 350 KiB of stack.
// With edits: instances find their places on the ground without edits, and stand on the ground with
// them. Removed ones are left out; those that edits have placed follow, by growing id, and those of
// the world's file.
void place_models(const World& world, const models::Registry& registry, core::BlockCoord block,
                  std::vector<Placement>& out);
// The same with the block's ground already made, which has the block's edits.
void place_models(const World& world, const models::Registry& registry, core::BlockCoord block,
                  const models::BlockGround& ground, std::vector<Placement>& out);

// The same without the instances of scatters that are not `wanted`, which has one entry for each of
// World::scatter; what was placed by hand is there. Takes as much less time.
void place_models(const World& world, const models::Registry& registry, core::BlockCoord block,
                  const std::vector<bool>& wanted, std::vector<Placement>& out);

// How much of the ground at a place of a block is a road, 0 … 1. O(log n + pieces of roads there).
float road_at(const World& world, core::BlockCoord block, glm::dvec2 local_m);

// The mean number of instances of each scatter that find a place in a block. Exact if no scatter
// has a filter and there are no roads; otherwise the mean over kSizeBlocks blocks, always the same
// ones.
// `known`: those of some scatters, as from a world that has them in common (world_parts.hpp).
std::vector<double> placed_per_block(const World& world, const models::Registry& registry,
                                     std::span<const std::optional<double>> known = {});

// Sets parameter `i`, of either type. Integers are rounded to nearest and limited to 64 bits.
void set_parameter(const models::ModelType& type, models::Parameters& parameters, std::size_t i,
                   double value);

// Sets the slope parameters at `indices` to the rise of the ground per metre along x and z, limited
// to their hard ranges.
void set_slope(const models::ModelType& type, const SlopeParameters& indices, glm::vec2 slope,
               models::Parameters& parameters);

// The parameters of a scatter with every value at the low end of its range.
models::Parameters scatter_parameters(const models::Registry& registry, const Scatter& scatter);

// The parameters of instance `index` of `block`, which must belong to `scatter`: those of
// place_models(), but on level ground.
models::Parameters draw_parameters(const World& world, const models::Registry& registry,
                                   const Scatter& scatter, core::BlockCoord block,
                                   std::uint32_t index);

}  // namespace psygen::world
