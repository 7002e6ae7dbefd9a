// Which nodes of the cut are drawn while meshes are missing, and how far what is drawn is from what
// is wanted. Knows no mesh and no renderer. Main thread; linear in the cut.
#pragma once

#include "engine/scene/state.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {

// Fills DrawLists::ready: what the visibility system found, as its ground is what hides others,
// without what was evicted since, and what has become complete since only where nothing above it is
// drawn. draws.entities are those of the nodes of the cut.
void find_ready(const View& view, const RenderQuery& entities, DrawLists& draws);

// Fills DrawLists::shown and shown_nodes from DrawLists::nodes: those in view. A leaf that no node
// stands for is shown too, as a hole or as far as it goes.
void list_shown(const View& view, DrawLists& draws);

// By how many levels the finest node in view that the node `index` of the cut is drawn for is
// finer.
std::uint32_t coarser_by(const View& view, std::uint32_t index);

// Half of the distance up to which a node's mesh is finer than what is drawn of it: nearer, that
// has more than twice the error that it might have. 0 for what is drawn as wanted. `split_m` of the
// node's level (visibility::LevelDistances).
float min_distance_m(const visibility::CutNode& node, std::uint8_t drawn_level, double split_m);

// How near the camera comes to what is in view of the node `index` of the cut, whose ground is at
// most `highest_m` above the camera. +inf if nothing is in view.
float nearest_m(const View& view, std::uint32_t index, float highest_m);

}  // namespace psygen::scene
