// Chooses the emitters that are drawn: those in view, nearest first if there are more than the
// renderer takes. The device makes the particles; this system only finds the phase of each
// emitter's cycle. Allocates nothing once there were as many emitters.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "engine/core/hash.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/nodes/streaming.hpp"
#include "engine/scene/objects/scene_draws.hpp"
#include "engine/scene/view/visibility.hpp"

namespace psygen::scene {
namespace {

// Fraction of the view distance over which emitters fade out.
constexpr float kFadeShare = 0.15F;

struct ParticleTick {
  double now_s = 0, block_size_m = 64;
  float view_distance_m = 0;
};

struct EmitterCandidate {
  float distance_m = 0;
  const Transform* transform = nullptr;
  const ParticleEmitter* emitter = nullptr;
};

bool is_around(const ParticleEmitter& emitter) {
  return emitter.kind.volume == render::ParticleVolume::kAroundCamera;
}

float scale_of(const Transform& transform) {
  const glm::vec3 size = glm::abs(transform.scale);
  return std::max({size.x, size.y, size.z});
}

// The camera's position in a lattice of boxes of this size, so that particles stay in the world
// while the box moves on; the middle of a box at the camera.
glm::vec3 place_in_lattice(const core::WorldPosition& camera, glm::vec3 box, double block_size_m) {
  const glm::dvec3 at = camera.local + glm::dvec3(camera.block.x, 0, camera.block.z) * block_size_m;
  const glm::dvec3 size(box);
  const glm::dvec3 turns = -at / size;
  return glm::vec3((turns - glm::floor(turns)) * size) + 0.5F * box;
}

// Finds the phase of an emitter's cycle, and the generations of its particles.
void set_cycle(const ParticleEmitter& emitter, double now_s, render::ParticleDraw& draw) {
  const render::ParticleKind& kind = emitter.kind;
  draw.count = render::particle_count(kind);
  const double by_rate_s = draw.count / static_cast<double>(kind.rate);
  draw.cycle_s = static_cast<float>(std::max(by_rate_s, static_cast<double>(kind.lifetime_s)));
  const double turns = now_s / static_cast<double>(draw.cycle_s), whole = std::floor(turns);
  draw.cycle = static_cast<float>(turns - whole);
  const auto generation = static_cast<std::uint64_t>(static_cast<std::int64_t>(whole));
  const auto seed_of = [&](std::uint64_t number) {
    return static_cast<std::uint32_t>(core::combine(emitter.seed, number) & 0xFFFFFF);
  };
  draw.seed = seed_of(generation);
  draw.next_seed = seed_of(generation + 1);
  constexpr double kForever = 1e9;
  draw.youngest_s = static_cast<float>(std::clamp(now_s - emitter.stop_s, 0.0, kForever));
  draw.oldest_s = static_cast<float>(std::clamp(now_s - emitter.start_s, 0.0, kForever));
}

class EmitterChoice {
 public:
  EmitterChoice(const ParticleTick& tick, const Camera& camera, const View& view,
                ParticleCounts& counts)
      : tick_(tick), camera_(camera), view_(view), counts_(counts) {}

  void visit(const Transform& transform, const ParticleEmitter& emitter) {
    if (!emitter.visible) return;
    const bool times = !std::isnan(emitter.start_s) && !std::isnan(emitter.stop_s);
    if (!times || !is_valid(transform) || !render::is_valid(emitter.kind)) {
      ++counts_.emitters_invalid;
      return;
    }
    const double since_stop_s = tick_.now_s - emitter.stop_s;
    if (tick_.now_s < emitter.start_s || since_stop_s > emitter.kind.lifetime_s) return;
    EmitterCandidate found{0, &transform, &emitter};
    if (!is_around(emitter)) {
      const glm::vec3 place =
          offset_of(transform.position, camera_.pose.position, tick_.block_size_m);
      const float scale = scale_of(transform);
      const float half_m = glm::length(emitter.kind.half_extent_m) * scale;
      const float reach_m = render::reach_m(emitter.kind, scale, half_m);
      found.distance_m = glm::length(place);
      if (found.distance_m > tick_.view_distance_m ||
          !may_be_visible(core::Bounds::around(place, glm::vec3(reach_m)), view_))
        return;
    }
    propose(found);
  }

