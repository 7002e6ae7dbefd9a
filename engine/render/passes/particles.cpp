#include "engine/render/passes/particles.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace psygen::render {

using core::Result;

namespace {

// Shares of a life that divide are at least this.
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

// An emitter as the shaders read it.
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

Result<void> Particles::create(const PassSetup& setup) {
  if (!setup.features.has(kFeature) || set_.exists()) return {};
  const std::array bindings{
      SetBinding{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VK_SHADER_STAGE_VERTEX_BIT}};
  PipelineShape shape{.vert = Shader::kParticleVert, .blend = Blend::kPremultiplied};
  shape.constants[2] = VK_TRUE;
  PassSet set;
  Result<void> made = set.create(setup, bindings, setup.sets.shared())
                          .and_then([&] {
                            return emitters_.create(setup.device, setup.sets.slots(),
                                                    kMaxEmitters * sizeof(shaders::EmitterData),
                                                    VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
                          })
                          .and_then([&] {
                            set.write(setup.device, PSYGEN_PARTICLE_EMITTER, emitters_,
                                      sizeof(shaders::EmitterData));
                            shape.frag = Shader::kParticleTexturedFrag;
                            return setup.pipelines.make(set.layout(), shape, textured_);
                          })
                          .and_then([&] {
                            shape.frag = Shader::kParticleFrag;
                            return setup.pipelines.make(set.layout(), shape, plain_);
                          });
  if (made) set_ = std::move(set);
  return made;
}

// Views for debugging show no particles.
void Particles::list(const FrameInput& input, const FrameFacts& facts) {
  listed_.clear();
  runs_.clear();
  if (use_in(input.view) != MeshUse::kLandscape) return;
  const std::size_t last = input.particles.size();
  for (std::size_t i = last - std::min<std::size_t>(last, kMaxEmitters); i < last; ++i) {
    const ParticleDraw& draw = input.particles[i];
    const MaterialId material = draw.kind.material;
    const bool textured = kind_of(facts.materials, material).textured;
    listed_.push_back(data_of(draw));
    runs_.push_back({.count = std::min(draw.count, kMaxParticlesPerEmitter),
                     .textures = textured ? material : kPlainMaterial});
  }
}

Result<void> Particles::write(const Device& device, std::size_t slot) {
  if (listed_.empty()) return {};
  return emitters_.write(device, slot, std::as_bytes(std::span(listed_))).map([](bool) {});
}

void Particles::record(const Recording& to) const {
  TextureBinder textures(to);
  VkPipeline bound = VK_NULL_HANDLE;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const EmitterRun& run = runs_[i];
    const VkPipeline pipeline = run.textures != kPlainMaterial ? textured_.get() : plain_.get();
    if (pipeline != bound) to.bind_pipeline(pipeline);
    bound = pipeline;
    textures.bind(run.textures);  // set 1, which may disturb set 2
    set_.bind(to.device, to.commands(), to.slot.number(),
              static_cast<std::uint32_t>(i * sizeof(shaders::EmitterData)));
    to.draw(run.count * PSYGEN_PARTICLE_VERTICES);
  }
}

void Particles::warm_up(const Recording& to, const WarmUpStep& step) const {
  to.bind_pipeline(step.number == 1 ? textured_.get() : plain_.get());
  set_.bind(to.device, to.commands(), to.slot.number(), 0);
  to.draw(PSYGEN_PARTICLE_VERTICES);
}

}  // namespace psygen::render
