// The levels of a scene's quadtree: how many there are, what a node of each draws, and how near the
// camera a node is split into its four children. Pure; nothing of what exists at the moment.
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

// What the nodes of one level have in common.
struct NodeLevel {
  double size_m = 0;          // side of a node
  double ground_error_m = 0;  // of the ground that its nodes draw (blocks: when not near), nearly
                              // everywhere (ground_error.hpp)
  double ground_bound_m = 0;  // the same at the worst place of any node
  double error_m = 0;         // with what stands on it
  float skirt_m = 0;          // how far the borders of its ground hang down
  std::uint16_t mesh_level = 0;  // of the terrain type, that its nodes draw (blocks: when not near)
  bool merged = false;           // its nodes have one mesh for all models on them
  core::Bounds bounds;           // of the ground, from the node's corner
};

// Finest first; a single one where levels of detail are off. `merged` is the type of meshes that
// stand for everything on a node; null: there are none. `before`: those of a world with the same
// ground, whose errors need not be measured again; empty: there is none.
std::vector<NodeLevel> node_levels(const world::World& world, const models::Registry& registry,
                                   const Settings& settings, const models::ModelType* merged,
                                   std::span<const NodeLevel> before = {});

// How many nodes of a level a world of this many blocks has along an axis. 0 stands for endless.
constexpr std::int64_t nodes_along(std::int64_t blocks, std::size_t level) {
  return (blocks + (std::int64_t{1} << level) - 1) >> level;
}

// The ground of a node.
models::Parameters node_terrain(const world::World& world, const visibility::NodeCoord& node);

// The block of the world that is nearest to `block`: itself, if it exists.
core::BlockCoord nearest_block(const world::World& world, core::BlockCoord block);

// A block anywhere in the world; in an endless one within some thousand blocks of its origin.
core::BlockCoord any_block(const world::World& world, core::RandomStream& random);

// Whether any block of the node exists.
bool contains(const world::World& world, const visibility::NodeCoord& node);
// Whether any of its blocks does not.
bool overhangs(const world::World& world, const visibility::NodeCoord& node);

// Replaces `distances`, one for each level: where an error covers `error_pixels`, but at 0.6 … 3
// sides of the node; beyond the last merged meshes at 3 km or 3 sides at least. Blocks take
// their finest mesh as near as their error says, at most at 3 sides.
void split_distances(std::span<const NodeLevel> levels, const Settings& settings,
                     double pixels_per_radian, double error_pixels,
                     std::vector<visibility::LevelDistances>& distances);

// Nodes of a level that lie in a parent nearer than this to the middle of the camera's block exist
// as entities: farther than anything is split, so that they are ready when it is. Of the coarsest
// level all up to this distance exist, which is beyond what is seen.
double existing_distance_m(std::span<const NodeLevel> levels, const Settings& settings,
                           std::size_t level,
                           std::span<const visibility::LevelDistances> distances);

// Nodes to each side of the camera's that can exist at most; from the nearest node of the world, if
// the camera is outside of it.
std::uint32_t window_radius(std::span<const NodeLevel> levels, const Settings& settings,
                            std::size_t level);
// The same where nodes are split at these distances.
std::uint32_t window_radius(std::span<const NodeLevel> levels, const Settings& settings,
                            std::size_t level,
                            std::span<const visibility::LevelDistances> distances);

}  // namespace psygen::scene
