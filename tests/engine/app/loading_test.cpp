#include "engine/app/loading.hpp"

#include <gtest/gtest.h>

#include "tests/engine/platform/virtual_display.hpp"

namespace psygen::app {
namespace {

// Polls until `condition()` holds; returns false if it does not within a number of attempts.
template <class Condition>
bool eventually(platform::Window& window, const Condition& condition, int looks = 300) {
  for (int i = 0; i < looks; ++i) {
    if (condition()) return true;
    window.wait_events(0.05);
  }
  return false;
}

class LoadingInAWindow : public testing::Test {
 protected:
  void SetUp() override {
    display_ = platform::VirtualDisplay::start();
    ASSERT_NE(display_, nullptr) << "these tests need xvfb, openbox and xdotool";
    auto created = platform::Window::create({"psygen loading test", {320, 180}, true});
    ASSERT_TRUE(created) << created.error().message;
    window_ = std::move(*created);
  }
  void press(const char* key) {
    ASSERT_TRUE(display_->xdotool({"search", "--sync", "--onlyvisible", "--name",
                                   "psygen loading test", "windowactivate", "--sync", "key", key}));
  }

  std::unique_ptr<platform::VirtualDisplay> display_;
  std::unique_ptr<platform::Window> window_;
};

TEST(Loading, EndsOnceTheStopFlagIsSet) {
  std::atomic<bool> stop{false};
  Loading loading("world", nullptr, &stop);
  EXPECT_TRUE(loading.update("filling", 0.1, nullptr));
  stop = true;
  EXPECT_FALSE(loading.update("filling", 0.2, nullptr));
  EXPECT_FALSE(loading.closed()) << "no window was closed";
  EXPECT_TRUE(Loading("world", nullptr, nullptr).update("filling", 0.1, nullptr));
}

TEST_F(LoadingInAWindow, EndsWhenTheWindowIsClosed) {
  Loading loading("world", window_.get(), nullptr);
  EXPECT_TRUE(loading.update("filling", 0.1, nullptr));
  window_->request_close();
  EXPECT_FALSE(loading.update("filling", 0.2, nullptr));
  EXPECT_TRUE(loading.closed());
}

TEST_F(LoadingInAWindow, EndsByTheEscapeKeyAndFollowsF11) {
  Loading loading("world", window_.get(), nullptr);
  press("F11");
  EXPECT_TRUE(eventually(*window_, [&] {
    EXPECT_TRUE(loading.update("filling", 0.1, nullptr));
    return window_->fullscreen();
  }));
  press("Escape");
  EXPECT_TRUE(eventually(*window_, [&] { return !loading.update("filling", 0.2, nullptr); }));
  EXPECT_TRUE(loading.closed());
}

TEST_F(LoadingInAWindow, ShowsABarOfTheProgress) {
  render::RendererOptions options;
  options.validation = true;
  options.surface = window_.get();
  options.preset = render::Preset::kLow;
  const auto renderer = render::Renderer::create(options);
  ASSERT_TRUE(renderer) << renderer.error().message;
  // Pixels of a blue that only the bar has.
  const auto bar = [&](double fraction) {
    EXPECT_TRUE(eventually(*window_, [&] {
      Loading loading("world", window_.get(), nullptr);
      EXPECT_TRUE(loading.update("filling", fraction, renderer->get()));
      return (*renderer)->capture().has_value();
    }));
    const auto picture = (*renderer)->capture();
    int blue = 0;
    for (std::size_t i = 0; picture && i < picture->rgba.size(); i += 4)
      blue += picture->rgba[i + 2] > picture->rgba[i] + 60 ? 1 : 0;
    return blue;
  };
  const int third = bar(1.0 / 3);
  EXPECT_EQ(bar(0), 0);
  EXPECT_GT(third, 100);
  EXPECT_NEAR(bar(1), 3 * third, third / 10);
  EXPECT_TRUE((*renderer)->validation_messages().empty());
}

TEST(Loading, NeverDecreasesTheProgress) {
  Loading loading("world", nullptr, nullptr);
  loading.update("filling", 0.5, nullptr);
  loading.update("filling", 0.3, nullptr);
  EXPECT_EQ(loading.fraction(), 0.5);
  loading.update("amplifying", 0.1, nullptr);
  EXPECT_EQ(loading.fraction(), 0.1) << "of another task";
}

TEST(PicturePace, LeavesMostOfTheTimeToLoading) {
  PicturePace quick;
  EXPECT_TRUE(quick.is_due(10));
  quick.drawn(10, 10.001);
  EXPECT_FALSE(quick.is_due(10.04));
  EXPECT_TRUE(quick.is_due(10.06)) << "20 images a second";
  PicturePace slow;
  slow.drawn(10, 12);
  EXPECT_FALSE(slow.is_due(19.9));
  EXPECT_TRUE(slow.is_due(20.1)) << "a fifth of the time";
}

TEST(TextScale, FollowsTheDisplayAndThePicture) {
  EXPECT_LT(text_scale(1, {640, 360}), 1.5F);
  EXPECT_LT(text_scale(1, {1920, 1080}), 1.5F);
  EXPECT_EQ(text_scale(2, {640, 360}), 2);
  EXPECT_GE(text_scale(1, {3840, 2160}), 1.5F);
}

}  // namespace
}  // namespace psygen::app
