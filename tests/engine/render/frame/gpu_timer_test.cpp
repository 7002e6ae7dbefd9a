#include "engine/render/frame/gpu_timer.hpp"

#include <gtest/gtest.h>

#include <set>

#include "engine/core/clock.hpp"
#include "engine/render/renderer.hpp"
#include "tests/engine/render/synthetic_scene.hpp"

namespace psygen::render {
namespace {

std::unique_ptr<Renderer> make(Preset preset, RenderPath path, bool timestamps = true) {
  RendererOptions options;
  options.validation = true;
  options.size = {320, 240};
  options.geometry_budget_bytes = 8 << 20;
  options.preset = preset;
  options.path = path;
  options.timestamps = timestamps;
  auto made = Renderer::create(options);
  EXPECT_TRUE(made) << made.error().message;
  return made ? std::move(*made) : nullptr;
}

// Ground with a box on it.
struct Scene {
  explicit Scene(Renderer& renderer) : renderer_(renderer) {
    using synthetic::kGroundSide;
    const auto grid = renderer.upload_shared_indices(synthetic::grid_indices(kGroundSide));
    const auto ground =
        synthetic::make_terrain(renderer.geometry(), kGroundSide, [](int, int) { return 0.0F; });
    const auto box = synthetic::make_box(renderer.geometry(), glm::vec3(0.5F));
    EXPECT_TRUE(grid && ground && box);
    terrain_.range = *ground;
    terrain_.shared_indices = *grid;
    terrain_.origin = {-320.0F, -10.0F, -320.0F};
    terrain_.cell_m = 10.0F;
    terrain_.height_range_m = 100.0F;
    model_.range = *box;
    model_.origin = {0, -10, -30};
    model_.box_half_extent = glm::vec3(4);
  }
  FrameResult draw() {
    FrameInput input = synthetic::look(10.0, 0.0, renderer_.size());
    input.terrain = std::span(&terrain_, 1);
    input.models = std::span(&model_, 1);
    return renderer_.render(input).value();
  }

 private:
  Renderer& renderer_;
  TerrainDraw terrain_;
  MeshDraw model_;
};

class GpuTimerTest : public testing::TestWithParam<std::tuple<Preset, RenderPath>> {};

TEST_P(GpuTimerTest, AFrameGetsItsDeviceTimeFourFramesLater) {
  const auto [preset, path] = GetParam();
  const auto renderer = make(preset, path);
  ASSERT_TRUE(renderer->device().timestamps);
  Scene scene(*renderer);
  std::set<std::uint64_t> frames;
  const double start_s = core::monotonic_seconds();
  for (int i = 0; i < 12; ++i) {
    const FrameResult result = scene.draw();
    EXPECT_EQ(result.gpu.has_value(), i >= 4) << i;
    if (!result.gpu) continue;
    EXPECT_EQ(result.gpu->frame + 4, result.frame);
    EXPECT_GT(result.gpu->ms, 0.0);
    EXPECT_GE(result.gpu->submitted_s, start_s);
    // It was done after it was submitted and is over, so it took no longer than has passed since.
    EXPECT_LE(result.gpu->ms, (core::monotonic_seconds() - result.gpu->submitted_s) * 1e3);
    frames.insert(result.gpu->frame);
  }
  EXPECT_EQ(frames.size(), 8u);
  renderer->wait_idle();
  for (const std::string& message : renderer->validation_messages())
    ADD_FAILURE() << message;
}

TEST_P(GpuTimerTest, ShadowsAreAPartOfItWhereThereAreAny) {
  const auto [preset, path] = GetParam();
  const auto renderer = make(preset, path);
  Scene scene(*renderer);
  FrameResult result;
  for (int i = 0; i < 6; ++i)
    result = scene.draw();
  ASSERT_TRUE(result.gpu);
  EXPECT_EQ(result.gpu->shadows_ms > 0, renderer->casts_shadows());
  EXPECT_LE(result.gpu->shadows_ms, result.gpu->ms);
}

INSTANTIATE_TEST_SUITE_P(PresetsAndPaths, GpuTimerTest,
                         testing::Combine(testing::Values(Preset::kLow, Preset::kHigh),
                                          testing::Values(RenderPath::kCpu, RenderPath::kGpu)),
                         [](const auto& suite) {
                           const bool low = std::get<0>(suite.param) == Preset::kLow;
                           const bool cpu = std::get<1>(suite.param) == RenderPath::kCpu;
                           return std::string(low ? "low_" : "high_") + (cpu ? "cpu" : "gpu");
                         });

TEST(GpuTimer, WithoutTimestampsEverythingGoesOnWithoutItsTime) {
  const auto renderer = make(Preset::kLow, RenderPath::kCpu, false);
  EXPECT_FALSE(renderer->device().timestamps);
  Scene scene(*renderer);
  for (int i = 0; i < 6; ++i)
    EXPECT_FALSE(scene.draw().gpu);
}

TEST(GpuTimer, MeasuresPassesOnRequestAsPartsOfTheFrame) {
  for (const RenderPath path : {RenderPath::kCpu, RenderPath::kGpu}) {
    RendererOptions options;
    options.validation = true;
    options.size = {320, 240};
    options.geometry_budget_bytes = 8 << 20;
    options.preset = Preset::kHigh;
    options.path = path;
    options.pass_times = true;
    const auto made = Renderer::create(options);
    ASSERT_TRUE(made) << made.error().message;
    Renderer& renderer = **made;
    ASSERT_TRUE(renderer.device().pass_times);
    Scene scene(renderer);
    FrameResult result;
    for (int i = 0; i < 8; ++i)
      result = scene.draw();
    ASSERT_TRUE(result.gpu);
    double sum_ms = 0;
    for (const double ms : result.gpu->pass_ms) {
      EXPECT_GE(ms, 0.0);
      sum_ms += ms;
    }
    EXPECT_GT(result.gpu->pass_ms[1], 0.0) << kPassNames[1];
    EXPECT_LE(sum_ms, result.gpu->ms * 1.0001);
    EXPECT_EQ(result.gpu->pass_ms[0], result.gpu->shadows_ms) << "both end with the cascades";
    renderer.wait_idle();
    for (const std::string& message : renderer.validation_messages())
      ADD_FAILURE() << message;
  }
}

TEST(GpuTimer, DoesNotMeasurePassesOfSoftwareDevicesUnasked) {
  const auto renderer = make(Preset::kLow, RenderPath::kCpu);
  EXPECT_EQ(renderer->device().pass_times, !renderer->device().software());
}

TEST(FrameResult, TellsTheDeviceMemoryAndWhenTheFrameWasHandedOver) {
  const auto renderer = make(Preset::kLow, RenderPath::kCpu);
  Scene scene(*renderer);
  ASSERT_TRUE(renderer->resize({640, 480}));  // its targets share no blocks of memory
  const double start_s = core::monotonic_seconds();
  const FrameResult first = scene.draw(), second = scene.draw();
  EXPECT_GE(first.handed_over_s, start_s);
  EXPECT_GT(second.handed_over_s, first.handed_over_s);
  EXPECT_LE(second.handed_over_s, core::monotonic_seconds());
  EXPECT_GT(second.memory_bytes, std::uint64_t{8} << 20) << "more than the geometry";
  ASSERT_TRUE(renderer->resize({1280, 960}));
  EXPECT_GT(scene.draw().memory_bytes, second.memory_bytes) << "larger targets";
  ASSERT_TRUE(renderer->resize({64, 48}));
  EXPECT_LT(scene.draw().memory_bytes, second.memory_bytes) << "freed memory does not count";
}

}  // namespace
}  // namespace psygen::render
