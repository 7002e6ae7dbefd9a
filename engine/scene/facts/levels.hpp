// The levels of a scene's quadtree: their number, the meshes that nodes of each level draw, and the
// distances at which a node splits into its four children. Pure; knows nothing of the nodes that
// exist.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/models/registry.hpp"
#include "engine/scene/settings.hpp"
#include "engine/visibility/quadtree.hpp"
#include "engine/world/world.hpp"

namespace psygen::scene {

// The properties that all nodes of one level share.
struct NodeLevel {
  double size_m = 0;          // side of a node
  double ground_error_m = 0;  // error of the drawn ground (blocks: when not near), in nearly all
                              // places (measured_ground_error_m)
  double ground_bound_m = 0;  // maximum of that error over all nodes
  double error_m = 0;         // including scattered models
  double placed_error_m = 0;  // of placed models (count_placed)
  float skirt_m = 0;          // height of the skirts at its borders
  std::uint16_t mesh_level =
      0;                // level of the terrain type that its nodes draw (blocks: when not near)
  bool merged = false;  // all its nodes have merged meshes, not only those with placed models
  core::Bounds bounds;  // of the ground, relative to the node's corner
};

// Returns the levels, finest first; only one if levels of detail are off. `merged` is the type of
// merged meshes; null: none. `before`: levels of a world with the same ground, whose errors are
// reused; empty: none.
std::vector<NodeLevel> node_levels(const world::World& world, const models::Registry& registry,
                                   const SceneSettings& settings, const models::ModelType* merged,
                                   std::span<const NodeLevel> before = {});

// Sets NodeLevel::placed_error_m by the models that the file and the edits of the world place.
void count_placed(const world::World& world, std::span<NodeLevel> levels);

// The number of nodes of a level along an axis of a world with this many blocks. 0 stands for
// endless.
constexpr std::int64_t nodes_along(std::int64_t blocks, std::size_t level) {
  return (blocks + (std::int64_t{1} << level) - 1) >> level;
}

// The parameters of a node's ground.
models::Parameters node_terrain(const world::World& world, const visibility::NodeCoord& node);

// The block of the world nearest to `block`; `block` itself if it exists.
core::BlockCoord nearest_block(const world::World& world, core::BlockCoord block);

// Random blocks of a world, for samples. In a world of a river network they lie around one place on
// land, because land far from other land takes milliseconds to make. Immutable, any thread.
class SampleBlocks {
 public:
  // Finds that place by up to 24 heights. `world` must outlive it unchanged.
  explicit SampleBlocks(const world::World& world);

  // A block anywhere in the world; in an endless one within some thousand blocks of its origin. In
  // a world of a river network it belongs to one of 4 × 4 neighbouring nodes of a level.
  core::BlockCoord next(core::RandomStream& random, std::uint32_t level = 0) const;
  const world::World& world() const { return world_; }

 private:
  const world::World& world_;
  core::BlockCoord land_;
};

// True if any block of the node exists.
bool contains(const world::World& world, const visibility::NodeCoord& node);
// True if any of its blocks does not exist.
bool overhangs(const world::World& world, const visibility::NodeCoord& node);

// Computes `distances`, one for each level: the distance at which an error covers `error_pixels`,
// clamped to 0.6 … 3 sides of the node; beyond the last merged meshes at least 3 km or 3 sides.
// Blocks use their finest mesh up to the distance that its error gives, at most 3 sides.
void split_distances(std::span<const NodeLevel> levels, const SceneSettings& settings,
                     double pixels_per_radian, double error_pixels,
                     std::vector<visibility::LevelDistances>& distances);

// The input of a cut around a position up to this distance. Sets `roots`, which must outlive it, as
// must `distances`.
visibility::CutInput cut_input(const world::World& world, std::span<const NodeLevel> levels,
                               const core::WorldPosition& camera,
                               std::span<const visibility::LevelDistances> distances,
                               double view_distance_m, std::vector<visibility::NodeCoord>& roots);

// The distance within which nodes of a level exist as entities, measured from the middle of the
// camera's block to their parent. It exceeds every split distance, so that nodes are ready when
// they are needed. Nodes of the coarsest level exist up to this distance themselves, which exceeds
// the view distance.
double existing_distance_m(std::span<const NodeLevel> levels, const SceneSettings& settings,
                           std::size_t level,
                           std::span<const visibility::LevelDistances> distances);

// The maximum number of existing nodes to each side of the camera's node, or of the world's nearest
// node if the camera is outside the world.
std::uint32_t window_radius(std::span<const NodeLevel> levels, const SceneSettings& settings,
                            std::size_t level);
// As above, for these split distances.
std::uint32_t window_radius(std::span<const NodeLevel> levels, const SceneSettings& settings,
                            std::size_t level,
                            std::span<const visibility::LevelDistances> distances);

// The largest window of a level: a square that holds all nodes of the world within reach.
std::uint32_t largest_radius(const world::World& world, std::span<const NodeLevel> levels,
                             const SceneSettings& settings, std::size_t level);

// The error in metres of nodes of a level that draw level 1 of the terrain type, measured at some
// nodes of the world: 95 % of the vertices lie within this vertical distance of level 0; sharp
// ridges lie beyond it. The bound that follows from the parameters (ModelType::level_error_m) is
// several times as large where cells are small, because octaves seldom add up. Synthesises 16
// nodes, or 6 of a river network. Pure: the same for a world everywhere.
double measured_ground_error_m(const SampleBlocks& blocks, const models::Registry& registry,
                               int node_level);

}  // namespace psygen::scene
