// Point lights on every path, per vertex and per pixel: they light what they reach, and nothing
// else changes.
#include <gtest/gtest.h>

#include "tests/engine/render/one_of_each.hpp"

namespace psygen::render {
namespace {

class PointLights : public OneOfEach {
 protected:
  void SetUp() override {
    OneOfEach::SetUp();
    input_.light.cloud_cover = 0;
    for (glm::vec3* colour :
         {&input_.light.sun_colour, &input_.light.zenith_colour, &input_.light.horizon_colour,
          &input_.light.ground_colour, &input_.light.haze_colour, &input_.light.glow_colour})
      *colour *= 0.05F;
  }
  Picture lit_by(std::vector<PointLight> lights) {
    FrameInput input = input_;
    input.point_lights = lights;
    return draw(input);
  }
  // Of the pixels in a column of the picture's halves: left the model, right the object.
  static double brightness(const Picture& picture, std::uint32_t from_x, std::uint32_t to_x,
                           std::uint32_t from_y, std::uint32_t to_y) {
    double sum = 0;
    for (std::uint32_t y = from_y; y < to_y; ++y) {
      for (std::uint32_t x = from_x; x < to_x; ++x)
        sum += picture.rgba[4 * (y * picture.width + x)];
    }
    return sum / ((to_x - from_x) * (to_y - from_y));
  }
  static double model_of(const Picture& p) { return brightness(p, 44, 56, 56, 64); }
  static double object_of(const Picture& p) { return brightness(p, 104, 116, 56, 64); }
  static double ground_of(const Picture& p) { return brightness(p, 60, 100, 90, 118); }
};

TEST_P(PointLights, LightGroundModelsAndObjectsThatTheyReach) {
  const Picture dark = lit_by({});
  const Picture lit = lit_by({{{0, 1, -8}, 30, glm::vec3(20.0F)}});
  EXPECT_GT(model_of(lit), model_of(dark) + 20);
  EXPECT_GT(object_of(lit), object_of(dark) + 20);
  EXPECT_GT(ground_of(lit), ground_of(dark) + 20);
}

TEST_P(PointLights, LightNothingBeyondTheirRange) {
  const Picture dark = lit_by({});
  const Picture lit = lit_by({{{3, 0, -8}, 4, glm::vec3(20.0F)}});
  EXPECT_GT(object_of(lit), object_of(dark) + 20);
  EXPECT_NEAR(model_of(lit), model_of(dark), 1.01);
}

TEST_P(PointLights, OfNoLightChangeNothing) {
  const Picture dark = lit_by({});
  const Picture black = lit_by({{{0, 1, -8}, 30, glm::vec3(0.0F)}});
  int most = 0;
  for (std::size_t i = 0; i < dark.rgba.size(); ++i)
    most = std::max(most, std::abs(int{dark.rgba[i]} - int{black.rgba[i]}));
  EXPECT_LE(most, 1);
  EXPECT_EQ(lit_by({}).rgba, dark.rgba) << "without lights again";
}

TEST_P(PointLights, HaveAColourAndAddUp) {
  const Picture red = lit_by({{{0, 1, -8}, 30, {9, 0, 0}}});
  const Picture green = lit_by({{{0, 1, -8}, 30, {0, 9, 0}}});
  const Picture both = lit_by({{{0, 1, -8}, 30, {9, 0, 0}}, {{0, 1, -8}, 30, {0, 9, 0}}});
  const std::size_t at = 4 * (60 * kSize.width + 110);
  EXPECT_GT(red.rgba[at], red.rgba[at + 1] + 30);
  EXPECT_GT(green.rgba[at + 1], green.rgba[at] + 30);
  EXPECT_NEAR(both.rgba[at], red.rgba[at], 2);
  EXPECT_NEAR(both.rgba[at + 1], green.rgba[at + 1], 2);
}

TEST_P(PointLights, BeyondTheMostAreIgnored) {
  std::vector<PointLight> many(kMaxPointLights + 100, {{0, 1, 60}, 5, glm::vec3(1.0F)});
  many.back() = {{0, 1, -8}, 30, glm::vec3(20.0F)};
  EXPECT_NEAR(object_of(lit_by(many)), object_of(lit_by({})), 1.01);
  many.front() = many.back();
  EXPECT_GT(object_of(lit_by(many)), object_of(lit_by({})) + 20);
}

TEST_P(PointLights, SurviveAChangeOfPreset) {
  lit_by({{{0, 1, -8}, 30, glm::vec3(20.0F)}});
  ASSERT_TRUE(renderer_->set_preset(next_preset(renderer_->preset())));
  const Picture dark = lit_by({});
  EXPECT_GT(object_of(lit_by({{{0, 1, -8}, 30, glm::vec3(20.0F)}})), object_of(dark) + 20);
}

INSTANTIATE_TEST_SUITE_P(OnEveryPath, PointLights,
                         testing::ValuesIn(std::vector<How>{
                             {RenderPath::kCpu, Submission::kPushed, Preset::kLow},
                             {RenderPath::kCpu, Submission::kMultiDraw, Preset::kMedium},
                             {RenderPath::kGpu, Submission::kMultiDraw, Preset::kLow},
                             {RenderPath::kGpu, Submission::kMultiDraw, Preset::kHigh}}));

}  // namespace
}  // namespace psygen::render
