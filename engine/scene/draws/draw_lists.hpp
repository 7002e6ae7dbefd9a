// The draw lists of a frame, and the system that fills and renders them. Values; main thread only.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>
#include <span>
#include <vector>

#include "engine/render/types.hpp"
#include "engine/scene/components.hpp"
#include "engine/scene/frame/output.hpp"
#include "engine/scene/frame/quality.hpp"
#include "engine/scene/nodes/ground_occluder.hpp"
#include "engine/scene/nodes/ground_sunlight.hpp"
#include "engine/scene/objects/scene_draws.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/scene/view/visibility.hpp"
#include "engine/visibility/quadtree.hpp"

namespace psygen::scene {

// Tells which nodes replace others, so that their models can cross-fade.
class NodeCrossFade {
 public:
  // `drawn`: the nodes of this tick, in any order. `continues`: this is the tick after the last
  // call's. Otherwise the nodes drawn before are unknown, and no node fades out.
  void update(std::span<const visibility::NodeCoord> drawn, bool continues);

  // Calls draw(node) once for each node that is no longer drawn: those that update() found, and
  // those of earlier ticks that still fade out. `draw` returns true if any of its models is left.
  template <class Draw>
  void for_each_going(const Draw& draw) {
    std::erase_if(going_, [&](const visibility::NodeCoord& node) { return !draw(node); });
    find_replaced();
  }

  // True if a drawn node was not drawn in the last tick.
  bool is_new_node(const visibility::NodeCoord& node) const;
  // True if such a node replaces nodes that still fade out: an ancestor, or nodes below it.
  bool replaces(const visibility::NodeCoord& node) const;

 private:
  void find_replaced();

  // All sorted.
  std::vector<visibility::NodeCoord> drawn_, drawn_before_, fresh_, going_, above_going_, scratch_;
  std::uint8_t top_level_ = 0;  // of drawn and going nodes
};

// The lists of this tick, and working memory.
struct DrawLists {
  std::vector<ecs::Entity> entities;  // per node of the cut; null if there is none
  std::vector<std::uint32_t> nodes;  // of the cut: drawn in place of nodes whose meshes are missing
  std::vector<std::uint8_t> ready, scratch;  // per node of the cut
  std::vector<std::uint32_t> shown;          // of `nodes` and holes, those in view
  std::vector<visibility::NodeCoord> shown_nodes;
  std::vector<render::TerrainDraw> terrain;
  std::vector<render::MeshDraw> models;
  std::vector<render::MeshDraw> water;        // surfaces of rivers and lakes, farthest first
  std::vector<synthesis::MeshHandle> meshes;  // of all three
  std::vector<render::GroundSpot> spots;      // contact shadows of models near the camera
  std::vector<render::Line> lines;            // bounds of drawn nodes, in the debug view of bounds
  NodeCrossFade cross_fade;
  DrawnTick last;
  float fade_phase = 0;  // of the pattern of fades (next_phase)
  DrawCounts counts;
  render::FrameResult frame;
};

// Bundle: everything that render_system() writes besides components.
struct DrawWork {
  synthesis::MeshSupply& supply;
  DrawLists& draws;
  Output& output;
  MemoryPressure& pressure;
};

// System: fills the draw lists, measures missing detail, and renders them if there is a renderer.
using RenderQuery =
    ecs::Query<const QuadtreeNode, const ecs::Children, const Visibility, const MeshPlacement,
               const MeshDemand, const MeshSource, const Mesh, const MeshParts, const ReplacedParts,
               const GroundOccluder, const GroundSunlight, Fading>;
void render_system(RenderContext context, SceneDraws scene, RenderQuery entities, DrawWork work);

// Percentage of the frame that a ball around `centre` (metres from the camera) covers.
inline double covered_percent(const Camera& camera, glm::vec3 centre, float radius_m) {
  const double distance_m = std::max(glm::length(centre), radius_m);
  const double radius_px = camera.pixels_per_radian * radius_m / distance_m;
  const double picture = static_cast<double>(camera.size.width) * camera.size.height;
  return std::min(100.0, 100.0 * std::numbers::pi * radius_px * radius_px / picture);
}

// A node or model that the frame shows, or should show.
struct VisiblePiece {
  glm::vec3 centre{0.0F};  // metres from the camera
  float radius_m = 0;
  bool hole = false;    // drawn at no level
  bool coarse = false;  // drawn by more than one level too coarse
  bool twice = false;   // drawn with more than twice its allowed error
  bool awaits = true;   // a better mesh can still be synthesised
};

// Adds a piece to all counts, the metric missing.pixels (docs/cli.md) included. Pure.
inline void count_visible(const Camera& camera, const VisiblePiece& piece, DrawCounts& counts) {
  const double percent = covered_percent(camera, piece.centre, piece.radius_m);
  const bool lacks = piece.hole || piece.coarse;
  ++counts.nodes_in_view;
  if (piece.hole) ++counts.holes;
  if (piece.coarse) ++counts.coarse;
  if ((lacks || piece.twice) && piece.awaits) ++counts.awaited;
  if (lacks) counts.missing_pixels_percent += percent;
  counts.seen_area += percent;
  if (lacks || piece.twice) counts.too_coarse_area += percent;
}

}  // namespace psygen::scene
