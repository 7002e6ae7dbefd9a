// The nodes of the cut that are drawn while meshes are missing, and the difference between drawn
// and wanted detail. Knows no mesh and no renderer. Main thread; linear in the cut.
#pragma once

#include "engine/scene/draws/draw_lists.hpp"
#include "engine/scene/events.hpp"

namespace psygen::scene {

// Fills DrawLists::ready: the ready nodes of the visibility system, whose ground occludes others,
// without those evicted since. Nodes that have become complete since count only if no node above
// them is drawn. draws.entities are the entities of the cut's nodes.
void find_ready(const View& view, const RenderQuery& entities, DrawLists& draws);

// Fills DrawLists::shown and shown_nodes with the nodes of DrawLists::nodes in view. Includes
// leaves without a node drawn in their place, as holes or as far as they are ready.
void list_shown(const View& view, DrawLists& draws);

// The number of levels by which node `index` of the cut is coarser than the finest node in view
// that it is drawn for.
std::uint32_t coarser_by(const View& view, std::uint32_t index);

// Half of the distance up to which a node should have a finer mesh than the drawn one: nearer than
// that, it has more than twice its allowed error. 0 for nodes drawn as wanted. `split_m`:
// visibility::LevelDistances of the node's level.
float min_distance_m(const visibility::CutNode& node, std::uint8_t drawn_level, double split_m);

// The distance from the camera to the visible part of node `index` of the cut, whose ground is at
// most `highest_m` above the camera. +inf if no part is in view.
float nearest_m(const View& view, std::uint32_t index, float highest_m);

// The nodes drawn in the last frame, sorted. Empty if no system reads the events.
struct ShownNodes {
  std::vector<NodeShown> nodes;
};

// System: emits the nodes that appeared in the frame and those that left it.
void events_system(const View& view, const DrawLists& draws, ShownNodes& shown,
                   ecs::EventQueue<NodeShown>& nodes_shown,
                   ecs::EventQueue<NodeHidden>& nodes_hidden);

}  // namespace psygen::scene
