// Annotations that modelers make while meshes are in their processor caches, so that the main
// thread never reads geometry: occluder lines and sunlight of a node's ground (GroundAnnotation),
// and the parts of a merged mesh (MeshParts). Individual models have none. Annotations are pure
// functions of a mesh and stay in its record (synthesis::MeshRecord::note) while it is resident.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/vertex_layout.hpp"
#include "engine/scene/components.hpp"
#include "engine/scene/nodes/ground_occluder.hpp"
#include "engine/scene/nodes/ground_sunlight.hpp"
#include "engine/synthesis/synthesis_manager.hpp"

namespace psygen::scene {

struct WorldFacts;

// The annotation of a node's ground.
struct GroundAnnotation {
  GroundOccluder occluder;
  GroundSunlight sun;
  float edits_error_m = 0;  // additional error of the mesh because of edits
};

// Maximum distance in metres of the ground of a node from its mesh of this level of the terrain
// type.
float possible_error_m(const WorldFacts& facts, int node_level, int mesh_level);

// For synthesis::SynthesisOptions. `facts` must be complete and constant, and outlive the modelers.
std::vector<synthesis::Annotate> mesh_annotations(const WorldFacts& facts);

// The parts of a merged mesh whose positions span `box`: many of its triangles may be out of view.
// They come block by block in Morton order (world/far/merged_models.hpp), so that neighbours in the
// list are neighbours in space. Reads each index once, 4 to 6 µs for a node (psygen_bench_landing).
// Leaves out triangles at the end that name a vertex twice.
MeshParts mesh_parts(std::span<const core::ModelVertex> vertices,
                     std::span<const std::uint16_t> indices, const core::Bounds& box);

}  // namespace psygen::scene
