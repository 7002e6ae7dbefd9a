// The entities of a node: its ground, and its models or their merged mesh. Creates them, and
// changes them with the edits of the world. Does not decide which nodes exist
// (nodes/streaming.cpp). Main thread only.
#pragma once

#include <span>
#include <vector>

#include "ecs/ecs.hpp"
#include "engine/scene/events.hpp"
#include "engine/scene/settings.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/visibility/quadtree.hpp"
#include "engine/world/placement.hpp"

namespace psygen::scene {

struct Daylight;
struct WorldFacts;

// Bundle: everything that creating, changing and destroying nodes writes.
struct NodeWork {
  ecs::World& entities;
  synthesis::MeshSupply& supply;
  ecs::EventQueue<ModelCreated>& created;
  ecs::EventQueue<ModelRemoved>& removed;
};

// The ground of a node under the sun of the day.
models::Parameters lit_ground(const WorldFacts& facts, const Daylight& daylight,
                              const visibility::NodeCoord& at);

// Creates a node and its models, and returns the node. `scratch` is memory for placements. About
// 20 µs for a block.
ecs::Entity create_node(const SceneSettings& settings, const WorldFacts& facts,
                        const Daylight& daylight, const visibility::NodeCoord& at,
                        std::vector<world::Placement>& scratch, const NodeWork& work);

// The values that stay when a world replaces another one with the same ground and types.
struct KeptModels {
  enum class Stays : std::uint8_t { kNothing, kPlaces, kAll };
  std::vector<Stays> stays;               // of each scatter: how its instances stay
  std::vector<std::uint32_t> scatter_of;  // of each instance index on a block
  std::vector<bool> refit;                // of each type: bounds or impostors of its models differ
  std::vector<bool> wanted() const;       // of each scatter: its instances are placed again
};

// The difference of a node: of its edits, or of the whole world.
struct NodeChange {
  bool ground = true;   // heights or light may differ
  bool models = true;   // edits of its blocks, or heights under its models, differ
  bool world = false;   // anything may differ, bounds and levels included
  bool placed = false;  // `scratch` holds the instances of the block, which has no edits
  const KeptModels* kept = nullptr;  // instances that stay are not in `scratch`; null: none stay
};

// Updates a node and its models to the world's present edits. Old meshes are drawn until the new
// ones are ready. Destroys models that are gone and creates new ones. Takes about 2 µs, or 20 µs
// for a block whose ground or models changed.
void update_node(const WorldFacts& facts, const Daylight& daylight, ecs::Entity node,
                 const NodeChange& change, std::vector<world::Placement>& scratch,
                 const NodeWork& work);

// All nodes.
std::vector<ecs::Entity> nodes_of(const ecs::World& entities);

// Destroys nodes with their models. Their meshes stay in the cache while it has room, because the
// camera may come back.
void destroy_nodes(std::span<const ecs::Entity> nodes, const NodeWork& work);

}  // namespace psygen::scene
