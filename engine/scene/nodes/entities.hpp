// The entities of a node: its ground, and the models on it or the one mesh of all of them. Creates
// them, and changes them when the edits of the world change. Decides nothing about which nodes
// exist (systems/streaming.cpp). Main thread only.
#pragma once

#include <span>
#include <vector>

#include "ecs/ecs.hpp"
#include "engine/scene/events.hpp"
#include "engine/scene/state.hpp"
#include "engine/world/placement.hpp"

namespace psygen::scene {

// Creates a node and its models, and returns the node. `scratch` is memory for placements. About
// 20 µs for a block.
ecs::Entity create_node(const Settings& settings, const WorldFacts& facts, const Daylight& daylight,
                        const visibility::NodeCoord& at, std::vector<world::Placement>& scratch,
                        ecs::World& entities, ecs::EventQueue<ModelCreated>& created);

// Where models that come and go are told.
struct ModelEvents {
  ecs::EventQueue<ModelCreated>& created;
  ecs::EventQueue<ModelRemoved>& removed;
};

// What a world that takes the place of another one leaves as it was. Both have the same ground and
// the same types.
struct KeptModels {
  enum class Stays : std::uint8_t { kNothing, kPlaces, kAll };
  std::vector<Stays> stays;               // of each scatter, of its instances
  std::vector<std::uint32_t> scatter_of;  // of each index of an instance on a block
  std::vector<bool> refit;                // of each type: boxes or pictures of its models differ
  std::vector<bool> wanted() const;       // of each scatter: its instances are placed anew
};

// What changed of a node: of its edits, or all of the world.
struct NodeChange {
  bool ground = true;                // heights or light may differ
  bool models = true;                // the edits of its blocks differ, or heights under its models
  bool world = false;                // anything may differ, also boxes and levels
  bool placed = false;               // `scratch` has what stands on the block, which has no edits
  const KeptModels* kept = nullptr;  // what stays is not in `scratch`; null: nothing stays
};

// Gives a node and its models what they are in the world's present edits. What is drawn of them
// stays until the new mesh is there; models that are not there any more are destroyed, and new ones
// created. About 2 µs, and 20 µs for a block whose ground or models changed.
void update_node(const WorldFacts& facts, const Daylight& daylight, ecs::Entity node,
                 const NodeChange& change, std::vector<world::Placement>& scratch,
                 synthesis::MeshSupply& meshes, ecs::World& entities, const ModelEvents& events);

// Destroys nodes with their models. Their meshes stay in the cache while there is room: the camera
// may come back.
void destroy_nodes(std::span<const ecs::Entity> nodes, synthesis::MeshSupply& meshes,
                   ecs::World& entities, ecs::EventQueue<ModelRemoved>& removed);

}  // namespace psygen::scene
