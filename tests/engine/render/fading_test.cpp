// Meshes that come and go leave out pixels: what goes and what comes in its place cover each pixel
// once, on every path, with every preset.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <tuple>

#include "tests/engine/render/on_a_path.hpp"

namespace psygen::render {
namespace {

class Fading : public OnAPath {
 protected:
  void SetUp() override {
    OnAPath::SetUp();
    if (!renderer_) return;
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
      const auto range = synthetic::make_box(renderer_->geometry(), {0.4F, 0.1F, 0.05F});
      ASSERT_TRUE(range);
      meshes_[i].range = *range;
      meshes_[i].origin = {i < 2 ? -2.0F : 3.0F, -1, i < 2 ? -10.0F : -12.0F};
      meshes_[i].box_half_extent = {2, 4, 2};
      meshes_[i].debug_colour = 0xE03020;
    }
    input_ = synthetic::look(60, 0, kSize);
    input_.light.cloud_cover = 0;
  }
  Picture draw(std::span<const MeshDraw> models) {
    input_.models = models;
    return OnAPath::draw(input_);
  }
  MeshDraw mesh(std::size_t index, float fade) const {
    MeshDraw draw = meshes_[index];
    draw.fade = fade;
    return draw;
  }
  // Pixels of which a byte differs by more than `by`.
  static std::size_t different(const Picture& a, const Picture& b, int by = 0) {
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4)
      pixels += std::equal(&a.rgba[i], &a.rgba[i] + 4, &b.rgba[i],
                           [by](int x, int y) { return std::abs(x - y) <= by; })
                    ? 0
                    : 1;
    return pixels;
  }
  // Sum of the differences of all bytes.
  static std::uint64_t difference(const Picture& a, const Picture& b) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
      sum += static_cast<std::uint64_t>(std::abs(a.rgba[i] - b.rgba[i]));
    return sum;
  }

  std::array<MeshDraw, 3> meshes_;  // two at the same place, one beside and behind them
  FrameInput input_;
};

TEST_P(Fading, AFadingPairCoversEveryPixelOnce) {
  const std::array whole{mesh(0, 1), mesh(2, 1)};
  const Picture expected = draw(whole);
  for (const float fade : {0.01F, 0.3F, 0.5F, 0.97F}) {
    input_.fade_phase = 1 - fade;
    const std::array both{mesh(0, fade), mesh(1, -fade), mesh(2, 1)};
    EXPECT_EQ(draw(both).rgba, expected.rgba) << fade;
    const std::array turned{mesh(2, 1), mesh(1, -fade), mesh(0, fade)};
    EXPECT_EQ(draw(turned).rgba, expected.rgba) << fade;
  }
}

TEST_P(Fading, AMeshCoversAsLargeAShareOfItsPixelsAsItIsThere) {
  const Picture empty = draw({});
  const std::array whole{mesh(0, 1)};
  const auto all = static_cast<double>(different(draw(whole), empty));
  ASSERT_GT(all, 1000);
  for (const float fade : {0.1F, 0.5F, 0.9F}) {
    const std::array coming{mesh(0, fade)}, going{mesh(0, -fade)};
    EXPECT_NEAR(static_cast<double>(different(draw(coming), empty)) / all, fade, 0.03);
    EXPECT_NEAR(static_cast<double>(different(draw(going), empty)) / all, 1 - fade, 0.03);
  }
  const std::array not_yet_going{mesh(0, 0)};
  EXPECT_EQ(draw(not_yet_going).rgba, draw(whole).rgba);
}

