// Which level of detail a mesh entity should show, which one to ask for, and how important both
// are. Decides and changes nothing: the cache system carries it out. Pure functions of values; any
// thread; linear in the levels.
#pragma once

#include <cstdint>

#include "engine/scene/components.hpp"
#include "engine/scene/state.hpp"
#include "engine/synthesis/rank.hpp"

namespace psygen::scene {

// What all choices of one tick have in common.
struct ChoiceRules {
  float pixels_per_radian = 1;
  float min_size_pixels = 0;     // models smaller than this are not drawn
  float error_pixels = 1;        // that nodes may have
  float model_error_pixels = 1;  // that single models may have
  float near_leaves_m = 0;       // trees nearer than this may have up to kNearLeaves times as much
  double real_s = 0;             // the real clock, as in Demand::seen_s
  std::size_t node_levels = 1;   // of the quadtree
  bool levels_of_detail = true;  // false: always the finest
  bool settle = false;           // Rules::settle
  bool ask_early = false;        // for models before they are lacked; not where frames wait for all
  bool coarse_first = true;      // Rules::coarse_first
  bool short_of_memory = false;  // the picture is coarser for want of memory
  bool awaits_memory = false;    // requests wait for memory that is about to be free
  bool draft = false;            // Quality::draft
};

// What decides about the meshes of a picture, wherever its camera stands.
ChoiceRules choice_of_picture(const Settings& settings, const Camera& camera,
                              const Quality& quality, const WorldFacts& facts);

// In a draft, meshes may be so many levels coarser than wanted.
inline constexpr int kDraftLevels = 2;

// Near the camera one sees textures with gaps between leaves, not the polygons that carry them.
inline constexpr float kNearLeaves = 2;

// Models that are larger on screen have no picture: its texels would be seen.
inline constexpr float kMaxPicturePixels = 160;

// A node in this tick, as far as it matters to the meshes on it.
struct NodeView {
  glm::vec3 corner{0.0F};  // relative to the camera
  Visibility visibility{};
  std::uint8_t level = 0;
  bool wanted = false;  // in view, or needed to draw what is
  bool in_view = false;
  bool covered = false;  // an ancestor can be drawn instead
  bool leaf = false;
  bool fine = false;
  float error_factor = 1;  // on the allowed error of the picture
  bool around = false;     // revisited every few ticks only
  bool kept = false;       // keeps what it has, and asks only for what replaces stale meshes
};

// The level that the ground of a node should show.
std::uint8_t ground_level(const NodeView& node, const Detail& detail, std::uint8_t drawn_level);

// The level that a model of this size on screen should show at this distance from the camera;
// kNoLevel if it is too small to be drawn. Its drawn level is kept within the hysteresis of
// visibility::choose_level(), and so is that of pictures by size.
std::uint8_t model_level(const ChoiceRules& rules, const NodeView& node, const Detail& detail,
                         float size_pixels, float distance_m, std::uint8_t drawn_level);

// The level to keep ready while out of view, in place of `level`, which would be shown in view. A
// finer mesh that is there is kept. A model that no predicted camera sees (not `expected`) gets one
// level coarser: it is far cheaper, and little is lost where the camera turns unexpectedly.
std::uint8_t level_out_of_view(const Detail& detail, std::uint8_t level, bool expected,
                               std::uint8_t drawn_level);

// What to do about the mesh of an entity whose wanted level is known.
struct MeshChoice {
  // Of the mesh that is drawn; meaningless if there is none.
  synthesis::RankGroup drawn = synthesis::RankGroup::kUnwanted;
  bool there = false;               // what is drawn is what is wanted
  std::uint8_t request = kNoLevel;  // the level to ask for; kNoLevel: none is better
  synthesis::RankGroup requested = synthesis::RankGroup::kPrefetch;  // of the request
  bool at_once = false;  // the request fills so much of the picture that nothing goes before it
};
// `in_view`: of the mesh itself. `cached`: the mesh of the wanted level is ready in the cache; only
// read for holes. Ground never gives way for being too fine: that would open the picture.
MeshChoice choose_mesh(const ChoiceRules& rules, const NodeView& node, const Detail& detail,
                       const Demand& demand, bool in_view, bool is_ground, bool cached = false);

// True if the picture lacks something here: the mesh is in view, and neither it nor the mesh of an
// ancestor of its node can be drawn.
bool is_hole(const NodeView& node, const Demand& demand, bool in_view);

// The rank of a mesh on a node, at this distance from the camera.
synthesis::Rank rank_on(const NodeView& node, synthesis::RankGroup group, float distance_m);

}  // namespace psygen::scene
