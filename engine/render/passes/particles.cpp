#include "engine/render/passes/particles.hpp"

#include <algorithm>

namespace psygen::render {

namespace {

// Shares of a life that divide are at least this.
constexpr float kMinShare = 1e-3F;

}  // namespace

shaders::EmitterData data_of(const ParticleDraw& draw) {
  const ParticleKind& k = draw.kind;
  const bool around = k.volume == ParticleVolume::kAroundCamera;
  const glm::vec3 velocity =
      draw.axes[0] * k.velocity.x + draw.axes[1] * k.velocity.y + draw.axes[2] * k.velocity.z;
  shaders::EmitterData out{};
  out.origin = {draw.origin, draw.cycle};
  out.axis_x = {draw.axes[0] * k.half_extent_m.x, static_cast<float>(draw.count)};
  out.axis_y = {draw.axes[1] * k.half_extent_m.y, k.lifetime_s};
  out.axis_z = {draw.axes[2] * k.half_extent_m.z, k.lifetime_variation};
  out.velocity = {velocity, k.spread * draw.scale};
  out.wind = {k.wind, k.gravity};
  out.first_colour = k.first_colour;
  out.last_colour = k.last_colour;
  out.size = {k.first_size_m * draw.scale, k.last_size_m * draw.scale, k.size_variation,
              k.streak_s};
  out.shape = {std::max(k.fade_in, kMinShare), std::max(k.fade_out, kMinShare), k.softness,
               k.aspect};
  out.motion = {std::max(k.drag, kMinParticleDrag), k.turbulence_m, k.spin, k.tumbling};
  out.light = {draw.sun, draw.opacity, k.glow, k.cover};
  out.names = {static_cast<float>(draw.seed), static_cast<float>(draw.next_seed), draw.youngest_s,
               draw.oldest_s};
  out.around = {around ? 2.0F * k.half_extent_m : glm::vec3(0.0F), k.brightness_variation};
  out.cycle = {draw.cycle_s, 0, 0, 0};
  return out;
}

}  // namespace psygen::render