// Shares rise from frame to frame, and the pattern moves by half as much.
TEST_P(Fading, APixelChangesOnceInAFadeAndNeverBack) {
  meshes_[1].box_half_extent = {1, 2, 1};  // what goes is smaller
  const Picture before = draw(std::array{mesh(1, 1)}), after = draw(std::array{mesh(0, 1)});
  constexpr int kFrames = 6;
  std::vector<int> changes(before.rgba.size() / 4);
  Picture last = before;
  for (int frame = 1; frame <= kFrames; ++frame) {
    const float share = static_cast<float>(frame) / kFrames;
    input_.fade_phase = 0.4F + 0.5F * share;
    input_.fade_phase -= std::floor(input_.fade_phase);
    Picture now = frame < kFrames ? draw(std::array{mesh(0, share), mesh(1, -share)}) : after;
    for (std::size_t i = 0; i < changes.size(); ++i)
      changes[i] += std::equal(&now.rgba[4 * i], &now.rgba[4 * i] + 4, &last.rgba[4 * i]) ? 0 : 1;
    last = std::move(now);
  }
  const std::size_t all = different(before, after);
  ASSERT_GT(all, 1000u);
  const auto often = std::ranges::count_if(changes, [](int times) { return times > 1; });
  // With several samples a pixel's edges have steps between; shadows of what fades do too.
  const bool samples = std::get<2>(GetParam()) >= Preset::kHigh;
  EXPECT_LE(often, samples ? static_cast<std::ptrdiff_t>(all / 2) : 0);
}

TEST_P(Fading, ThePatternMovesWithItsPhaseAndIsTheSameForTheSamePhase) {
  const std::array half{mesh(0, 0.5F)};
  const Picture whole = draw(std::array{mesh(0, 1)});
  const std::size_t all = different(whole, draw({}));
  const Picture first = draw(half);
  input_.fade_phase = 0.25F;
  const Picture second = draw(half);
  const double moved = static_cast<double>(different(first, second));
  EXPECT_NEAR(moved / static_cast<double>(all), 0.5, 0.05) << "half of each leaves the other";
  EXPECT_EQ(draw(half).rgba, second.rgba);
  input_.fade_phase = 0;
  EXPECT_EQ(draw(half).rgba, first.rgba);
}

// Also of its shadow, whose soft edge spreads a hint thinly over many pixels: over 1,362 or 2,108,
// depending on the driver's steps between texels. Those by more than thin of 255 are few there
// too, and all changes together are small everywhere (measured: 2 %, with shadows 4 to 5 %).
TEST_P(Fading, AHintOfAnotherMeshChangesAHintOfThePicture) {
  const bool has_shadows = std::get<2>(GetParam()) >= Preset::kHigh;
  const int thin = has_shadows ? 8 : 0;
  const std::array whole{mesh(0, 1)};
  const Picture before = draw(whole);
  meshes_[1].box_half_extent = {2.6F, 4.6F, 2.6F};
  const std::array larger{mesh(1, 1)};
  const Picture after = draw(larger);
  const std::size_t pixels = different(after, before, thin);
  const std::uint64_t all = difference(after, before);
  ASSERT_GT(pixels, 1000u);
  const std::array hint{mesh(1, 0.02F), mesh(0, -0.02F)};
  const Picture begun = draw(hint);
  EXPECT_LT(different(begun, before, thin), pixels / 5);
  EXPECT_LT(difference(begun, before), all / 12);
  const std::array nearly{mesh(1, 0.98F), mesh(0, -0.98F)};
  const Picture almost = draw(nearly);
  EXPECT_LT(different(almost, after, thin), pixels / 5);
  EXPECT_LT(difference(almost, after), all / 12);
}

TEST_P(Fading, ViewsForUnderstandingFadeToo) {
  for (const View view : {View::kLevels, View::kWireframe, View::kBounds}) {
    input_.view = view;
    const std::array whole{mesh(0, 1)};
    const std::array both{mesh(0, 0.4F), mesh(1, -0.4F)};
    EXPECT_EQ(draw(both).rgba, draw(whole).rgba);
  }
}

std::string name_of(const testing::TestParamInfo<How>& info) {
  const auto [path, submission, preset] = info.param;
  return std::string(to_string(preset)) + (path == RenderPath::kGpu ? "_gpu_path" : "_cpu_path") +
         (submission == Submission::kPushed ? "_pushed" : "_multi_draw");
}
INSTANTIATE_TEST_SUITE_P(Ways, Fading, in_every_way(), name_of);

}  // namespace
}  // namespace psygen::render
