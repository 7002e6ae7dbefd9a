// Particles as values: how those of a kind are born, move and look, and an emitter of a frame. The
// device computes every particle from these, its number and the time (shaders/particle.vert);
// nothing is simulated or kept. Plain data, any thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/render/types.hpp"

namespace psygen::render {

// Bounds of a frame: particles of an emitter and of all, and emitters.
inline constexpr std::uint32_t kMaxParticlesPerEmitter = 8192;
inline constexpr std::uint32_t kMaxParticles = 65536;
inline constexpr std::uint32_t kMaxEmitters = 256;
// The smallest drag that is computed, 1/s: closed forms of motion divide by the drag.
inline constexpr float kMinParticleDrag = 0.01F;

// Where particles are born. kBox: in a box around the emitter, or at a point if that has no size.
// kAroundCamera: everywhere, drawn in a box around the camera; for rain and snow. The emitter's
// place does not matter then.
enum class ParticleVolume : std::uint8_t { kBox, kAroundCamera };

// A kind of particles. All lengths and speeds are those of an emitter without scale. Directions of
// `half_extent_m` and `velocity` are turned with the emitter; gravity and wind are the world's.
struct ParticleKind {
  ParticleVolume volume = ParticleVolume::kBox;
  glm::vec3 half_extent_m{0.0F};  // of the box, 0 … 1000; kAroundCamera: at least 1 each

  float rate = 20;               // births a second, > 0
  float lifetime_s = 3;          // 0.01 … 1000
  float lifetime_variation = 0;  // 0 … 1: lives are shorter by up to this share

  glm::vec3 velocity{0, 1, 0};  // at birth, m/s
  float spread = 0.2F;          // random part of it, m/s along each axis
  float gravity = 0;            // m/s² downwards; negative: particles rise
  float drag = 0;               // 1/s: how fast velocities become that of the wind
  glm::vec3 wind{0.0F};         // m/s; only drag makes particles follow it
  float turbulence_m = 0;       // how far particles stray from their path

  float first_size_m = 0.5F, last_size_m = 0.5F;  // width at birth and at the end, 0 … 100
  float size_variation = 0;  // 0 … 1: particles are smaller by up to this share
  glm::vec4 first_colour{1.0F}, last_colour{1.0F, 1.0F, 1.0F, 0.0F};  // linear; a: opacity 0 … 1
  float brightness_variation = 0;         // 0 … 1: particles are darker by up to this share
  float fade_in = 0.1F, fade_out = 0.3F;  // shares of a life in which opacity comes and goes

  float glow = 0;      // 0: lit by sun, sky and point lights; 1: colours are light, before exposure
  float cover = 1;     // share of what is behind that is hidden; 0: light is added (fire)
  float softness = 1;  // of the disc's edge, 0 … 1
  float aspect = 1;    // width over height
  float streak_s = 0;  // > 0: a streak along the motion, as long as that in this many seconds
  float spin = 0;      // rad/s in the picture, either way
  float tumbling = 0;  // rad/s about their height: leaves turn over
  MaterialId material = kPlainMaterial;  // its base texture instead of a disc; rest is ignored
};

// An emitter of a frame, relative to the camera.
struct ParticleDraw {
  ParticleKind kind;
  glm::vec3 origin{0.0F};  // kAroundCamera: the camera in the lattice of boxes (box_place)
  std::array<glm::vec3, 3> axes{glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)};
  float scale = 1;              // of sizes and speeds
  std::uint32_t count = 0;      // of particles, 1 … kMaxParticlesPerEmitter
  std::uint32_t seed = 0;       // of the generation of the first particle …
  std::uint32_t next_seed = 0;  // … and of the next one; both below 2^24
  float cycle_s = 1;            // from a birth of a particle to its next one, > 0
  float cycle = 0;              // share of it that has passed for the first particle, 0 … 1
  float youngest_s = 0, oldest_s = 1e9F;  // ages of particles that were born while it emitted
  float sun = 1;                          // share of the sun that no terrain hides
  float opacity = 1;                      // of all of them
};

// Returns true if all numbers of a kind are within their ranges.
bool is_valid(const ParticleKind& kind);
// The number of particles that live at a time: rate · lifetime, 1 … kMaxParticlesPerEmitter.
std::uint32_t particle_count(const ParticleKind& kind);
// A bound of the distance between where an emitter is and what it draws, in metres. `scale` as of
// ParticleDraw, `half_diagonal_m` of its turned box.
float reach_m(const ParticleKind& kind, float scale, float half_diagonal_m);

}  // namespace psygen::render
