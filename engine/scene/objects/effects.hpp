// Light and particles of a game (docs/lights.md): an entity with a Transform and a PointLight
// lights its surroundings; one with a Transform and a ParticleEmitter smokes, burns or rains. An
// entity may have both, and an Object too. Plain data; main thread only.
#pragma once

#include <limits>

#include "engine/render/types.hpp"
#include "engine/scene/objects/components.hpp"

namespace psygen::scene {

// The draw state of a light. Only the engine writes it (lights_system).
struct PointLightState {
  float share = 0;                          // fraction of its light
  std::uint32_t in_view_tick = UINT32_MAX;  // the last tick in which it was in view
  bool fresh = true;                        // never in view so far
};

// A light that shines in all directions and casts no shadows. Stays dark with values outside these
// ranges (LightCounts::invalid).
struct PointLight {
  glm::vec3 colour{1.0F, 0.72F, 0.42F};  // linear, each 0 … 1000
  // Light on a surface that faces it from 1 m away, 0 … 10⁶; the sun at noon gives about 2.
  float intensity = 2.0F;
  float range_m = 15.0F;  // where it ends, 0.1 … 1000; falls off with the squared distance before
  bool visible = true;    // false: fades out
  PointLightState state = {};
};

}  // namespace psygen::scene

// Saved without the draw state.
template <>
struct psygen::ecs::ComponentTraits<psygen::scene::PointLight> {
  static constexpr std::string_view name = "PointLight";
  static constexpr auto fields = std::tuple{field("colour", &scene::PointLight::colour),
                                            field("intensity", &scene::PointLight::intensity),
                                            field("range_m", &scene::PointLight::range_m),
                                            field("visible", &scene::PointLight::visible)};
};

namespace psygen::scene {

// An emitter of particles. Draws nothing with values outside of ParticleKind's ranges
// (ParticleCounts::emitters_invalid).
struct ParticleEmitter {
  render::ParticleKind kind;
  std::uint32_t seed = 0;  // emitters of one kind with different seeds differ
  // The period in which particles are born, by Clock::now_s. Each particle lives to its end.
  double start_s = -std::numeric_limits<double>::infinity();
  double stop_s = std::numeric_limits<double>::infinity();
  bool visible = true;  // false: all particles vanish at once
};

// Creates a light or an emitter: an entity with these components.
inline ecs::Entity spawn_light(ecs::World& world, const PointLight& light,
                               const Transform& transform) {
  const auto made = world.create<Transform, PointLight>(1);
  made.column<Transform>()[0] = transform;
  made.column<PointLight>()[0] = light;
  return made.entities[0];
}
inline ecs::Entity spawn_emitter(ecs::World& world, const ParticleEmitter& emitter,
                                 const Transform& transform) {
  const auto made = world.create<Transform, ParticleEmitter>(1);
  made.column<Transform>()[0] = transform;
  made.column<ParticleEmitter>()[0] = emitter;
  return made.entities[0];
}

}  // namespace psygen::scene