  // Returns the chosen emitters, nearest first.
  std::span<const EmitterCandidate> chosen() {
    std::sort(best_.begin(), best_.begin() + static_cast<std::ptrdiff_t>(count_), is_nearer);
    return std::span(best_).first(count_);
  }

  void leave_out(const EmitterCandidate& found) {
    ++counts_.emitters_left_out;
    counts_.particles_left_out += render::particle_count(found.emitter->kind);
  }

 private:
  static bool is_nearer(const EmitterCandidate& a, const EmitterCandidate& b) {
    return a.distance_m < b.distance_m;
  }

  // Adds to the nearest so far, which are a heap with the farthest on top.
  void propose(const EmitterCandidate& found) {
    const auto begin = best_.begin();
    if (count_ == best_.size()) {
      if (!is_nearer(found, best_[0])) return leave_out(found);
      std::pop_heap(begin, best_.end(), is_nearer);
      leave_out(best_[--count_]);
    }
    best_[count_++] = found;
    std::push_heap(begin, begin + static_cast<std::ptrdiff_t>(count_), is_nearer);
  }

  const ParticleTick& tick_;
  const Camera& camera_;
  const View& view_;
  ParticleCounts& counts_;
  std::array<EmitterCandidate, render::kMaxEmitters> best_;
  std::size_t count_ = 0;
};

render::ParticleDraw draw_of(const EmitterCandidate& found, const ParticleTick& tick,
                             const Camera& camera, const Streaming& streaming,
                             const ParticleQuery& entities) {
  const Transform& transform = *found.transform;
  render::ParticleDraw draw;
  draw.kind = found.emitter->kind;
  core::WorldPosition lit_at = transform.position;
  if (is_around(*found.emitter)) {
    lit_at = camera.pose.position;
    draw.origin = place_in_lattice(lit_at, 2.0F * draw.kind.half_extent_m, tick.block_size_m);
  } else {
    const glm::quat rotation = glm::normalize(transform.rotation);
    for (int axis = 0; axis < 3; ++axis) {
      glm::vec3 unit(0.0F);
      unit[axis] = transform.scale[axis];
      draw.axes[static_cast<std::size_t>(axis)] = rotation * unit;
    }
    draw.origin = offset_of(transform.position, camera.pose.position, tick.block_size_m);
    draw.scale = scale_of(transform);
    draw.opacity =
        std::clamp((tick.view_distance_m - found.distance_m) / (kFadeShare * tick.view_distance_m),
                   0.0F, 1.0F);
  }
  draw.sun = ground_sun_at(lit_at, tick.block_size_m, streaming, entities);
  set_cycle(*found.emitter, tick.now_s, draw);
  return draw;
}

}  // namespace

void particles_system(FrameContext frame, const Camera& camera, const WorldFacts& facts,
                      VisibleNodes nodes, ParticleQuery entities, ParticleDraws& draws) {
  const ParticleTick tick{frame.clock.now_s, facts.world.block_size_m(),
                          static_cast<float>(frame.settings.view_distance_m)};
  draws.emitters.clear();
  EmitterChoice choice(tick, camera, nodes.view, draws.counts);
  entities.each<const Transform, const ParticleEmitter>([&](auto, auto transforms, auto emitters) {
    for (std::size_t i = 0; i < emitters.size(); ++i)
      choice.visit(transforms[i], emitters[i]);
  });
  std::uint64_t left = render::kMaxParticles;
  for (const EmitterCandidate& found : choice.chosen()) {
    render::ParticleDraw draw = draw_of(found, tick, camera, nodes.streaming, entities);
    if (draw.count > left) {
      choice.leave_out(found);
      continue;
    }
    left -= draw.count;
    const double wanted = std::ceil(static_cast<double>(found.emitter->kind.rate) *
                                    static_cast<double>(found.emitter->kind.lifetime_s));
    draws.counts.particles_left_out +=
        static_cast<std::uint64_t>(std::max(wanted - draw.count, 0.0));
    draws.counts.particles_drawn += draw.count;
    draws.emitters.push_back(draw);
  }
  draws.counts.emitters_drawn += static_cast<std::uint32_t>(draws.emitters.size());
  std::reverse(draws.emitters.begin(), draws.emitters.end());  // back to front
}

}  // namespace psygen::scene
