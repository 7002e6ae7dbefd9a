#include "engine/scene/state.hpp"

namespace psygen::scene {

void reset_counts(State& s) {
  s.streaming.counts = {};
  s.view.hidden = 0;
  s.meshes.counts = {};
  s.object_draws.counts = {};
  s.light_draws.counts = {};
  s.particle_draws.counts = {};
  s.draws.counts = {};
  s.draws.frame = {};
}

Statistics statistics_of(const State& s) {
  Statistics all;
  all.nodes_created = s.streaming.counts.created;
  all.nodes_destroyed = s.streaming.counts.destroyed;
  all.nodes_hidden = s.view.hidden;
  const DrawCounts& drawn = s.draws.counts;
  all.nodes_in_view = drawn.nodes_in_view;
  all.holes = drawn.holes;
  all.coarse = drawn.coarse;
  all.awaited = drawn.awaited;
  all.missing_pixels_percent = drawn.missing_pixels_percent;
  all.models_drawn = static_cast<std::uint32_t>(s.draws.models.size());
  const ObjectCounts& objects = s.object_draws.counts;
  all.objects_drawn = objects.drawn;
  all.objects_missing = objects.missing;
  all.objects_invalid = objects.invalid;
  const LightCounts& lights = s.light_draws.counts;
  all.lights_lit = lights.lit;
  all.lights_left_out = lights.left_out;
  all.lights_invalid = lights.invalid;
  const ParticleCounts& particles = s.particle_draws.counts;
  all.emitters_drawn = particles.emitters_drawn;
  all.emitters_left_out = particles.emitters_left_out;
  all.emitters_invalid = particles.emitters_invalid;
  all.particles_drawn = particles.particles_drawn;
  all.particles_left_out = particles.particles_left_out;
  const MeshCounts& made = s.meshes.counts;
  all.requests = made.requests;
  all.refused = made.refused;
  all.refused_visible = made.refused_visible;
  all.completed = made.completed;
  all.failed = made.failed;
  all.failed_in_all = s.meshes.failed;
  all.models_synthesised = made.models_synthesised;
  all.triangles_synthesised = made.triangles_synthesised;
  all.bytes_synthesised = made.bytes_synthesised;
  all.synthesis_seconds = made.synthesis_seconds;
  all.impostors_missing = s.meshes.pictures_lacking != 0;
  all.time_to_visible_ms = made.time_to_visible_ms;
  all.costs = made.costs;
  return all;
}

}  // namespace psygen::scene
