#include "engine/render/renderer.hpp"

#include <gtest/gtest.h>

#include <array>

#include "engine/core/clock.hpp"
#include "tests/engine/render/synthetic_scene.hpp"
#include "tests/engine/render/ways.hpp"

namespace psygen::render {
namespace {

using synthetic::kGroundSide;
using synthetic::kPictureSize;

struct Pixel {
  int r, g, b;
  int sum() const { return r + g + b; }
};

Pixel at(const Picture& picture, std::uint32_t x, std::uint32_t y) {
  const std::size_t i = (std::size_t{y} * picture.width + x) * 4;
  return {picture.rgba[i], picture.rgba[i + 1], picture.rgba[i + 2]};
}

// A headless renderer with validation: every test ends with "validation had nothing to say".
class RendererTest : public testing::TestWithParam<Submission> {
 protected:
  void SetUp() override {
    RendererOptions options;
    options.validation = true;
    options.size = kPictureSize;
    options.geometry_budget_bytes = 8 << 20;
    options.submission = GetParam();
    auto made = Renderer::create(options);
    ASSERT_TRUE(made) << made.error().message;
    renderer_ = std::move(*made);
    const auto grid = renderer_->upload_shared_indices(synthetic::grid_indices(kGroundSide));
    ASSERT_TRUE(grid);
    grid_ = *grid;
  }
  void TearDown() override {
    if (!renderer_) return;
    renderer_->wait_idle();
    expect_no_messages();
  }
  void expect_no_messages() {
    for (const std::string& message : renderer_->validation_messages())
      ADD_FAILURE() << message;
  }

  // Flat ground of 640 m around the camera, which stands 10 m above it.
  void add_ground(float level = 0.0F) {
    const auto range = synthetic::make_terrain(renderer_->geometry(), kGroundSide,
                                               [=](int, int) { return level; });
    ASSERT_TRUE(range);
    TerrainDraw draw;
    draw.range = *range;
    draw.shared_indices = grid_;
    draw.origin = {-320.0F, -10.0F, -320.0F};
    draw.cell_m = 10.0F;
    draw.height_range_m = 100.0F;
    terrain_.push_back(draw);
  }
  void add_box(glm::vec3 foot, float size_m, glm::vec3 albedo) {
    const auto range = synthetic::make_box(renderer_->geometry(), albedo);
    ASSERT_TRUE(range);
    MeshDraw draw;
    draw.range = *range;
    draw.origin = foot;
    draw.box_centre = {0, size_m / 2, 0};
    draw.box_half_extent = glm::vec3(size_m / 2);
    models_.push_back(draw);
  }
  FrameInput input(double pitch = 0.0) {
    FrameInput made = synthetic::look(10.0, pitch, renderer_->size());
    made.terrain = terrain_;
    made.models = models_;
    made.light.haze_density = 0.0004F;
    return made;
  }
  Picture draw(const FrameInput& frame) {
    const auto result = renderer_->render(frame);
    EXPECT_TRUE(result) << result.error().message;
    auto picture = renderer_->capture();
    EXPECT_TRUE(picture) << picture.error().message;
    return picture ? *picture : Picture{};
  }

