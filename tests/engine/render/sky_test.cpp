// The sky of preset low, a dome of few corners, against that which is found for each pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "tests/engine/render/synthetic_scene.hpp"

namespace psygen::render {
namespace {

constexpr core::Extent kSkySize{320, 180};

// A sun so high over the horizon, with the colours of about that hour.
Light light_at(double elevation_deg) {
  Light light;
  const double e = elevation_deg * std::numbers::pi / 180;
  light.sun_direction = {std::cos(e) * 0.6, std::sin(e), -std::cos(e) * 0.8};
  if (elevation_deg > 15) return light;
  light.sun_colour = {1.6F, 0.7F, 0.2F};
  light.glow_colour = {2.4F, 1.0F, 0.3F};
  light.cloud_colour = {1.4F, 0.6F, 0.25F};
  light.zenith_colour = {0.05F, 0.09F, 0.2F};
  light.horizon_colour = {0.35F, 0.27F, 0.25F};
  light.haze_colour = {0.75F, 0.42F, 0.22F};
  return light;
}

struct Difference {
  int largest = 0;
  double mean = 0;
};

class Sky : public testing::Test {
 protected:
  void SetUp() override {
    for (const Preset preset : {Preset::kLow, Preset::kMedium}) {
      RendererOptions options;
      options.validation = true;
      options.size = kSkySize;
      options.geometry_budget_bytes = 1 << 20;
      options.preset = preset;
      auto made = Renderer::create(options);
      ASSERT_TRUE(made) << made.error().message;
      (preset == Preset::kLow ? dome_ : exact_) = std::move(*made);
    }
  }
  void TearDown() override {
    for (Renderer* renderer : {dome_.get(), exact_.get()}) {
      if (renderer == nullptr) continue;
      renderer->wait_idle();
      for (const std::string& message : renderer->validation_messages())
        ADD_FAILURE() << message;
    }
  }
  static std::vector<std::uint8_t> drawn(Renderer& renderer, const FrameInput& input) {
    EXPECT_TRUE(renderer.render(input));
    auto picture = renderer.capture();
    EXPECT_TRUE(picture);
    return picture ? std::move(picture->rgba) : std::vector<std::uint8_t>{};
  }
  Difference difference(const FrameInput& input) {
    const std::vector<std::uint8_t> a = drawn(*dome_, input), b = drawn(*exact_, input);
    Difference out;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
      out.largest = std::max(out.largest, std::abs(a[i] - b[i]));
      out.mean += std::abs(a[i] - b[i]) / static_cast<double>(a.size());
    }
    return out;
  }

  std::unique_ptr<Renderer> dome_, exact_;
};

TEST_F(Sky, OfFewCornersLooksLikeThatOfEachPixel) {
  for (const double elevation_deg : {60.0, 44.0, 12.0, 2.0, -4.0}) {
    for (const double pitch : {-0.2, 0.1, 0.5, 1.2}) {
      for (const double yaw : {0.0, 0.64, 1.6, 3.5}) {
        FrameInput input = synthetic::look(10, pitch, kSkySize);
        input.pose.yaw = yaw;
        input.light = light_at(elevation_deg);
        input.light.cloud_cover = -1;
        const Difference clear = difference(input);
        input.light.cloud_cover = 0.5F;
        const Difference cloudy = difference(input);
        SCOPED_TRACE(testing::Message() << elevation_deg << " deg, " << pitch << ", " << yaw);
        EXPECT_LE(clear.largest, 4);
        EXPECT_LE(clear.mean, 0.6);
        EXPECT_LE(cloudy.mean, 2.5);
      }
    }
  }
}

}  // namespace
}  // namespace psygen::render
