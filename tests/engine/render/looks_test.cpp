// Presets and views on one small scene with water: stored pictures, and what they have in common.
#include <gtest/gtest.h>

#include "engine/image/compare.hpp"
#include "engine/render/preset.hpp"
#include "shaders/shared.h"
#include "tests/engine/render/synthetic_scene.hpp"
#include "tests/engine/render/ways.hpp"
#include "tests/golden_image.hpp"

namespace psygen::render {
namespace {

using synthetic::kGroundSide;
using synthetic::kPictureSize;

class Looks : public testing::Test {
 protected:
  void open(Preset preset, GroundPicture forest_floor = {}) {
    RendererOptions options;
    options.ground[1] = std::move(forest_floor);
    options.validation = true;
    options.size = kPictureSize;
    options.geometry_budget_bytes = 8 << 20;
    options.preset = preset;
    auto made = Renderer::create(options);
    ASSERT_TRUE(made) << made.error().message;
    renderer_ = std::move(*made);
    const auto grid = renderer_->upload_shared_indices(synthetic::grid_indices(kGroundSide));
    const auto hills =
        synthetic::make_terrain(renderer_->geometry(), kGroundSide, [](int x, int z) {
          return 0.5F + 0.25F * std::sin(0.35F * static_cast<float>(x)) *
                            std::cos(0.28F * static_cast<float>(z));
        });
    const auto box = synthetic::make_box(renderer_->geometry(), {0.4F, 0.1F, 0.05F});
    ASSERT_TRUE(grid && hills && box);
    terrain_.range = *hills;
    terrain_.shared_indices = *grid;
    terrain_.origin = {-320.0F, -90.0F, -600.0F};
    terrain_.cell_m = 10.0F;
    terrain_.height_range_m = 80.0F;
    terrain_.debug_colour = 0x20C040;
    box_.range = *box;
    box_.origin = {8.0F, -42.0F, -110.0F};
    box_.box_centre = {0, 12, 0};
    box_.box_half_extent = {6, 12, 6};
    box_.debug_colour = 0xE03020;
    input_ = synthetic::look(60.0, -0.3, kPictureSize);
    input_.terrain = {&terrain_, 1};
    input_.models = {&box_, 1};
    input_.light.haze_density = 0.0004F;
    input_.block_size_m = 64;
    input_.water = WaterPlane{3.0F, {0.01F, 0.045F, 0.05F}};
  }
  void TearDown() override {
    if (!renderer_) return;
    renderer_->wait_idle();
    for (const std::string& message : renderer_->validation_messages())
      ADD_FAILURE() << message;
  }
  image::Image draw() {
    const auto drawn = renderer_->render(input_);
    EXPECT_TRUE(drawn) << drawn.error().message;
    auto picture = renderer_->capture();
    EXPECT_TRUE(picture);
    if (!picture) return {};
    return {picture->width, picture->height, std::move(picture->rgba)};
  }
  static void expect_golden(const image::Image& image, const std::string& name) {
    psygen::expect_golden("tests/engine/render/golden", name, image);
  }

