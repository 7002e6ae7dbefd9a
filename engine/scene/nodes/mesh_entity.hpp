// Properties of a mesh entity before it has a mesh: its place, its LODs, and its names in the
// cache. Pure functions.
#pragma once

#include <climits>
#include <optional>

#include "engine/scene/components.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/world/placement.hpp"

namespace psygen::scene {

// MeshKey::parameters_hash of an entity's meshes; for quads it includes the identity of their
// impostors.
std::uint64_t hash_of(const MeshSource& source, bool picture);

// The cache's name for the mesh of a level.
synthesis::MeshKey key_of(const MeshPlacement& placed, const LodErrors& detail,
                          const MeshSource& source, std::uint8_t level);
// The level that a mesh is for an entity; kNoLevel for an impostor that it no longer has.
std::uint8_t level_of(const LodErrors& detail, const MeshSource& source,
                      const synthesis::MeshKey& key);

// Distance in metres from a point to the typical bounds of an entity, at least `min_m`. `foot` is
// the base point relative to that point.
float distance_to(const MeshPlacement& placed, const glm::vec3& foot, float min_m);

// Maximum size in pixels of an entity at this distance, along any axis.
float size_pixels(const MeshPlacement& placed, const LodErrors& detail, float distance_m,
                  float pixels_per_radian, float min_m);

// The column values of a model, or of the ground of a node: for entities, and for requested places
// without entities (meshes/requested_places.hpp).
struct MeshColumns {
  MeshPlacement placed;
  LodErrors detail;
  MeshSource source;
};
// Uses only these levels of the type, and none beyond an impostor.
MeshColumns columns_of(const WorldFacts& facts, core::BlockCoord block,
                       const world::Placement& placement, int first_level = 0,
                       int last_level = INT_MAX);

// True for a node of level 1 or above that has a merged mesh.
bool has_merged(const WorldFacts& facts, const visibility::NodeCoord& at);
// Its merged mesh.
world::Placement merged_placement(const WorldFacts& facts, const visibility::NodeCoord& at);
// The surface of the rivers and lakes of a node; nothing if it has none.
std::optional<world::Placement> water_placement(const WorldFacts& facts,
                                                const visibility::NodeCoord& at);

}  // namespace psygen::scene
