// The water of a world as a field: for any place its surface, depth, flow and the body of water
// that owns it: a lake, a river (water_shapes.hpp), or the sea (Water::level_m). Every reader of
// water asks here. Where a river and a lake meet, the one owns a place whose middle is nearer,
// measured in its widths; then the lower one, then that of the smaller number. The sea owns every
// other place, and those where it is higher.
// Pure functions of the world, in any order, on any thread, without a cache; they look at no mesh.
// Drawing is left to the renderer. docs/queries.md.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "engine/world/world.hpp"

namespace psygen::world {

// The name of a body of water within its world. Lakes of the file follow the sea in their order,
// then its rivers; bodies that a game adds have larger names (edits/edits.hpp), those of a river
// network the largest (models::kFirstNetworkBody).
using WaterBody = std::uint32_t;
inline constexpr WaterBody kNoWater = 0, kSea = 1, kFirstAdded = 1U << 31;

// A height below all ground, also as a float: the surface of water in a dry place.
inline constexpr double kDrySurfaceM = -1e30;

// The surface of a body of water over a place, whether the ground there is lower or higher.
struct WaterSurface {
  double surface_m = kDrySurfaceM;  // height in metres of the world
  glm::vec3 normal{0, 1, 0};        // unit length, upwards
  glm::vec2 flow_m_s{0.0F};         // velocity along x and z in metres a second; 0: still
  float foam = 0;                   // fraction of the surface that foams, 0 … 1
  // Of a river: in the file, by its width and depth, or by the drainage area of a river network
  // (models::network::discharge_m3_s()). Nothing: a lake, or the sea.
  std::optional<double> discharge_m3_s = std::nullopt;
  WaterBody body = kNoWater;  // never kNoWater where a function returns a surface
  // Depth above ground of this height, in metres; 0: the ground is dry.
  double depth_over(double ground_m) const { return std::max(surface_m - ground_m, 0.0); }
};

// The water at a place. If the place is dry, depth and flow are 0, the body is kNoWater and
// surface_m is kDrySurfaceM, so max(ground, surface_m) is the surface of the world anywhere.
struct WaterPoint : WaterSurface {
  double depth_m = 0;  // from the surface down to the ground; 0: dry
  bool is_dry() const { return body == kNoWater; }
};

// True if the world may have water anywhere. O(1).
bool has_water(const World& world);

// Returns the surface of the water over a place; nothing: no water reaches it at any height of the
// ground. Ignores the position's own height, and answers outside a bounded world as inside.
// Evaluates no ground of its own: some nanoseconds for a sea, some hundred where rivers and lakes
// may be, 2 µs in the water of a river network.
std::optional<WaterSurface> water_surface(const World& world, const core::WorldPosition& at);

// The same without the edits of the world: that of its function.
std::optional<WaterSurface> function_water_surface(const World& world,
                                                   const core::WorldPosition& at);
// The same without rivers and lakes: the sea, which is the same at all places.
std::optional<WaterSurface> sea_surface(const World& world);

// Returns the water at a place whose ground has this height in metres.
WaterPoint water_at(const World& world, const core::WorldPosition& at, double ground_m);

// Returns the water at a place, over the ground of models::ground_height_m(): about 1 µs; 30 µs
// with a river network and erosion.
// query::World::water() answers faster, for many places of a block.
WaterPoint water_at(const World& world, const core::WorldPosition& at);

// A hash of the lakes and rivers of the world's function that reach a block; 0: none does.
std::uint64_t bodies_hash_in(const World& world, core::BlockCoord block);
// Hashes of all that a file says about enabled lakes, and about enabled rivers.
std::uint64_t bodies_hash(const std::vector<Lake>& lakes);
std::uint64_t bodies_hash(const std::vector<River>& rivers);

}  // namespace psygen::world
