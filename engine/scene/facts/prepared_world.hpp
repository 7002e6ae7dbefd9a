// Another world for a running scene (Scene::set_world), prepared on any thread. Values.
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/settings.hpp"
#include "engine/world/placement.hpp"

namespace psygen::scene {

// The values of a scene that prepare_world() needs. A copy, for another thread.
struct SceneSnapshot {
  SceneSettings settings;
  world::World world;                               // without edits
  std::vector<core::BlockCoord> blocks;             // whose models exist
  std::shared_ptr<const DerivedWorldData> derived;  // of the world; null: nothing can be reused
};

// A world that is ready to replace a scene's world.
struct PreparedWorld {
  WorldFacts facts;  // the renderer does not have their tree impostors yet
  // True if only sky, water, palette or name differ; then `facts` hold only world and registry.
  bool looks_only = false;
  // The instances on the blocks of the snapshot, without those of scatters that are equal in the
  // replaced world; null: none.
  std::unordered_map<core::BlockCoord, std::vector<world::Placement>, core::BlockCoordHash> models;
  std::shared_ptr<const DerivedWorldData> before;
};

}  // namespace psygen::scene
