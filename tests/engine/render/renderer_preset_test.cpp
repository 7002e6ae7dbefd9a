// Another preset at run time, and what is shown while the renderer is made.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "engine/render/preset.hpp"
#include "tests/engine/render/synthetic_scene.hpp"

namespace psygen::render {
namespace {

using synthetic::kGroundSide;
using synthetic::kPictureSize;
constexpr std::array kPresets{Preset::kLow, Preset::kMedium, Preset::kHigh, Preset::kUltra};

RendererOptions small(RenderPath path) {
  RendererOptions options;
  options.validation = true;
  options.size = kPictureSize;
  options.geometry_budget_bytes = 8 << 20;
  options.path = path;
  return options;
}

class RendererPreset : public testing::TestWithParam<RenderPath> {
 protected:
  // A renderer with hills, water, and a box that casts a shadow.
  struct Scene {
    std::unique_ptr<Renderer> renderer;
    TerrainDraw hills;
    MeshDraw box;

    explicit Scene(const RendererOptions& options) {
      auto made = Renderer::create(options);
      EXPECT_TRUE(made) << made.error().message;
      if (!made) return;
      renderer = std::move(*made);
      const auto grid = renderer->upload_shared_indices(synthetic::grid_indices(kGroundSide));
      const auto ground = synthetic::make_terrain(
          renderer->geometry(), kGroundSide,
          [](int x, int z) { return 0.5F + 0.25F * std::sin(0.1F * static_cast<float>(x * z)); });
      const auto cube = synthetic::make_box(renderer->geometry(), {0.4F, 0.1F, 0.05F});
      EXPECT_TRUE(grid && ground && cube);
      hills.range = *ground;
      hills.shared_indices = *grid;
      hills.origin = {-320.0F, -90.0F, -600.0F};
      hills.cell_m = 10.0F;
      hills.height_range_m = 80.0F;
      box.range = *cube;
      box.origin = {8.0F, -42.0F, -110.0F};
      box.box_centre = {0, 12, 0};
      box.box_half_extent = {6, 12, 6};
    }
    ~Scene() {
      if (!renderer) return;
      renderer->wait_idle();
      for (const std::string& message : renderer->validation_messages())
        ADD_FAILURE() << message;
    }

