// What happens to nodes, models and meshes, as events that systems of a game drain
// (ecs/event_queue.hpp): a system takes ecs::EventReader<ModelCreated>& and sees each event once.
// Queues without readers cost nothing. Entities may be dead by the time that an event is read.
// Plain values.
#pragma once

#include "ecs/ecs.hpp"
#include "engine/core/coordinates.hpp"
#include "engine/models/registry.hpp"
#include "engine/scene/readiness.hpp"
#include "engine/synthesis/mesh_key.hpp"
#include "engine/visibility/quadtree.hpp"

namespace psygen::scene {

// A node is drawn in this frame and was not in the one before, or the other way round. A node is a
// block (level 0) or a square of 2^level × 2^level blocks.
struct NodeShown {
  ecs::Entity node;
  visibility::NodeCoord at;
};
struct NodeHidden {
  ecs::Entity node;
  visibility::NodeCoord at;
};

// The entity of a model on a block, near enough to be drawn alone, was created; or is destroyed in
// this tick, because the camera went away or an edit removed it.
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

// A mesh was made and can be drawn from this frame on; or gave way to others. `entity` is the one
// it was made for.
struct MeshLanded {
  ecs::Entity entity;
  synthesis::MeshKey key;
};
struct MeshEvicted {
  ecs::Entity entity;
  synthesis::MeshKey key;
};

// The queues that the engine fills.
struct Events {
  ecs::EventQueue<NodeShown> shown;
  ecs::EventQueue<NodeHidden> hidden;
  ecs::EventQueue<ModelCreated> created;
  ecs::EventQueue<ModelRemoved> removed;
  ecs::EventQueue<MeshLanded> landed;
  ecs::EventQueue<MeshEvicted> evicted;
  ecs::EventQueue<PlaceReady> places_ready;
};

}  // namespace psygen::scene
