// What the modelers note of meshes while they have them in their caches, so that the main thread
// never reads geometry: of a node's ground what it hides and shades (GroundNote), and the parts of
// the mesh of everything on a node (MeshParts). Of single models nothing. Notes are pure functions
// of a mesh and stay in its record (synthesis::MeshRecord::note) as long as it is resident.
#pragma once

#include <vector>

#include "engine/scene/state.hpp"

namespace psygen::scene {

// What is noted of the ground of a node.
struct GroundNote {
  GroundRelief relief;
  GroundSun sun;
  float edits_error_m = 0;  // how much further the ground may lie off the mesh because of edits
};

// How far the ground of a node may lie off its mesh of this level of the terrain type, in metres.
float possible_error_m(const WorldFacts& facts, int node_level, int mesh_level);

// For synthesis::SynthesisOptions. `facts` are complete, do not change from here on, and outlive
// the modelers.
std::vector<synthesis::Annotate> mesh_notes(const WorldFacts& facts);

}  // namespace psygen::scene