    // Twice, so that the device knows what was seen in the frame before.
    std::vector<std::uint8_t> draw() {
      FrameInput input = synthetic::look(60.0, -0.3, kPictureSize);
      input.terrain = {&hills, 1};
      input.models = {&box, 1};
      input.block_size_m = 64;
      input.water = WaterPlane{3.0F, {0.01F, 0.045F, 0.05F}};
      for (int i = 0; i < 2; ++i) {
        const auto drawn = renderer->render(input);
        EXPECT_TRUE(drawn) << drawn.error().message;
      }
      const auto picture = renderer->capture();
      EXPECT_TRUE(picture) << picture.error().message;
      return picture ? picture->rgba : std::vector<std::uint8_t>{};
    }
  };
};

TEST_P(RendererPreset, AfterAChangeDrawsLikeOneFromTheStart) {
  std::array<std::vector<std::uint8_t>, kPresets.size()> expected;
  for (const Preset preset : kPresets) {
    RendererOptions options = small(GetParam());
    options.preset = preset;
    expected[static_cast<std::size_t>(preset)] = Scene(options).draw();
  }
  EXPECT_NE(expected[0], expected[2]);
  RendererOptions options = small(GetParam());
  options.preset = Preset::kLow;
  Scene scene(options);
  EXPECT_EQ(scene.renderer->preset(), Preset::kLow);
  EXPECT_FALSE(scene.renderer->casts_shadows());
  for (const Preset preset : {Preset::kHigh, Preset::kHigh, Preset::kMedium, Preset::kUltra,
                              Preset::kLow, Preset::kUltra, Preset::kHigh}) {
    const auto changed = scene.renderer->set_preset(preset);
    ASSERT_TRUE(changed) << changed.error().message;
    EXPECT_EQ(scene.renderer->preset(), preset);
    EXPECT_EQ(scene.renderer->casts_shadows(), traits_of(preset).cascades > 0);
    EXPECT_EQ(scene.draw(), expected[static_cast<std::size_t>(preset)]) << to_string(preset);
  }
  EXPECT_TRUE(scene.renderer->replay_floor_ms(1));
}

TEST_P(RendererPreset, HasNoPictureUntilTheNextFrameAndKeepsTheSize) {
  Scene scene(small(GetParam()));
  scene.draw();
  ASSERT_TRUE(scene.renderer->resize({97, 61}));
  ASSERT_TRUE(scene.renderer->set_preset(Preset::kUltra));
  EXPECT_EQ(scene.renderer->size(), (core::Extent{97, 61}));
  EXPECT_FALSE(scene.renderer->capture());
  EXPECT_FALSE(scene.renderer->replay_floor_ms(1));
  EXPECT_FALSE(scene.renderer->drawn_meshes());
  EXPECT_EQ(scene.draw().size(), 97u * 61 * 4);
}

TEST_P(RendererPreset, ThatIsGivenUpLeavesTheOldOneAsItWas) {
  RendererOptions options = small(GetParam());
  options.preset = Preset::kMedium;
  Scene scene(options);
  const auto before = scene.draw();
  for (const double until : {0.0, 0.2, 0.6, 0.95}) {
    const auto refused = scene.renderer->set_preset(Preset::kUltra, [&](double fraction) {
      EXPECT_TRUE(scene.renderer->show(std::vector{TextPanel{Anchor::kMiddle, {{"wait"}}}}));
      EXPECT_FALSE(scene.renderer->replay_floor_ms(1)) << "a text is no frame to draw again";
      return fraction < until;
    });
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, core::ErrorCode::kInterrupted);
    EXPECT_EQ(scene.renderer->preset(), Preset::kMedium);
    EXPECT_FALSE(scene.renderer->casts_shadows());
    EXPECT_EQ(scene.draw(), before) << "given up after " << until;
  }
}

TEST_P(RendererPreset, ShowsHowFarItIsWhileItIsMade) {
  RendererOptions options = small(GetParam());
  options.preset = Preset::kHigh;
  std::vector<double> fractions;
  std::vector<std::size_t> shades;
  options.progress = [&](Renderer& renderer, double fraction) {
    fractions.push_back(fraction);
    const TextPanel panel{Anchor::kMiddle, {{"", {}, static_cast<float>(fraction)}}};
    EXPECT_TRUE(renderer.show({&panel, 1}));
    const auto picture = renderer.capture();
    EXPECT_TRUE(picture);
    const auto pixel = [&](std::size_t i) { return picture->rgba[4 * i + 2]; };
    const std::uint8_t ground = pixel(0);
    std::size_t lighter = 0;
    for (std::size_t i = 0; i < picture->rgba.size() / 4; ++i)
      lighter += pixel(i) > 2 * ground + 100 ? 1 : 0;
    shades.push_back(lighter);
    return true;
  };
  Scene scene(options);
  ASSERT_GT(fractions.size(), 20u);
  EXPECT_EQ(fractions.front(), 0);
  EXPECT_EQ(fractions.back(), 1);
  EXPECT_TRUE(std::ranges::is_sorted(fractions));
  EXPECT_EQ(shades.front(), 0u);
  EXPECT_TRUE(std::ranges::is_sorted(shades));
  EXPECT_GT(shades.back(), 500u);
  options.progress = {};
  EXPECT_EQ(scene.draw(), Scene(options).draw());
}

TEST_P(RendererPreset, CanBeGivenUpWhileItIsMade) {
  for (const double until : {0.0, 0.5}) {
    RendererOptions options = small(GetParam());
    options.progress = [until](Renderer&, double fraction) { return fraction < until; };
    const auto made = Renderer::create(options);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, core::ErrorCode::kInterrupted);
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, RendererPreset, testing::Values(RenderPath::kCpu, RenderPath::kGpu),
                         [](const auto& test) {
                           return test.param == RenderPath::kCpu ? "cpu" : "gpu";
                         });

TEST(Presets, ComeOneAfterTheOtherAndThenTheFirstAgain) {
  Preset preset = Preset::kLow;
  for (const Preset expected : {Preset::kMedium, Preset::kHigh, Preset::kUltra, Preset::kLow}) {
    preset = next_preset(preset);
    EXPECT_EQ(preset, expected);
  }
}

}  // namespace
}  // namespace psygen::render
