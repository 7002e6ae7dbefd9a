#include "engine/render/particles.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/render/emitter_data.hpp"

namespace psygen::render {
namespace {

// Without drag, closed forms would divide by it.
constexpr float kMinDrag = 0.01F;
// Shares of a life that divide.
constexpr float kMinShare = 1e-3F;

bool within(float value, float least, float greatest) {
  return value >= least && value <= greatest;
}
bool within(const glm::vec3& v, float least, float greatest) {
  return within(v.x, least, greatest) && within(v.y, least, greatest) &&
         within(v.z, least, greatest);
}
bool is_colour(const glm::vec4& c) {
  return within(glm::vec3(c), 0, 1e6F) && within(c.w, 0, 1);
}

}  // namespace

bool is_valid(const ParticleKind& k) {
  constexpr float kFast = 1000;
  const float min_extent = k.volume == ParticleVolume::kAroundCamera ? 1.0F : 0.0F;
  return within(k.half_extent_m, min_extent, 1000) && within(k.rate, 1e-3F, 1e9F) &&
         within(k.lifetime_s, 0.01F, 1000) && within(k.lifetime_variation, 0, 1) &&
         within(k.velocity, -kFast, kFast) && within(k.spread, 0, kFast) &&
         within(k.gravity, -kFast, kFast) && within(k.drag, 0, 100) &&
         within(k.wind, -kFast, kFast) && within(k.turbulence_m, 0, kFast) &&
         within(k.first_size_m, 0, 100) && within(k.last_size_m, 0, 100) &&
         within(k.size_variation, 0, 1) && is_colour(k.first_colour) && is_colour(k.last_colour) &&
         within(k.brightness_variation, 0, 1) && within(k.fade_in, 0, 1) &&
         within(k.fade_out, 0, 1) && within(k.glow, 0, 1) && within(k.cover, 0, 1) &&
         within(k.softness, 0, 1) && within(k.aspect, 0.01F, 100) && within(k.streak_s, 0, 10) &&
         within(k.spin, 0, 100) && within(k.tumbling, 0, 100);
}

std::uint32_t particle_count(const ParticleKind& kind) {
  const float alive = std::ceil(kind.rate * kind.lifetime_s);
  return static_cast<std::uint32_t>(
      std::clamp(alive, 1.0F, static_cast<float>(kMaxParticlesPerEmitter)));
}

float reach_m(const ParticleKind& kind, float scale, float half_diagonal_m) {
  const float drag = std::max(kind.drag, kMinDrag), life = kind.lifetime_s;
  const float braked = (1 - std::exp(-drag * life)) / drag;
  const float start = (glm::length(kind.velocity) + kind.spread * 1.7321F) * scale;
  const float pull = glm::length(kind.wind) * drag + std::abs(kind.gravity);
  const float size = std::max(kind.first_size_m, kind.last_size_m) * scale;
  const float streak = kind.streak_s * (start + pull * braked);
  return half_diagonal_m + start * braked + pull * (life - braked) / drag +
         kind.turbulence_m * 1.7321F + size * std::max(kind.aspect, 1.0F) + streak;
}

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
  out.motion = {std::max(k.drag, kMinDrag), k.turbulence_m, k.spin, k.tumbling};
  out.light = {draw.sun, draw.opacity, k.glow, k.cover};
  out.names = {static_cast<float>(draw.seed), static_cast<float>(draw.next_seed), draw.youngest_s,
               draw.oldest_s};
  out.around = {around ? 2.0F * k.half_extent_m : glm::vec3(0.0F), k.brightness_variation};
  out.cycle = {draw.cycle_s, 0, 0, 0};
  return out;
}

}  // namespace psygen::render
