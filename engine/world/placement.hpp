// What stands where: the models of a block with their parameters, a pure function of world and
// block. The same on every machine and in any order of blocks. Knows no meshes. Any thread.
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

// The index of a block's terrain among its meshes; models count from 0.
inline constexpr std::uint32_t kTerrainIndex = UINT32_MAX;

struct Placement {
  models::ModelIndex model = 0;
  std::uint32_t index = 0;   // within the block; names the instance
  glm::vec3 position{0.0F};  // metres from the block's corner; y is the ground under the foot
  models::Parameters parameters;
};

// Tries of an instance to find a place that its Scatter allows.
inline constexpr int kPlacementTries = 24;

// Where a type has `slope_x` and `slope_z` as placed parameters; −1: it has not.
using SlopeParameters = std::array<int, 2>;
SlopeParameters slope_parameters(const models::ModelType& type);

// One scatter on one block: what place_models() does, instance by instance. All arguments must
// outlive it.
class Scattering {
 public:
  Scattering(const World& world, const models::ModelType& type, const Scatter& scatter,
             core::BlockCoord block);

  // The first allowed one of the places that instance `index` of the block tries, in metres from
  // the block's corner. `ground` is that of the block, or of a larger node that has the block's
  // corner at `corner_m`.
  struct Foothold {
    glm::vec3 position{0.0F};
    glm::vec3 normal{0, 1, 0};  // of the ground
  };
  std::optional<Foothold> place(const models::BlockGround& ground, std::uint32_t index,
                                glm::dvec2 corner_m = {0, 0}) const;
  // On ground with this normal: types that have the placed parameters `slope_x` and `slope_z`
  // follow it.
  models::Parameters parameters(std::uint32_t index, const glm::vec3& normal = {0, 1, 0}) const;

 private:
  std::uint64_t seed_;
  float size_m_;
  const models::ModelType& type_;
  const Scatter& scatter_;
  std::span<const models::ParameterSpec> specs_;
  models::Parameters defaults_;
  core::BlockCoord block_;
  float least_up_;
  SlopeParameters slope_;
};

// Steps in degrees in which the terrain's shadows follow the sun: each makes new meshes.
inline constexpr double kSunAzimuthStep = 2, kSunElevationStep = 1;

// Sets the sun of a terrain to the nearest step. One value for all suns that are down, one for all
// that stand in the zenith.
void set_sun(models::Parameters& terrain, double azimuth_deg, double elevation_deg);

// The terrain of one block in the light of the world's sky.
models::Parameters terrain_parameters(const World& world, core::BlockCoord block);

// An upper bound of the placements of one block: the sum of all counts. Exact where no scatter has
// a filter.
std::size_t models_per_block(const World& world);

// Replaces `out` by the placements of `block`, by growing index. An instance that finds no allowed
// place in kPlacementTries tries is left out; the indices of the others do not change. About 10 µs
// for the block's heights and 0.1 µs for each model. Does not ask whether the world contains the
// block. Needs 350 KiB of stack.
void place_models(const World& world, const models::Registry& registry, core::BlockCoord block,
                  std::vector<Placement>& out);
// The same with the block's ground at hand.
void place_models(const World& world, const models::Registry& registry, core::BlockCoord block,
                  const models::BlockGround& ground, std::vector<Placement>& out);

// The mean number of instances of each scatter that find a place in a block: exact where nothing
// has a filter, else over kSizeBlocks blocks, always the same ones.
std::vector<double> placed_per_block(const World& world, const models::Registry& registry);

// Sets a parameter of either type; integers are rounded to nearest.
void set_parameter(const models::ModelType& type, models::Parameters& parameters, std::size_t i,
                   double value);

// Sets them to the rise of the ground per metre, within their ranges.
void set_slope(const models::ModelType& type, const SlopeParameters& indices, glm::vec2 slope,
               models::Parameters& parameters);

// The parameters of a scatter with everything at the low end of its range.
models::Parameters scatter_parameters(const models::Registry& registry, const Scatter& scatter);

// The parameters of instance `index` of `block`, which belongs to `scatter`; the same that
// place_models() gives it, but on level ground.
models::Parameters draw_parameters(const World& world, const models::Registry& registry,
                                   const Scatter& scatter, core::BlockCoord block,
                                   std::uint32_t index);

}  // namespace psygen::world