  std::unique_ptr<Renderer> renderer_;
  std::uint32_t grid_ = 0;
  std::vector<TerrainDraw> terrain_;
  std::vector<MeshDraw> models_;
};

TEST_P(RendererTest, ShowsSkyAboveTheHorizonAndGroundBelowIt) {
  add_ground();
  const Picture picture = draw(input());
  ASSERT_EQ(picture.width, kPictureSize.width);
  ASSERT_EQ(picture.rgba.size(), std::size_t{kPictureSize.width} * kPictureSize.height * 4);
  for (const std::uint32_t x : {10u, 80u, 150u}) {
    const Pixel sky = at(picture, x, 8);
    const Pixel ground = at(picture, x, kPictureSize.height - 8);
    EXPECT_GT(sky.b, sky.r) << "the sky is blue";
    EXPECT_GT(ground.g, ground.b) << "the ground is green";
    EXPECT_GT(sky.sum(), ground.sum());
  }
}

TEST_P(RendererTest, CountsItsDraws) {
  add_ground();
  add_box({0, -10, -30}, 8, {0.5F, 0.1F, 0.1F});
  const auto result = renderer_->render(input());
  ASSERT_TRUE(result);
  EXPECT_EQ(result->draws, 2u);
  EXPECT_EQ(result->triangles, 64u * 64 * 2 + 12);
  EXPECT_TRUE(result->presented);
  EXPECT_GE(result->cpu_ms, 0.0);
}

TEST_P(RendererTest, DrawsABoxAtItsPlaceAndHidesMeshesBehindIt) {
  add_ground();
  const Picture before = draw(input());
  add_box({0, -10, -30}, 12, {0.6F, 0.02F, 0.02F});  // 12 m wide, 30 m ahead
  add_box({0, -10, -60}, 12, {0.02F, 0.02F, 0.6F});  // behind it, given later
  add_box({-300, -10, 50}, 12, {0.9F, 0.9F, 0.9F});  // behind the camera
  const Picture after = draw(input());
  const Pixel middle = at(after, kPictureSize.width / 2, kPictureSize.height / 2 + 20);
  EXPECT_GT(middle.r, 2 * middle.b);
  EXPECT_GT(middle.r, 2 * middle.g);
  EXPECT_EQ(at(after, 5, 5).sum(), at(before, 5, 5).sum());
  // The near face is 12 m at 24 m: 2 · 6 / 24 / tan(0.45) of half the height.
  int red = 0;
  for (std::uint32_t x = 0; x < kPictureSize.width; ++x)
    red += at(after, x, kPictureSize.height / 2 + 20).r >
           2 * at(after, x, kPictureSize.height / 2 + 20).g;
  const double expected = 6.0 / 24.0 / std::tan(0.45) * kPictureSize.height;
  EXPECT_NEAR(red, expected, 2.0);
}

TEST_P(RendererTest, DrawsTheSamePictureAgainFromTheSameInput) {
  add_ground();
  add_box({3, -10, -40}, 9, {0.3F, 0.3F, 0.1F});
  const Picture first = draw(input(0.1));
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(draw(input(0.1)).rgba, first.rgba);
}

TEST_P(RendererTest, FollowsAChangeOfSize) {
  add_ground();
  draw(input());
  ASSERT_TRUE(renderer_->resize({97, 61}));
  EXPECT_FALSE(renderer_->capture()) << "no frame of this size yet";
  const Picture picture = draw(input());
  EXPECT_EQ(picture.width, 97u);
  EXPECT_EQ(picture.height, 61u);
  EXPECT_GT(at(picture, 50, 3).b, at(picture, 50, 3).r);
  EXPECT_GT(at(picture, 50, 58).g, at(picture, 50, 58).b);
  EXPECT_FALSE(renderer_->resize({0, 0}));
}

TEST_P(RendererTest, MeltsFarGroundIntoTheSkyAtTheHorizon) {
  add_ground();
  FrameInput hazy = input();
  hazy.light.haze_density = 0.08F;
  hazy.light.haze_height_falloff = 0.0F;
  const Picture picture = draw(hazy);
  for (std::uint32_t x = 4; x < kPictureSize.width; x += 12) {
    const Pixel above = at(picture, x, kPictureSize.height / 2 - 2);
    const Pixel below = at(picture, x, kPictureSize.height / 2 + 2);
    EXPECT_LE(std::abs(above.r - below.r), 3);
    EXPECT_LE(std::abs(above.g - below.g), 3);
    EXPECT_LE(std::abs(above.b - below.b), 3);
  }
}

TEST_P(RendererTest, ColoursTheGroundByHeightAndSlope) {
  FrameInput frame = input(-0.6);
  add_ground(0.0F);
  frame = input(-0.6);
  frame.palette.snow_start_m = 50;
  frame.palette.snow_blend_m = 1;
  const Pixel meadow = at(draw(frame), kPictureSize.width / 2, kPictureSize.height / 2);
  terrain_.front().height_min_m = 100;
  terrain_.front().origin.y -= 100;
  frame = input(-0.6);
  frame.pose.position.local.y = 110;
  frame.palette.snow_start_m = 50;
  frame.palette.snow_blend_m = 1;
  const Pixel snow = at(draw(frame), kPictureSize.width / 2, kPictureSize.height / 2);
  EXPECT_GT(meadow.g, meadow.b + 20);
  EXPECT_GT(snow.b, 150);
  EXPECT_GT(snow.sum(), meadow.sum() + 150);
}

TEST_P(RendererTest, SwaysLeavesWithTheTimeAndNothingElse) {
  add_ground();
  add_box({0, -10, -30}, 12, {0.6F, 0.02F, 0.02F});
  FrameInput frame = input();
  frame.light.cloud_cover = 0.0F;
  const Picture still = draw(frame);
  frame.light.time_seconds = 1.0F;
  const Picture later = draw(frame);
  const std::size_t half = still.rgba.size() / 2;
  EXPECT_TRUE(std::equal(still.rgba.begin() + static_cast<std::ptrdiff_t>(half), still.rgba.end(),
                         later.rgba.begin() + static_cast<std::ptrdiff_t>(half)))
      << "a box without sway stands still";
}

TEST_P(RendererTest, WritesAPanelIntoItsCornerOnly) {
  add_ground();
  const Picture plain = draw(input());
  const TextPanel panel{Anchor::kTopLeft, {{"16.7 ms"}, {"123 draws"}}};
  FrameInput frame = input();
  frame.panels = {&panel, 1};
  const Picture written = draw(frame);
  int changed_left = 0, changed_right = 0;
  for (std::uint32_t y = 0; y < kPictureSize.height; ++y) {
    for (std::uint32_t x = 0; x < kPictureSize.width; ++x) {
      if (at(plain, x, y).sum() == at(written, x, y).sum()) continue;
      (x < 100 && y < 60 ? changed_left : changed_right)++;
    }
  }
  EXPECT_GT(changed_left, 500);
  EXPECT_EQ(changed_right, 0);
}

TEST_P(RendererTest, RefusesCamerasThatCannotBeDrawnAndDrawsTheNextValidOne) {
  add_ground();
  const Picture good = draw(input(0.05));
  FrameInput bad = input(0.05);
  bad.pose.position.local.y = std::nan("");
  auto refused = renderer_->render(bad);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::ErrorCode::kInvalidArgument);
  EXPECT_EQ(refused.error().message, "the pose of a frame is not finite, or is beyond all worlds");
  bad = input(0.05);
  bad.projection.vertical_fov = -1.0F;
  refused = renderer_->render(bad);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "the projection of a frame is not one that can be drawn");
  EXPECT_EQ(draw(input(0.05)).rgba, good.rgba);
}

