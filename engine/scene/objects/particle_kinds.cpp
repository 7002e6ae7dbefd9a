#include "engine/scene/objects/particle_kinds.hpp"

namespace psygen::scene {

using render::ParticleKind;
using render::ParticleVolume;

ParticleKind smoke(glm::vec3 wind) {
  ParticleKind kind;
  kind.half_extent_m = {0.15F, 0, 0.15F};
  kind.rate = 14;
  kind.lifetime_s = 7;
  kind.lifetime_variation = 0.3F;
  kind.velocity = {0, 1.6F, 0};
  kind.spread = 0.25F;
  kind.gravity = -0.25F;
  kind.drag = 0.5F;
  kind.wind = wind;
  kind.turbulence_m = 0.5F;
  kind.first_size_m = 0.5F;
  kind.last_size_m = 3.2F;
  kind.size_variation = 0.3F;
  kind.first_colour = {0.22F, 0.21F, 0.20F, 0.55F};
  kind.last_colour = {0.42F, 0.42F, 0.43F, 0.10F};
  kind.brightness_variation = 0.25F;
  kind.fade_in = 0.06F;
  kind.fade_out = 0.6F;
  return kind;
}

ParticleKind fire() {
  ParticleKind kind;
  kind.half_extent_m = {0.22F, 0.02F, 0.22F};
  kind.rate = 60;
  kind.lifetime_s = 0.9F;
  kind.lifetime_variation = 0.5F;
  kind.velocity = {0, 0.9F, 0};
  kind.spread = 0.15F;
  kind.gravity = -1.2F;
  kind.turbulence_m = 0.1F;
  kind.first_size_m = 0.45F;
  kind.last_size_m = 0.08F;
  kind.size_variation = 0.4F;
  kind.first_colour = {1.6F, 0.62F, 0.14F, 0.65F};
  kind.last_colour = {0.9F, 0.10F, 0.01F, 0.4F};
  kind.fade_in = 0.15F;
  kind.fade_out = 0.5F;
  kind.glow = 1;
  kind.cover = 0;
  kind.aspect = 0.8F;
  return kind;
}

ParticleKind sparks() {
  ParticleKind kind;
  kind.half_extent_m = {0.1F, 0, 0.1F};
  kind.rate = 25;
  kind.lifetime_s = 1.6F;
  kind.lifetime_variation = 0.6F;
  kind.velocity = {0, 2.6F, 0};
  kind.spread = 0.9F;
  kind.gravity = 2.5F;
  kind.drag = 0.4F;
  kind.turbulence_m = 0.25F;
  kind.first_size_m = kind.last_size_m = 0.03F;
  kind.size_variation = 0.5F;
  kind.first_colour = {4.0F, 1.8F, 0.5F, 1.0F};
  kind.last_colour = {2.0F, 0.3F, 0.02F, 1.0F};
  kind.fade_in = 0;
  kind.fade_out = 0.2F;
  kind.glow = 1;
  kind.cover = 0;
  kind.softness = 0.6F;
  kind.streak_s = 0.03F;
  return kind;
}

ParticleKind leaves(glm::vec3 wind) {
  ParticleKind kind;
  kind.half_extent_m = {3, 1, 3};
  kind.rate = 6;
  kind.lifetime_s = 8;
  kind.velocity = {0, -0.4F, 0};
  kind.spread = 0.4F;
  kind.gravity = 1.6F;
  kind.drag = 1.8F;
  kind.wind = wind;
  kind.turbulence_m = 0.7F;
  kind.first_size_m = kind.last_size_m = 0.16F;
  kind.size_variation = 0.4F;
  kind.first_colour = {0.42F, 0.20F, 0.03F, 1.0F};
  kind.last_colour = {0.30F, 0.09F, 0.02F, 1.0F};
  kind.brightness_variation = 0.6F;
  kind.fade_in = 0.05F;
  kind.fade_out = 0.1F;
  kind.softness = 0.2F;
  kind.aspect = 0.6F;
  kind.spin = 2;
  kind.tumbling = 5;
  return kind;
}

ParticleKind rain(glm::vec3 wind) {
  ParticleKind kind;
  kind.volume = ParticleVolume::kAroundCamera;
  kind.half_extent_m = {14, 10, 14};
  kind.rate = 1500;
  kind.lifetime_s = 2;
  kind.velocity = {wind.x, -9 + wind.y, wind.z};
  kind.spread = 0.4F;
  kind.first_size_m = kind.last_size_m = 0.012F;
  kind.first_colour = kind.last_colour = {0.62F, 0.66F, 0.72F, 0.35F};
  kind.brightness_variation = 0.3F;
  kind.fade_in = kind.fade_out = 0.1F;
  kind.softness = 0.8F;
  kind.streak_s = 0.05F;
  return kind;
}

ParticleKind snow(glm::vec3 wind) {
  ParticleKind kind;
  kind.volume = ParticleVolume::kAroundCamera;
  kind.half_extent_m = {15, 9, 15};
  kind.rate = 420;
  kind.lifetime_s = 8;
  kind.velocity = {wind.x, -1.1F + wind.y, wind.z};
  kind.spread = 0.35F;
  kind.turbulence_m = 0.6F;
  kind.first_size_m = kind.last_size_m = 0.06F;
  kind.size_variation = 0.6F;
  kind.first_colour = kind.last_colour = {0.9F, 0.92F, 0.96F, 0.9F};
  kind.fade_in = kind.fade_out = 0.15F;
  kind.softness = 0.9F;
  return kind;
}

}  // namespace psygen::scene