  std::unique_ptr<Renderer> renderer_;
  TerrainDraw terrain_;
  MeshDraw box_;
  FrameInput input_;
};

class LooksOfPresets : public Looks, public testing::WithParamInterface<Preset> {};

TEST_P(LooksOfPresets, AreAsTheyWereAndTheSameTwice) {
  open(GetParam());
  const image::Image first = draw();
  EXPECT_EQ(draw().rgba, first.rgba);
  expect_golden(first, std::string("preset_") + std::string(to_string(GetParam())));
}

TEST_P(LooksOfPresets, SurviveACameraUnderWaterAndASunBelowTheHorizon) {
  open(GetParam());
  input_.water->level_m = 100.0F;
  const image::Image drowned = draw();
  EXPECT_GT(drowned.rgba[2], drowned.rgba[0]) << "it is bluer than red there";
  input_.water.reset();
  input_.light.sun_direction = {0.5F, -0.2F, 0.1F};
  draw();
}

// Red, green and blue of all pixels below the middle.
double light_below(const image::Image& image) {
  double sum = 0;
  for (std::size_t i = image.rgba.size() / 2; i < image.rgba.size(); ++i)
    sum += i % 4 < 3 ? image.rgba[i] : 0;
  return sum;
}

TEST_P(LooksOfPresets, NearGroundHasDetailAroundTheColourThatItHasWithout) {
  open(GetParam());
  input_.water.reset();
  input_.models = {};
  terrain_.origin.y = -52.0F;  // 4 to 44 m below the camera
  const image::Image far = draw();
  terrain_.near = true;
  const image::Image near = draw();
  EXPECT_NEAR(light_below(near), light_below(far), 0.04 * light_below(far));
  EXPECT_EQ(near.rgba == far.rgba, traits_of(GetParam()).fine_grain) << "which has it anywhere";
  expect_golden(near, std::string("near_ground_") + std::string(to_string(GetParam())));
}

// Red, green and blue of all pixels.
double light_of(const image::Image& image) {
  double sum = 0;
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    sum += i % 4 < 3 ? image.rgba[i] : 0;
  return sum;
}

TEST_P(LooksOfPresets, StoneAndBarkHaveDetailAroundTheColourThatTheyHaveWithout) {
  open(GetParam());
  input_.terrain = {};
  input_.water.reset();
  box_.origin = {3.0F, -6.0F, -24.0F};
  box_.box_half_extent = {9, 12, 2};
  const image::Image plain = draw();
  image::Image stone;
  for (const auto surface : {core::SurfaceKind::kStone, core::SurfaceKind::kBark}) {
    box_.surface = surface;
    box_.near = false;
    EXPECT_EQ(draw().rgba != plain.rgba, traits_of(GetParam()).pixel_light);
    box_.near = true;
    const image::Image detailed = draw();
    EXPECT_NE(detailed.rgba, plain.rgba);
    EXPECT_NE(detailed.rgba, stone.rgba);
    EXPECT_NEAR(light_of(detailed), light_of(plain), 0.05 * light_of(plain));
    stone = detailed;
  }
  box_.origin.z = -400.0F;
  const image::Image far = draw();
  box_.surface = core::SurfaceKind::kPlain;
  EXPECT_EQ(draw().rgba, far.rgba) << "out of reach";
}

TEST_P(LooksOfPresets, NearLeavesOfTreesHaveGapsAlsoWhileTheyFade) {
  open(GetParam());
  input_.terrain = {};
  input_.water.reset();
  input_.models = {};
  const image::Image sky = draw();
  const auto leaf = synthetic::make_box(renderer_->geometry(), {0.1F, 0.4F, 0.05F}, 1);
  ASSERT_TRUE(leaf);
  box_.range = *leaf;
  box_.origin = {0.0F, -2.0F, -8.0F};
  box_.box_centre = {0, 0, 0};
  box_.box_half_extent = {3, 2, 0.01F};
  input_.models = {&box_, 1};
  const std::size_t whole = image::compare(sky, draw(), 0).pixels_over;
  box_.surface = core::SurfaceKind::kBark;
  box_.near = true;
  const std::size_t open_ = image::compare(sky, draw(), 0).pixels_over;
  EXPECT_GT(whole, 1000u);
  EXPECT_LT(static_cast<double>(open_), 0.95 * static_cast<double>(whole));
  EXPECT_GT(static_cast<double>(open_), 0.4 * static_cast<double>(whole));
  box_.fade = 0.5F;
  const std::size_t fading = image::compare(sky, draw(), 0).pixels_over;
  EXPECT_NEAR(static_cast<double>(fading), 0.5 * static_cast<double>(open_),
              0.1 * static_cast<double>(open_));
  box_.near = false;
  const std::size_t far = image::compare(sky, draw(), 0).pixels_over;
  EXPECT_EQ(far > fading, !traits_of(GetParam()).pixel_light);
}

TEST_P(LooksOfPresets, SpotsDarkenNearGroundAndNothingElse) {
  open(GetParam());
  input_.models = {};
  const GroundSpot under_far_ground{{0, -20}, 30, 0.9F, 0.9F};
  const image::Image high_up = draw();
  input_.spots = {&under_far_ground, 1};
  if (!traits_of(GetParam()).fine_grain) {  // with it all ground in reach has spots
    EXPECT_EQ(draw().rgba, high_up.rgba) << "no ground is near";
  }
  input_.water.reset();
  terrain_.origin.y = -52.0F;
  terrain_.near = true;
  const image::Image spotted = draw();
  input_.spots = {};
  EXPECT_LT(light_below(spotted), 0.97 * light_below(draw()));
}

INSTANTIATE_TEST_SUITE_P(Presets, LooksOfPresets,
                         testing::ValuesIn(std::vector<Preset>{Preset::kLow, Preset::kMedium,
                                                               Preset::kHigh, Preset::kUltra}),
                         [](const auto& test) { return std::string(to_string(test.param)); });

class LooksOfViews : public Looks, public testing::WithParamInterface<View> {};

TEST_P(LooksOfViews, AreAsTheyWere) {
  open(Preset::kLow);
  const Line line{{-20, -5, -50}, {20, 15, -50}, {1, 1, 0}};
  if (GetParam() == View::kBounds) input_.lines = {&line, 1};
  const image::Image normal = draw();
  input_.view = GetParam();
  const image::Image view = draw();
  EXPECT_EQ(view.rgba == normal.rgba, GetParam() == View::kBounds);
  expect_golden(view, std::string("view_") + std::string(to_string(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(Views, LooksOfViews,
                         testing::Values(View::kLevels, View::kLayers, View::kBounds,
                                         View::kWireframe, View::kMissing),
                         [](const auto& test) { return std::string(to_string(test.param)); });

TEST_F(Looks, LeavesOfTreesAreNoPictureOfTheForestFloor) {
  const auto leaves = [&](GroundPicture forest_floor) {
    renderer_.reset();
    open(Preset::kHigh, std::move(forest_floor));
    input_.terrain = {};
    const auto leaf = synthetic::make_box(renderer_->geometry(), {0.1F, 0.4F, 0.05F}, 1);
    EXPECT_TRUE(leaf);
    if (leaf) box_.range = *leaf;
    box_.origin.z = -30.0F;
    box_.surface = core::SurfaceKind::kBark;
    return draw();
  };
  GroundPicture stripes;
  stripes.rgb.resize(std::size_t{PSYGEN_GROUND_SIDE} * PSYGEN_GROUND_SIDE * 3);
  for (std::size_t i = 0; i < stripes.rgb.size(); ++i)
    stripes.rgb[i] = i / 12 % 2 == 0 ? 0.2F : 0.8F;
  EXPECT_EQ(leaves(stripes).rgba, leaves({}).rgba);
}

TEST_F(Looks, LinesAreSeenAndDoNotStay) {
  open(Preset::kLow);
  const image::Image without = draw();
  const Line line{{-20, 5, -50}, {20, 5, -50}, {1, 1, 0}};
  input_.lines = {&line, 1};
  EXPECT_NE(draw().rgba, without.rgba);
  input_.lines = {};
  EXPECT_EQ(draw().rgba, without.rgba);
}

TEST_F(Looks, TerrainEndsAtTheEdgeOfTheWorld) {
  open(Preset::kLow);
  input_.water.reset();
  const image::Image whole = draw();
  input_.edge.least = {-320.0F, -600.0F};
  input_.edge.greatest = {320.0F, 40.0F};
  EXPECT_EQ(draw().rgba, whole.rgba) << "an edge that nothing reaches over";
  input_.edge.greatest.x = 0.0F;
  EXPECT_NE(draw().rgba, whole.rgba);
}

TEST_F(Looks, FarForestsDarkenTheGroundThatCanBearThem) {
  open(Preset::kLow);
  input_.water.reset();
  input_.models = {};
  const auto green = [](const image::Image& image) {
    const std::size_t last_row = image.rgba.size() - 4 * kPictureSize.width;
    int sum = 0;
    for (std::size_t i = last_row; i < image.rgba.size(); i += 4)
      sum += image.rgba[i + 1];
    return sum;
  };
  const image::Image bare = draw();
  terrain_.cover = 1.0F;
  const image::Image covered = draw();
  EXPECT_LT(green(covered), green(bare) * 9 / 10);
  input_.canopy.highest_m = -200.0F;
  EXPECT_EQ(draw().rgba, bare.rgba);
}

TEST(Presets, HaveNamesThatAreReadBack) {
  for (const char* name : {"low", "medium", "high", "ultra"})
    EXPECT_EQ(to_string(preset_from(name).value()), name);
  EXPECT_FALSE(preset_from("best"));
  View view = View::kNormal;
  for (int i = 0; i < 7; ++i) {
    EXPECT_EQ(view_from(to_string(view)).value(), view);
    view = next_view(view);
  }
  EXPECT_EQ(view, View::kNormal);
  EXPECT_FALSE(view_from(""));
}

}  // namespace
}  // namespace psygen::render
