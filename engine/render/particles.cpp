#include "engine/render/particles.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace psygen::render {
namespace {

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
  const float drag = std::max(kind.drag, kMinParticleDrag), life = kind.lifetime_s;
  const float braked = (1 - std::exp(-drag * life)) / drag;
  const float start = (glm::length(kind.velocity) + kind.spread * 1.7321F) * scale;
  const float pull = glm::length(kind.wind) * drag + std::abs(kind.gravity);
  const float size = std::max(kind.first_size_m, kind.last_size_m) * scale;
  const float streak = kind.streak_s * (start + pull * braked);
  return half_diagonal_m + start * braked + pull * (life - braked) / drag +
         kind.turbulence_m * 1.7321F + size * std::max(kind.aspect, 1.0F) + streak;
}

}  // namespace psygen::render
