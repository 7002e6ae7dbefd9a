// Particles: each emitter of a frame is one draw, back to front, over the landscape. The shader
// computes all particles from the emitter's data. Private to engine/render.
#pragma once

#include <vector>

#include "engine/render/passes/pass.hpp"

namespace psygen::render {

// Empty until create(). The device and the sets of the frame must outlive it.
class Particles {
 public:
  // The functions of Pass (pass.hpp).
  static constexpr Stage kStage = Stage::kSurface;
  static constexpr Feature kFeature = Feature::kParticles;
  static bool needs_feature(const FrameInput& input) { return !input.particles.empty(); }
  static constexpr int warm_up_steps(Feature feature) { return feature == kFeature ? 2 : 0; }
  core::Result<void> create(const PassSetup& setup);
  void list(const FrameInput& input, const FrameFacts& facts);
  core::Result<void> write(const Device& device, std::size_t slot);
  void record(const Recording& to) const;
  void warm_up(const Recording& to, const WarmUpStep& step) const;

 private:
  // An emitter of the frame.
  struct EmitterRun {
    std::uint32_t count = 0;
    MaterialId textures = kPlainMaterial;  // whose base texture the particles show
  };

  PassSet set_;
  SlotBuffer emitters_;
  std::vector<shaders::EmitterData> listed_;
  std::vector<EmitterRun> runs_;  // back to front, in the order of their data
  UniquePipeline plain_, textured_;
};
static_assert(Pass<Particles>);

}  // namespace psygen::render
