// Counts and measurements of the last tick. Values.
#pragma once

#include <cstdint>
#include <span>

#include "engine/models/registry.hpp"

namespace psygen::scene {

// Predicted and measured time of one synthesised mesh.
struct MeshCost {
  double predicted_s, actual_s;
  models::ModelIndex model;
};

// A copy, except for the spans: they are valid until the next tick.
struct Statistics {
  std::uint32_t nodes_created = 0, nodes_destroyed = 0;
  std::uint32_t nodes_in_view = 0;
  std::uint32_t nodes_hidden = 0;  // nodes of the cut behind ridges
  std::uint32_t holes = 0;         // nodes in view that are drawn at no level
  std::uint32_t coarse = 0;        // nodes in view coarser than wanted by more than one level
  // Holes, coarse nodes, and nodes with more than twice their allowed error whose better meshes can
  // still be synthesised.
  std::uint32_t awaited = 0;
  double missing_pixels_percent = 0;
  // Objects of the game: in view and drawn; in view without a drawable mesh; with an invalid
  // Transform.
  std::uint32_t objects_drawn = 0, objects_missing = 0, objects_invalid = 0;
  // Point lights: those that light the frame; in view but beyond the maximum; with invalid values.
  std::uint32_t lights_lit = 0, lights_left_out = 0, lights_invalid = 0;
  // The same of particle emitters, and of their particles.
  std::uint32_t emitters_drawn = 0, emitters_left_out = 0, emitters_invalid = 0;
  std::uint64_t particles_drawn = 0, particles_left_out = 0;
  std::uint32_t requests = 0;         // wanted meshes that are not ready
  std::uint32_t refused = 0;          // of these, requests that found no memory
  std::uint32_t refused_visible = 0;  // of these, requests for meshes in view
  std::uint32_t completed = 0, failed = 0;
  std::uint64_t failed_in_all = 0;  // since the scene was created
  std::uint32_t models_drawn = 0;   // draws of models and merged meshes
  std::uint32_t models_synthesised = 0;
  std::uint64_t triangles_synthesised = 0, bytes_synthesised = 0;
  double synthesis_seconds = 0;
  bool impostors_missing = false;  // the renderer lacks impostors that are still being baked
  std::span<const float> time_to_visible_ms;  // of mesh entities that came into view and are drawn
  std::span<const MeshCost> costs;
};

}  // namespace psygen::scene
