// The fixture of tests that hold on every path of the renderer: a small headless renderer with
// validation, which must have nothing to say at the end.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <tuple>

#include "engine/render/preset.hpp"
#include "tests/engine/render/synthetic_scene.hpp"
#include "tests/engine/render/ways.hpp"

namespace psygen::render {

class OnAPath : public testing::TestWithParam<How> {
 protected:
  static constexpr core::Extent kSize = synthetic::kPictureSize;

  void SetUp() override {
    RendererOptions options;
    options.validation = true;
    options.device_name = device_name();
    options.size = kSize;
    options.geometry_budget_bytes = 8 << 20;
    std::tie(options.path, options.submission, options.preset) = GetParam();
    auto made = Renderer::create(options);
    ASSERT_TRUE(made) << made.error().message;
    renderer_ = std::move(*made);
  }
  // Part of the device's name; empty: the best device.
  virtual std::string device_name() const { return {}; }
  void TearDown() override {
    if (!renderer_) return;
    renderer_->wait_idle();
    for (const std::string& message : renderer_->validation_messages())
      ADD_FAILURE() << message;
  }
  // Twice, so that what was hidden or seen in the first frame is known in the second.
  Picture draw(const FrameInput& input) {
    for (int i = 0; i < 2; ++i)
      EXPECT_TRUE(renderer_->render(input));
    auto picture = renderer_->capture();
    EXPECT_TRUE(picture);
    return picture ? *picture : Picture{};
  }

  std::unique_ptr<Renderer> renderer_;
};

}  // namespace psygen::render
