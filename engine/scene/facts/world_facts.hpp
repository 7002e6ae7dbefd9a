// The world of a scene, its model types, and values derived from both once (facts/derive.hpp).
// Values; main thread only.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "engine/models/registry.hpp"
#include "engine/models/terrain/tiles.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/facts/levels.hpp"
#include "engine/scene/facts/solidity.hpp"
#include "engine/scene/settings.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/world.hpp"
#include "engine/world/world_parts.hpp"

namespace psygen::world {
class FarScatters;
class ImpostorSet;
}  // namespace psygen::world

namespace psygen::scene {

// Values derived from a world that its successor reuses where both have equal parts. Immutable; any
// thread.
struct DerivedWorldData {
  world::WorldParts parts;
  std::uint64_t types = 0;  // hash of the type names in the registry, in order
  std::shared_ptr<const world::FarScatters> scatters;  // their types may no longer exist
  std::vector<double> placed;                          // world::placed_per_block()
  std::vector<NodeLevel> levels;
  std::shared_ptr<const world::ImpostorSet>
      pictures;  // null: none; their types may no longer exist
};

// Only edits change during ticks, and with them how far models reach (edits_system). All other
// values are derived without edits. Scene::set_world() replaces the whole struct.
struct WorldFacts {
  world::World world;
  models::Registry registry;
  std::size_t given_types = 0;  // types in the registry before the scene added its own
  render::Light light;
  render::TerrainPalette palette;
  render::Canopy canopy;                      // forests too far away to be drawn as models
  float cover_share = 0;                      // fraction of the ground that these forests hide
  std::vector<Standing> standing;             // obstacles on a block
  std::vector<NodeLevel> levels;              // of the quadtree, finest first
  models::ModelIndex merged_model = 0;        // type of merged meshes; 0: none
  models::ModelIndex water_model = 0;         // type of surfaces of rivers and lakes
  models::ModelIndex patch_model = 0;         // type of patches of a river network; 0: no network
  std::vector<models::TerrainGrid> grids;     // one for each level of the terrain type
  std::optional<models::TerrainTiles> tiles;  // of blocks' finest meshes; none without levels
  // Typical bounds of each model type: the part of its conservative bounds that its meshes usually
  // fill, in −1 … 1 along each axis. Conservative bounds cover all parameters and may be far
  // larger.
  std::vector<core::Bounds> typical_bounds;
  // Tree impostors: null if there are none. The type that bakes them, the parameters of each, and
  // for each model type its quad type, or 0 if it has no impostors.
  std::shared_ptr<const world::ImpostorSet> pictures;
  models::ModelIndex picture_model = 0;
  std::vector<models::Parameters> picture_parameters;
  std::vector<models::ModelIndex> quad_models;
  std::shared_ptr<const DerivedWorldData> derived;
  std::uint32_t models_per_block = 0;
  float cell_m = 1;                   // side of a ground cell of the finest mesh
  glm::vec2 models_reach_m{0.0F};     // from a model's base point: sideways, up
  glm::vec2 scattered_reach_m{0.0F};  // the same without models placed by hand
  bool shadows = false;               // models out of view may cast shadows into the frame
  bool near_detail = false;  // near models have textures: gaps between leaves hide polygons
};

// The values of a scene that prepare_world() needs. A copy, for another thread.
struct SceneSnapshot {
  SceneSettings settings;
  world::World world;                               // without edits
  std::vector<core::BlockCoord> blocks;             // whose models exist
  std::vector<visibility::NodeCoord> nodes;         // the coarser ones
  std::shared_ptr<const DerivedWorldData> derived;  // of the world; null: nothing can be reused
};

// A world that is ready to replace a scene's world (Scene::set_world). Any thread.
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
