// Light and particles of a game (docs/lights.md): an entity with a Transform and a PointLight
// lights what is around it; one with a Transform and a ParticleEmitter smokes, burns, rains. An
// entity may have both, and an Object too. Plain data; main thread only.
#pragma once

#include <limits>

#include "engine/render/particles.hpp"
#include "engine/scene/objects/components.hpp"

namespace psygen::scene {

// How a light is drawn now. Only the engine writes it (lights_system).
struct PointLightState {
  float share = 0;                          // of its light that is there
  std::uint32_t in_view_tick = UINT32_MAX;  // the last one in which it was
  bool fresh = true;                        // never in view so far
};

// A light that shines in all directions and casts no shadows. With values outside these ranges
// it stays dark (Counters::lights_invalid).
struct PointLight {
  glm::vec3 colour{1.0F, 0.72F, 0.42F};  // linear, each 0 … 1000
  // Light on a surface that faces it from 1 m away, 0 … 10⁶; the sun at noon gives about 2.
  float intensity = 2.0F;
  float range_m = 15.0F;  // where it ends, 0.1 … 1000; the square of the distance rules before
  bool visible = true;    // else it fades out
  PointLightState state = {};
};

}  // namespace psygen::scene

// For snapshots (described.hpp): all but how it is drawn now.
template <>
struct psygen::ecs::ComponentTraits<psygen::scene::PointLight> {
  static constexpr std::string_view name = "PointLight";
  static constexpr auto fields = std::tuple{field("colour", &scene::PointLight::colour),
                                            field("intensity", &scene::PointLight::intensity),
                                            field("range_m", &scene::PointLight::range_m),
                                            field("visible", &scene::PointLight::visible)};
};

namespace psygen::scene {

// Particles. With values outside of ParticleKind's ranges nothing is drawn
// (Counters::emitters_invalid).
struct ParticleEmitter {
  render::ParticleKind kind;
  std::uint32_t seed = 0;  // emitters of one kind with different seeds differ
  // When particles are born, by Clock::now_s. Those that are there live to their end.
  double start_s = -std::numeric_limits<double>::infinity();
  double stop_s = std::numeric_limits<double>::infinity();
  bool visible = true;  // else all of it is gone at once
};

// A new light, or a new emitter: an entity with these components.
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
