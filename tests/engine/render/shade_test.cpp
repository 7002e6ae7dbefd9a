// A mesh in the shade of the ground has the light of the sky and none of the sun's, on every path,
// with and without light per pixel.
#include <gtest/gtest.h>

#include <array>
#include <tuple>

#include "tests/engine/render/synthetic_scene.hpp"

namespace psygen::render {
namespace {

using synthetic::kPictureSize;

using How = std::tuple<RenderPath, Submission, Preset>;

// The brightness of a box in the middle of the picture, red + green + blue.
int brightness(Renderer& renderer, MeshDraw box, float sun, glm::vec3 sun_colour) {
  FrameInput input = synthetic::look(60, 0, kPictureSize);
  input.light.cloud_cover = 0;
  input.light.sun_colour = sun_colour;
  box.sun = sun;
  const std::array models{box};
  input.models = models;
  for (int i = 0; i < 2; ++i)
    EXPECT_TRUE(renderer.render(input));
  const auto picture = renderer.capture();
  if (!picture) return -1;
  const std::uint8_t* const pixel =
      &picture->rgba[4 * (kPictureSize.width * (kPictureSize.height / 2) + kPictureSize.width / 2)];
  return pixel[0] + pixel[1] + pixel[2];
}

TEST(Shade, HoldsUpTheSunAndNothingElse) {
  for (const How& how : {How{RenderPath::kCpu, Submission::kPushed, Preset::kLow},
                         How{RenderPath::kCpu, Submission::kMultiDraw, Preset::kLow},
                         How{RenderPath::kGpu, Submission::kMultiDraw, Preset::kLow},
                         How{RenderPath::kCpu, Submission::kPushed, Preset::kHigh},
                         How{RenderPath::kGpu, Submission::kMultiDraw, Preset::kUltra}}) {
    RendererOptions options;
    options.validation = true;
    options.size = kPictureSize;
    options.geometry_budget_bytes = 8 << 20;
    std::tie(options.path, options.submission, options.preset) = how;
    auto made = Renderer::create(options);
    ASSERT_TRUE(made) << made.error().message;
    Renderer& renderer = **made;
    const auto range = synthetic::make_box(renderer.geometry(), {0.4F, 0.3F, 0.2F});
    ASSERT_TRUE(range);
    MeshDraw box;
    box.range = *range;
    box.origin = {0, -1, -10};
    box.box_half_extent = {3, 4, 3};
    const glm::vec3 colour = synthetic::look(60, 0, kPictureSize).light.sun_colour;
    const int lit = brightness(renderer, box, 1.0F, colour);
    const int half = brightness(renderer, box, 0.5F, colour);
    const int shaded = brightness(renderer, box, 0.0F, colour);
    EXPECT_GT(lit, half + 10);
    EXPECT_GT(half, shaded + 10);
    EXPECT_NEAR(shaded, brightness(renderer, box, 1.0F, glm::vec3(0.0F)), 3);
    EXPECT_GT(shaded, 30);
    renderer.wait_idle();
    for (const std::string& message : renderer.validation_messages())
      ADD_FAILURE() << message;
  }
}

}  // namespace
}  // namespace psygen::render
