// The components of the scene. Plain data, split by the systems that touch it; sizes are part of
// the contract. A node is a quadtree square of 2^k × 2^k blocks (engine/visibility/quadtree.hpp). A
// mesh entity is anything with a mesh: a node (its ground), a tree, a rock, or all models of a node
// merged. The component `Mesh` tells whether a mesh is ready; the archetype never does. Main thread
// only.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "ecs/ecs.hpp"
#include "engine/core/coordinates.hpp"
#include "engine/core/geometry_memory.hpp"
#include "engine/core/vertex_layout.hpp"
#include "engine/models/registry.hpp"
#include "engine/synthesis/geometry_cache.hpp"
#include "engine/visibility/quadtree.hpp"
#include "engine/world/placement.hpp"

namespace psygen::scene {

inline constexpr std::uint8_t kNoLevel = 0xFF;
inline constexpr std::size_t kMaxLevels = 8;
inline constexpr std::uint8_t kNotRanked = 0xFF;

// A node of the quadtree. Its models are its children (ecs::Children): a block's trees and rocks,
// or one merged mesh; and the surface of its rivers and lakes.
struct QuadtreeNode {
  visibility::NodeCoord at;
  float low_m = 0,
        high_m = 0;    // height range of its ground; the possible range before it has a mesh
  float solidity = 0;  // fraction of light that it stops; 0 if PLP does not need it
};
static_assert(sizeof(QuadtreeNode) == 24);

// The visibility of a node in this tick.
struct Visibility {
  float distance_m = 0;     // from the camera to the nearest point of the node's box
  float deadline_s = 0;     // seconds until it is expected in view; 0: in view; +inf: not expected
  std::uint16_t layer = 0;  // PLP key in layers; the paper's priority is −(layer + 1)
  std::uint16_t in_view = 0;
};
static_assert(sizeof(Visibility) == 12);

// The number of wanted meshes, at any LOD, that a node and its models lack. With none missing it
// can be drawn in place of its parent.
struct MissingMeshes {
  std::uint32_t meshes = UINT32_MAX;  // UINT32_MAX: not yet counted
};

// The place of a mesh entity: block, metres from the block's corner, and bounds relative to its
// base point.
struct MeshPlacement {
  core::BlockCoord block;
  glm::vec3 position{0.0F};
  glm::vec3 box_centre{0.0F};
  glm::vec3 box_half_extent{0.0F};
  // A sphere around nearly all of its mesh, relative to the base point. Decides distance and size.
  glm::vec3 middle{0.0F};
  float radius_m = 0;
  core::SurfaceKind surface = core::SurfaceKind::kPlain;
};
static_assert(sizeof(MeshPlacement) == 64);

// Geometric error of each LOD in metres.
struct LodErrors {
  std::array<float, kMaxLevels> error_m{};
  std::uint16_t level_count = 0;
  std::uint16_t picture_level = kNoLevel;  // the last level if it is an impostor, else kNoLevel
  float seen_size_m = 0;                   // ModelType::seen_size_m(); 0: the size of its mesh
  bool leaves = false;                     // a tree: leaf textures hide coarse meshes
};

// The input of synthesis. Cold: read when a request is made.
struct MeshSource {
  models::Parameters parameters;
  std::uint64_t parameters_hash = 0;
  std::uint32_t index = 0;  // in the node: world::Placement::index, or one of those below
  models::ModelIndex model = 0;
  std::uint16_t first_level =
      0;  // level of the model type that is level 0 of LodErrors and MeshDemand
  models::ModelIndex picture_model = 0;  // type of the impostor quads of such models; 0: none
  std::uint32_t picture_set = 0;         // identity of these impostors: quads name them by number
};
using world::kTerrainIndex;
inline constexpr std::uint32_t kMergedIndex = kTerrainIndex - 1;
inline constexpr std::uint32_t kWaterIndex = kMergedIndex - 1;  // rivers and lakes of a node

// The mesh that is resident and drawn. Results of synthesis are written here in batches.
struct Mesh {
  core::GeometryRange range;
  synthesis::MeshHandle handle;
  std::uint32_t shared_indices = 0;  // the renderer's name of the index list, if it is shared
  core::Bounds tight;  // of its vertices, relative to the base point; kept after an eviction
};
static_assert(sizeof(Mesh) == 68);

// The parts of a merged mesh: runs of triangles, each with its bounds.
struct MeshParts {
  static constexpr std::size_t kMax = 16;
  std::uint32_t count = 0;
  std::uint32_t indices_each = 0;          // of all parts except the last; 0: no mesh yet
  std::uint32_t index_count = 0;           // of all parts
  std::array<core::Bounds, kMax> boxes{};  // relative to the base point
};
static_assert(sizeof(MeshParts) == 396);

// The parts of the mesh that Mesh replaces (Fading::old_mesh).
struct ReplacedParts {
  MeshParts parts;
};

// The fade of a model (meshes/fading.hpp).
struct Fading {
  float share = 0;                  // fraction of its pixels that are drawn
  std::uint32_t tick = UINT32_MAX;  // the last one in which it was drawn
  // The mesh that Mesh replaces, drawn in the other pixels until `share` is 1. Null: none.
  synthesis::MeshHandle old_mesh;
  core::GeometryRange old_range;
  std::uint32_t old_shared_indices = 0;
  std::uint8_t old_level = kNoLevel;
  bool old_pictured = false;  // old_mesh is an impostor quad
};
static_assert(sizeof(Fading) == 56);

// The wanted mesh of an entity, and the state of its request. Changes every tick.
struct MeshDemand {
  float seen_s = -1;  // since when it is in view without a mesh; −1: it is not
  std::uint32_t in_view_tick = UINT32_MAX;  // the last tick in which it was in view
  std::uint32_t entered_tick = UINT32_MAX;  // the first tick of its present stay in view
  std::uint8_t drawn_level = kNoLevel;      // level of Mesh; kNoLevel: none
  std::uint8_t wanted_level = kNoLevel;     // kNoLevel: too small on screen to be drawn
  std::uint8_t requested_level = kNoLevel;
  std::uint8_t failed_levels = 0;  // bit l: the synthesis of level l failed; no request repeats it
  bool pictured = false;           // Mesh is an impostor quad
  bool stale =
      false;  // Mesh has other parameters than MeshSource; drawn until the new mesh is ready
  bool stale_light = false;          // it is stale, and an edit beyond it changed only its light
  std::uint8_t ranked = kNotRanked;  // group of the rank that the cache has for Mesh
  bool added =
      false;  // an edit added it to a node that may be drawn already: the node does not wait for it
};
static_assert(sizeof(MeshDemand) == 24);

// Converts an entity to the cache's name for an owner, and back.
inline std::uint64_t owner_of(ecs::Entity entity) {
  return (std::uint64_t{entity.generation} << 32) | entity.index;
}
inline ecs::Entity entity_of(std::uint64_t owner) {
  return {static_cast<std::uint32_t>(owner), static_cast<std::uint32_t>(owner >> 32)};
}

}  // namespace psygen::scene

// Saved as "Mesh", with change bits.
template <>
struct psygen::ecs::ComponentTraits<psygen::scene::Mesh> {
  static constexpr std::string_view name = "Mesh";
  static constexpr bool tracked = true;
};