TEST_P(RendererTest, ReplaysTheLastFrameAsItsFloor) {
  EXPECT_FALSE(renderer_->replay_floor_ms(1)) << "no frame yet";
  add_ground();
  const Picture before = draw(input());
  const auto floor = renderer_->replay_floor_ms(3);
  ASSERT_TRUE(floor) << floor.error().message;
  EXPECT_GT(*floor, 0.0);
  const auto after = renderer_->capture();
  ASSERT_TRUE(after);
  EXPECT_EQ(after->rgba, before.rgba);
}

TEST_P(RendererTest, HoldsMoreDrawsThanItsFirstBuffers) {
  add_ground();
  add_box({0, -10, -30}, 4, {0.5F, 0.5F, 0.5F});
  models_.resize(5000, models_.front());
  models_.back().origin = {6, -10, -30};
  models_.back().range = models_.front().range;
  const auto result = renderer_->render(input());
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->draws, 5001u);
  const auto picture = renderer_->capture();
  ASSERT_TRUE(picture);
  // The last draw found its own data: there is a box at 6 m to the right of the middle.
  const double x = kPictureSize.width / 2.0 + 6.0 / 28.0 / std::tan(0.45) * kPictureSize.height / 2;
  const Pixel box = at(*picture, static_cast<std::uint32_t>(x), kPictureSize.height / 2 + 30);
  EXPECT_LT(std::abs(box.g - box.r), 40);
  EXPECT_GT(box.sum(), 100);
}

TEST_P(RendererTest, RefusesIndexListsThatDoNotFit) {
  const std::vector<std::uint16_t> large(3u << 20);
  const auto refused = renderer_->upload_shared_indices(large);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::ErrorCode::kOutOfMemory);
  EXPECT_FALSE(renderer_->upload_shared_indices({}));
}

TEST_P(RendererTest, TellsWhichFramesAreNotLikeTheOthers) {
  add_ground();
  const auto apart = [&] { return renderer_->render(input()).value().apart; };
  const auto expect_two_after_idle = [&](const char* what) {
    EXPECT_EQ(apart(), Apart::kAfterIdle) << what;
    EXPECT_EQ(apart(), Apart::kAfterIdle) << what;
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(apart(), Apart::kNo) << what;
  };
  expect_two_after_idle("the first frames");
  renderer_->wait_idle();
  expect_two_after_idle("a wait");
  ASSERT_TRUE(renderer_->capture());
  expect_two_after_idle("a picture");
  ASSERT_TRUE(renderer_->replay_floor_ms(3));
  expect_two_after_idle("a floor");
  ASSERT_TRUE(renderer_->resize({80, 60}));
  EXPECT_EQ(apart(), Apart::kResized);
  EXPECT_EQ(apart(), Apart::kAfterIdle);
  EXPECT_EQ(apart(), Apart::kNo);
}

TEST_P(RendererTest, WaitingIsNotAmongTheTimeOfRecording) {
  add_ground();
  for (int i = 0; i < 6; ++i) {
    const double start_s = core::monotonic_seconds();
    const FrameResult result = renderer_->render(input()).value();
    const double all_ms = (core::monotonic_seconds() - start_s) * 1e3;
    EXPECT_GT(result.cpu_ms, 0.0);
    EXPECT_GE(result.device.start_s, start_s);
    EXPECT_EQ(result.wait_ms(), result.device.ms);  // there is no window
    EXPECT_LE(result.cpu_ms + result.wait_ms(), all_ms);
  }
}

INSTANTIATE_TEST_SUITE_P(Submissions, RendererTest,
                         testing::ValuesIn(std::vector<Submission>{
                             Submission::kAuto, Submission::kPushed, Submission::kMultiDraw}),
                         [](const testing::TestParamInfo<Submission>& suite) {
                           switch (suite.param) {
                             case Submission::kPushed:
                               return "pushed";
                             case Submission::kMultiDraw:
                               return "multi_draw";
                             default:
                               return "automatic";
                           }
                         });

}  // namespace
}  // namespace psygen::render
