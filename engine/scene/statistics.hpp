// Counts and measurements of the last tick. Values.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/models/registry.hpp"

namespace psygen::scene {

// Nodes that became entities, and nodes whose entities were destroyed.
struct NodeCounts {
  std::uint32_t created = 0, destroyed = 0;
};

// Detail of the frame (count_visible).
struct DrawCounts {
  std::uint32_t nodes_in_view = 0;
  std::uint32_t holes = 0;   // nodes in view that are drawn at no level
  std::uint32_t coarse = 0;  // nodes in view coarser than wanted by more than one level
  // Holes, coarse nodes, and nodes with more than twice their allowed error whose better meshes can
  // still be synthesised.
  std::uint32_t awaited = 0;
  double missing_pixels_percent = 0;
  double seen_area = 0, too_coarse_area = 0;  // of visible pieces, in percent of the frame
};

// Objects of the game: in view and drawn; in view without a drawable mesh; with an invalid
// Transform.
struct ObjectCounts {
  std::uint32_t drawn = 0, missing = 0, invalid = 0;
};

// Point lights: those that light the frame; in view but beyond the maximum; with invalid values.
struct LightCounts {
  std::uint32_t lit = 0, left_out = 0, invalid = 0;
};

// The same of particle emitters, and of their particles.
struct ParticleCounts {
  std::uint32_t emitters_drawn = 0, emitters_left_out = 0, emitters_invalid = 0;
  std::uint64_t particles_drawn = 0, particles_left_out = 0;
};

// Predicted and measured time of one synthesised mesh.
struct MeshCost {
  double predicted_s, actual_s;
  models::ModelIndex model;
};

// Meshes that were requested, synthesised or shown.
struct MeshCounts {
  std::uint32_t requests = 0;         // wanted meshes that are not ready
  std::uint32_t refused = 0;          // of these, requests that found no memory
  std::uint32_t refused_visible = 0;  // of these, requests for meshes in view
  std::uint32_t completed = 0, failed = 0;
  std::uint32_t models_synthesised = 0;
  std::uint64_t triangles_synthesised = 0, bytes_synthesised = 0;
  double synthesis_seconds = 0;
  std::vector<float> time_to_visible_ms;  // of mesh entities that came into view and are drawn
  std::vector<MeshCost> costs;
};

// Refers to the counts of a scene, which hold until its next tick.
struct Statistics {
  const NodeCounts& nodes;
  const DrawCounts& drawn;
  const ObjectCounts& objects;
  const LightCounts& lights;
  const ParticleCounts& particles;
  const MeshCounts& meshes;
  std::uint32_t nodes_hidden = 0;   // nodes of the cut behind ridges
  std::uint32_t models_drawn = 0;   // draws of models and merged meshes
  std::uint64_t failed_in_all = 0;  // since the scene was created
  bool impostors_missing = false;   // the renderer lacks impostors that are still being baked
};

}  // namespace psygen::scene
