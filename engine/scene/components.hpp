// The components of the scene. Plain data, split by who touches it; sizes are part of the contract.
// A *node* is a piece of ground: a block, or 2^k × 2^k of them (engine/visibility/quadtree.hpp). A
// *mesh entity* is anything with a mesh: a node (its terrain), a tree, a rock, or everything on a
// node as one mesh. Whether a mesh is there yet is a value in `Mesh`, never a difference in
// archetype. Main thread only.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "ecs/ecs.hpp"
#include "engine/core/coordinates.hpp"
#include "engine/core/geometry_memory.hpp"
#include "engine/core/surface_kind.hpp"
#include "engine/models/registry.hpp"
#include "engine/synthesis/geometry_cache.hpp"
#include "engine/visibility/quadtree.hpp"
#include "engine/world/placement.hpp"

namespace psygen::scene {

inline constexpr std::uint8_t kNoLevel = 0xFF;
inline constexpr std::size_t kMaxLevels = 8;
inline constexpr std::uint8_t kNotRanked = 0xFF;

// A node of the quadtree. The models on it are its children (ecs::Children): a block's trees and
// rocks, or the one mesh that stands for all of them.
struct Node {
  visibility::NodeCoord at;
  float low_m = 0, high_m = 0;  // of its ground; all that is possible until a mesh is there
  float solidity = 0;           // share of the light that it stops; 0 where PLP does not ask
};
static_assert(sizeof(Node) == 24);

// What the visibility system found out about a node in this tick.
struct Visibility {
  float distance_m = 0;     // from the camera to the nearest point of the node's box
  float deadline_s = 0;     // seconds until it is expected in view; 0 in view; +inf not expected
  std::uint16_t layer = 0;  // PLP key in layers; the paper's priority is −(layer + 1)
  std::uint16_t in_view = 0;
};
static_assert(sizeof(Visibility) == 12);

// Meshes that a node and its models lack of what is wanted of them, at any level of detail; when
// there are none it can be drawn instead of its parent.
struct Lacking {
  std::uint32_t meshes = UINT32_MAX;  // not yet looked at
};

// Where a mesh entity stands: block, metres from the block's corner, box relative to its foot.
struct Placed {
  core::BlockCoord block;
  glm::vec3 position{0.0F};
  glm::vec3 box_centre{0.0F};
  glm::vec3 box_half_extent{0.0F};
  // The sphere around nearly everything of its mesh, from its foot: how near it is, how large.
  glm::vec3 middle{0.0F};
  float radius_m = 0;
  core::SurfaceKind surface = core::SurfaceKind::kPlain;
};
static_assert(sizeof(Placed) == 64);

// Geometric error in metres of each level of detail.
struct Detail {
  std::array<float, kMaxLevels> error_m{};
  std::uint16_t level_count = 0;
  std::uint16_t picture_level = kNoLevel;  // the last one where that is a picture, else kNoLevel
  float seen_size_m = 0;                   // ModelType::seen_size_m
  bool leaves = false;                     // a tree: textures of leaves hide how coarse it is
};

// What is synthesised. Cold: read when a request is made.
struct Source {
  models::Parameters parameters;
  std::uint64_t parameters_hash = 0;
  std::uint32_t index = 0;  // within the node; world::Placement::index, or one of those below
  models::ModelIndex model = 0;
  std::uint16_t first_level = 0;         // of the model type: what level 0 of Detail and Demand is
  models::ModelIndex picture_model = 0;  // type of quads with pictures of such models; 0: none
  std::uint32_t picture_set = 0;         // which pictures these are: quads name them by number
};
using world::kTerrainIndex;
inline constexpr std::uint32_t kMergedIndex = kTerrainIndex - 1;

// The mesh that is resident and drawn. Results of synthesis land here in batches.
struct Mesh {
  core::GeometryRange range;
  synthesis::MeshHandle handle;
  std::uint32_t shared_indices = 0;  // the renderer's name of the index list, if it is shared
  core::Bounds tight;                // of its vertices, from the foot; known from then on
};
static_assert(sizeof(Mesh) == 68);

// The Mesh of everything that stands on a node in runs of triangles, each with the box around them.
struct MeshParts {
  static constexpr std::size_t kMax = 16;
  std::uint32_t count = 0;
  std::uint32_t indices_each = 0;          // of all parts but the last; 0: none landed yet
  std::uint32_t index_count = 0;           // of all parts
  std::array<core::Bounds, kMax> boxes{};  // from the foot
};
static_assert(sizeof(MeshParts) == 396);

// Those of the mesh that Mesh takes the place of (Fading::old_mesh).
struct OldParts {
  MeshParts parts;
};

// How a model comes and goes (draws/fading.hpp).
struct Fading {
  float share = 0;                  // of its pixels that are there
  std::uint32_t tick = UINT32_MAX;  // the last one in which it was drawn
  // What Mesh takes the place of, drawn in the other pixels until `share` is 1. Null: nothing.
  synthesis::MeshHandle old_mesh;
  core::GeometryRange old_range;
  std::uint32_t old_shared_indices = 0;
  std::uint8_t old_level = kNoLevel;
  bool old_pictured = false;  // Demand::pictured of it
};
static_assert(sizeof(Fading) == 56);

// What is wanted for an entity and what has been done about it. Changes every tick.
struct Demand {
  float seen_s = -1;  // since when it is in view without a mesh; −1: it is not
  std::uint32_t in_view_tick = UINT32_MAX;  // the last tick in which it was in view
  std::uint32_t entered_tick = UINT32_MAX;  // since when it was in every tick up to that one
  std::uint8_t drawn_level = kNoLevel;      // level of Mesh; kNoLevel: there is none
  std::uint8_t wanted_level = kNoLevel;     // kNoLevel: too small on screen to be drawn
  std::uint8_t requested_level = kNoLevel;
  std::uint8_t failed_levels =
      0;                  // bit l: level l cannot be synthesised and is not asked for again
  bool pictured = false;  // Mesh is the quad of a picture
  bool stale = false;  // Mesh is of other parameters than Source: drawn until the new one is there
  std::uint8_t ranked = kNotRanked;  // group of the rank that the cache has for Mesh
  bool added = false;  // by an edit, to a node that may be drawn already: it does not wait for it
};
static_assert(sizeof(Demand) == 20);

// An entity as the cache's name for an owner, and back.
inline std::uint64_t owner_of(ecs::Entity entity) {
  return (std::uint64_t{entity.generation} << 32) | entity.index;
}
inline ecs::Entity entity_of(std::uint64_t owner) {
  return {static_cast<std::uint32_t>(owner), static_cast<std::uint32_t>(owner >> 32)};
}

}  // namespace psygen::scene

template <>
struct psygen::ecs::ComponentTraits<psygen::scene::Mesh> {
  static constexpr std::string_view name = "Mesh";
  static constexpr bool tracked = true;
};
