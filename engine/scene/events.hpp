// Events of nodes, models and meshes. A system of a game takes ecs::EventReader<ModelCreated>& and
// sees each event once (ecs/event_queue.hpp). Queues without readers cost nothing. Entities may be
// dead when an event is read. Plain values.
#pragma once

#include "ecs/ecs.hpp"
#include "engine/core/coordinates.hpp"
#include "engine/models/registry.hpp"
#include "engine/scene/places.hpp"
#include "engine/synthesis/mesh_key.hpp"
#include "engine/visibility/quadtree.hpp"

namespace psygen::scene {

// A node is drawn in this frame but was not drawn in the frame before, or the reverse. A node is a
// block (level 0) or a square of 2^level × 2^level blocks.
struct NodeShown {
  ecs::Entity node;
  visibility::NodeCoord at;
};
struct NodeHidden {
  ecs::Entity node;
  visibility::NodeCoord at;
};

// The entity of a model on a block was created, because the model is near enough to be drawn
// individually; or it is destroyed in this tick, because the camera moved away or an edit removed
// it.
struct ModelCreated {
  ecs::Entity entity;
  core::BlockCoord block;
  std::uint32_t index = 0;  // of the instance on the block (world::Placement)
  models::ModelIndex model = 0;
};
struct ModelRemoved {
  ecs::Entity entity;
  core::BlockCoord block;
  std::uint32_t index = 0;
  models::ModelIndex model = 0;
};

// A mesh was synthesised and can be drawn from this frame on; or it was evicted. `entity` is the
// one that requested it.
struct MeshReady {
  ecs::Entity entity;
  synthesis::MeshKey key;
};
struct MeshEvicted {
  ecs::Entity entity;
  synthesis::MeshKey key;
};

// Scene::set_world() replaced the world. Queries, paths, physics, solid objects, prefabs and edits
// follow by themselves; a game finds its numbers of model types (models::ModelIndex) and whatever
// else it derived from the world again.
struct WorldChanged {
  bool ground = false;  // heights or blocks differ
  bool models = false;  // types, places or shapes of models differ; implied by `ground`
  bool looks = false;   // name, sky, water or palette differ
  // Side of the replaced world's blocks in metres. If it differs from the new one, the scene has
  // moved all Transforms to the same places in the new blocks; world::rebased() moves positions of
  // the game's own.
  double block_m_before = 0;
};

// The queues that the engine fills.
struct Events {
  ecs::EventQueue<NodeShown> shown;
  ecs::EventQueue<NodeHidden> hidden;
  ecs::EventQueue<ModelCreated> created;
  ecs::EventQueue<ModelRemoved> removed;
  ecs::EventQueue<MeshReady> ready;
  ecs::EventQueue<MeshEvicted> evicted;
  ecs::EventQueue<PlaceReady> places_ready;
  ecs::EventQueue<WorldChanged> world_changed;
};

}  // namespace psygen::scene
