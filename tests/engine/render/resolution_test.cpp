// Landscapes of fewer pixels than the picture: what is scaled up, and what is not.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/engine/render/on_a_path.hpp"

namespace psygen::render {
namespace {

class Resolutions : public OnAPath {
 protected:
  void SetUp() override {
    OnAPath::SetUp();
    const auto box = synthetic::make_box(renderer_->geometry(), {0.5F, 0.1F, 0.1F});
    ASSERT_TRUE(box);
    MeshDraw draw;
    draw.range = *box;
    draw.box_half_extent = {3, 3, 3};
    draw.origin = {0, 0, -20};
    boxes_.push_back(draw);
    draw.origin = {9, 0, -30};
    boxes_.push_back(draw);
  }

  Picture picture_at(float resolution, bool text = false) {
    FrameInput input = synthetic::look(10.0, -0.05, renderer_->size());
    input.models = boxes_;
    input.resolution = resolution;
    TextPanel panel;
    panel.lines = {{"figures"}};
    if (text) input.panels = std::span(&panel, 1);
    for (int i = 0; i < 2; ++i) {
      const auto result = renderer_->render(input);
      EXPECT_TRUE(result);
      if (result) drawn_ = result->resolution;
    }
    const auto picture = renderer_->capture();
    EXPECT_TRUE(picture);
    return picture ? *picture : Picture{};
  }

  std::vector<MeshDraw> boxes_;
  double drawn_ = 0;
};

// Mean difference of the channels, of 255.
double difference(const Picture& a, const Picture& b) {
  EXPECT_EQ(a.rgba.size(), b.rgba.size());
  double sum = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i)
    sum += std::abs(int{a.rgba[i]} - int{b.rgba[i]});
  return sum / static_cast<double>(a.rgba.size());
}

double pixels_that_differ(const Picture& a, const Picture& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4)
    count += std::abs(int{a.rgba[i + 1]} - int{b.rgba[i + 1]}) > 8 ? 1 : 0;
  return static_cast<double>(count);
}

TEST_P(Resolutions, FewerPixelsOfALandscapeFillThePicture) {
  const Picture whole = picture_at(1);
  EXPECT_EQ(drawn_, 1);
  for (const float share : {0.8F, 0.5F, 0.25F}) {
    const Picture coarse = picture_at(share);
    EXPECT_NEAR(drawn_, double{share}, 1e-6);
    const double off = difference(coarse, whole);
    EXPECT_GT(off, 0.2) << share;
    EXPECT_LT(off, 4) << share;
  }
  EXPECT_EQ(picture_at(1).rgba, whole.rgba) << "something is left of them";
}

// The rest of the image has what a landscape of more pixels has left there.
TEST_P(Resolutions, NothingIsSeenBeyondALandscapeOfFewerPixels) {
  const auto after = [&](double pitch) {
    FrameInput input = synthetic::look(10.0, pitch, renderer_->size());
    input.resolution = 0.95F;
    for (int i = 0; i < 2; ++i)
      EXPECT_TRUE(renderer_->render(input));
    return picture_at(0.6F);
  };
  EXPECT_EQ(after(1.2).rgba, after(-1.2).rgba);
}

TEST_P(Resolutions, TextHasAllPixels) {
  const double sharp = pixels_that_differ(picture_at(1, true), picture_at(1));
  EXPECT_GT(sharp, 100);
  const double over_coarse = pixels_that_differ(picture_at(0.5F, true), picture_at(0.5F));
  EXPECT_NEAR(over_coarse, sharp, 0.05 * sharp);
}

TEST_P(Resolutions, TextAloneAfterThemIsAsBefore) {
  TextPanel panel;
  panel.lines = {{"loading"}};
  const auto shown = [&] {
    EXPECT_TRUE(renderer_->show(std::span(&panel, 1), 1, {}));
    const auto picture = renderer_->capture();
    EXPECT_TRUE(picture);
    return picture ? picture->rgba : std::vector<std::uint8_t>{};
  };
  picture_at(1);  // opaque
  const auto before = shown();
  picture_at(0.5F);
  EXPECT_EQ(shown(), before);
}

TEST_P(Resolutions, OutOfTheirRangeAreTheNearestOne) {
  const Picture whole = picture_at(1), least = picture_at(kMinResolution);
  for (const float share : {1.5F, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_EQ(picture_at(share).rgba, whole.rgba) << share;
  for (const float share : {-1.0F, 0.0F})
    EXPECT_EQ(picture_at(share).rgba, least.rgba) << share;
}

TEST_P(Resolutions, FollowTheSizeOfThePictureAndReplays) {
  picture_at(0.5F);
  ASSERT_TRUE(renderer_->resize({64, 48}));
  EXPECT_EQ(picture_at(0.5F).width, 64u);
  EXPECT_EQ(drawn_, 0.5);
  ASSERT_TRUE(renderer_->resize({1, 1}));
  EXPECT_EQ(picture_at(0.5F).rgba.size(), 4u);
  ASSERT_TRUE(renderer_->resize(kSize));
  // An odd number of frames: both frames in flight show the same picture, at its edges too.
  const Picture before = picture_at(0.6F);
  ASSERT_TRUE(renderer_->replay_floor_ms(3));
  EXPECT_EQ(renderer_->capture()->rgba, before.rgba);
}

INSTANTIATE_TEST_SUITE_P(OnEveryPath, Resolutions, in_every_way());

}  // namespace
}  // namespace psygen::render
