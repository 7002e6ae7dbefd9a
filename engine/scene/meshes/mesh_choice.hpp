// Decides which LOD a mesh entity should show, which one to request, and the ranks of both. Changes
// nothing: the cache system carries out the decisions. Pure functions of values; any thread; linear
// in the levels.
#pragma once

#include <cstdint>

#include "engine/scene/components.hpp"
#include "engine/scene/nodes/streaming.hpp"
#include "engine/synthesis/rank.hpp"

namespace psygen::scene {

// The rules that all choices of one tick share.
struct ChoiceRules {
  float pixels_per_radian = 1;
  float min_size_pixels = 0;     // smaller models are not drawn
  float error_pixels = 1;        // allowed error of nodes
  float model_error_pixels = 1;  // allowed error of individual models
  float near_leaves_m = 0;       // nearer trees may have up to kNearLeaves times that error
  double real_s = 0;             // the real clock, as in MeshDemand::seen_s
  std::size_t node_levels = 1;   // of the quadtree
  bool levels_of_detail = true;  // false: always the finest level
  bool settle = false;           // Rules::settle
  bool ask_early = false;    // requests models before they are missing; not if frames wait for all
  bool coarse_first = true;  // Rules::coarse_first
  bool short_of_memory = false;  // a lack of memory makes the frame coarser
  bool awaits_memory = false;    // requests wait for memory that is about to be free
  bool draft = false;            // Quality::draft
};

// The rules for frames of this size and quality, wherever their camera is.
ChoiceRules choice_of_picture(const StreamingContext& context);

// In a draft, meshes may be coarser than wanted by this many levels.
inline constexpr int kDraftLevels = 2;

// Near the camera, textures with gaps between leaves hide the polygons under them. So these trees
// may have this multiple of the allowed error.
inline constexpr float kNearLeaves = 2;

// Maximum size in pixels of an impostor. Larger ones would show their texels.
inline constexpr float kMaxPicturePixels = 160;

// The properties of a node that decide about its meshes.
struct NodeView {
  glm::vec3 corner{0.0F};  // relative to the camera
  Visibility visibility{};
  std::uint8_t level = 0;
  bool wanted = false;  // in view, or needed by a node in view
  bool in_view = false;
  bool covered = false;  // an ancestor can be drawn instead
  bool leaf = false;
  bool fine = false;
  float error_factor = 1;  // factor on the allowed error
  bool around = false;     // visited every few ticks only
  bool kept = false;       // requests only replacements of stale meshes
};

// Returns the level that the ground of a node should show.
std::uint8_t ground_level(const NodeView& node, const LodErrors& detail, std::uint8_t drawn_level);

// Returns the LOD that a model of this size should show at this distance from the camera; kNoLevel
// if it is too small to be drawn. The drawn level stays within the hysteresis of
// visibility::choose_level(), and impostors within one of size.
std::uint8_t model_level(const ChoiceRules& rules, const NodeView& node, const LodErrors& detail,
                         float size_pixels, float distance_m, std::uint8_t drawn_level);

// Returns the LOD to keep ready out of view, for a model that would show `level` in view. A finer
// mesh stays. A model that no predicted camera sees (not `expected`) gets one level coarser: that
// is far cheaper, and costs little if the camera turns unexpectedly.
std::uint8_t level_out_of_view(const LodErrors& detail, std::uint8_t level, bool expected,
                               std::uint8_t drawn_level);

// The decision about the mesh of an entity whose wanted level is known.
struct MeshChoice {
  // The rank group of the drawn mesh; meaningless if there is none.
  synthesis::RankGroup drawn = synthesis::RankGroup::kUnwanted;
  bool there = false;               // the drawn mesh is the wanted one
  std::uint8_t request = kNoLevel;  // the level to request; kNoLevel: none is better
  synthesis::RankGroup requested = synthesis::RankGroup::kPrefetch;  // of the request
  bool at_once = false;  // the request fills so much of the frame that it goes first
};
// The circumstances of a mesh.
struct MeshUse {
  bool in_view = true;
  bool is_ground = false;  // ground is never evicted for being too fine: that would open a hole
  bool cached = false;     // the wanted level is ready in the cache; only read for holes
};
MeshChoice choose_mesh(const ChoiceRules& rules, const NodeView& node, const LodErrors& detail,
                       const MeshDemand& demand, const MeshUse& use);

// True for a mesh in view that cannot be drawn, and whose node no ancestor can replace.
bool is_hole(const NodeView& node, const MeshDemand& demand, bool in_view);

// Returns the rank of a mesh on a node, at this distance from the camera.
synthesis::Rank rank_on(const NodeView& node, synthesis::RankGroup group, float distance_m);

}  // namespace psygen::scene
