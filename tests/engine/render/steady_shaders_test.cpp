// lavapipe compiles a shader anew, for a tenth of a second, for each value of a uniform that alone
// decides one of its loops or branches. No shader may have such a branch on what changes during a
// flight: players would see it as a hitch.
#include <gtest/gtest.h>

#include <utility>

#include "engine/render/types.hpp"
#include "tests/engine/render/compiled_shaders.hpp"
#include "tests/engine/render/one_of_each.hpp"

namespace psygen::render {
namespace {

class SteadyShaders : public OneOfEach {
 protected:
  // Only lavapipe compiles shaders anew, so it draws also where there is a GPU.
  std::string device_name() const override { return "llvmpipe"; }
  void SetUp() override {
    OneOfEach::SetUp();
    if (!renderer_) return;
    input_.water = WaterPlane{};
    input_.block_size_m = 64;
    emitter_.kind.half_extent_m = {2, 2, 0.5F};
    emitter_.origin = {0, 0, -12};
    emitter_.count = 20;
    emitter_.cycle_s = 3;
    emitter_.cycle = 0.3F;
    known_ = compiled_shaders();
  }
  // Draws a frame and returns the number of shaders that it compiled.
  std::uint64_t compiled_for(const FrameInput& input) {
    draw(input);
    renderer_->wait_idle();
    return compiled_shaders() - std::exchange(known_, compiled_shaders());
  }

  ParticleDraw emitter_;
  std::uint64_t known_ = 0;
};

TEST_P(SteadyShaders, AreTheSameForAllEmitters) {
  input_.particles = {&emitter_, 1};
  EXPECT_GT(compiled_for(input_), 0U) << "compilations are not counted";
  for (int i = 1; i <= 8; ++i) {
    const auto number = static_cast<float>(i);
    emitter_.kind.volume = (i & 1) != 0 ? ParticleVolume::kAroundCamera : ParticleVolume::kBox;
    emitter_.kind.half_extent_m = glm::vec3(number);
    emitter_.kind.streak_s = (i & 2) != 0 ? 0.01F * number : 0;
    emitter_.kind.tumbling = (i & 4) != 0 ? number : 0;
    EXPECT_EQ(compiled_for(input_), 0U) << "kind " << i;
  }
}

TEST_P(SteadyShaders, AreTheSameForAnyNumberOfLights) {
  input_.particles = {&emitter_, 1};
  std::vector<PointLight> lights;
  for (int i = 1; i <= 6; ++i) {
    lights.push_back({{0, static_cast<float>(i), -8}, 30, glm::vec3(5.0F)});
    input_.point_lights = lights;
    const std::uint64_t compiled = compiled_for(input_);
    if (i == 1) {
      EXPECT_GT(compiled, 0U) << "compilations are not counted";
    } else {
      EXPECT_EQ(compiled, 0U) << i << " lights";
    }
  }
}

TEST_P(SteadyShaders, AreTheSameWhereverTheCameraTheSunAndTheGroundAre) {
  EXPECT_GT(compiled_for(input_), 0U) << "compilations are not counted";
  for (int i = 1; i <= 6; ++i) {
    const auto number = static_cast<float>(i);
    input_.water->level_m = (i & 1) != 0 ? number : -number;
    input_.light.sun_direction = glm::normalize(glm::vec3(1, number - 3, 0.5F));
    input_.light.cloud_cover = 0.1F * number;
    input_.light.exposure = number;
    input_.light.time_seconds = 10 * number;
    input_.fade_phase = 0.1F * number;
    ground_.morph = (i & 1) != 0 ? 0.1F * number : kMorphByDistance;
    ground_.cover = 0.1F * number;
    EXPECT_EQ(compiled_for(input_), 0U) << "step " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(OnEveryPath, SteadyShaders,
                         testing::ValuesIn(std::vector<How>{
                             {RenderPath::kCpu, Submission::kPushed, Preset::kLow},
                             {RenderPath::kCpu, Submission::kMultiDraw, Preset::kLow},
                             {RenderPath::kCpu, Submission::kMultiDraw, Preset::kMedium},
                             {RenderPath::kGpu, Submission::kMultiDraw, Preset::kHigh}}));

}  // namespace
}  // namespace psygen::render
