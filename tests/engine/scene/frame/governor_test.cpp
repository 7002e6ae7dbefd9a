#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>

#include "engine/scene/frame/quality.hpp"

namespace psygen::scene {
namespace {

// Frames cost a fixed part and one that falls with the error, `delay` frames late.
class Load {
 public:
  Load(double fixed_ms, double varied_ms, int delay)
      : fixed_ms_(fixed_ms), varied_ms_(varied_ms), delay_(delay) {}
  double frame_ms(double factor) {
    factors_.push_back(factor);
    const double acting = factors_.front();
    if (factors_.size() > static_cast<std::size_t>(delay_)) factors_.pop_front();
    return fixed_ms_ + varied_ms_ / std::pow(acting, 1.2);
  }

 private:
  double fixed_ms_, varied_ms_;
  int delay_;
  std::deque<double> factors_;
};

// Frames of its start: two cold ones, eight measured ones, and fourteen until they are answered.
constexpr int kCold = 2, kMeasured = 8, kAnswered = 14;
void begin(Governor& governor, double frame_ms) {
  for (int i = 0; i < kCold + kMeasured + kAnswered; ++i)
    governor.observe(frame_ms);
}

// A governor that has refined as far as possible and then met frames within the band.
Governor at_the_finest(const GovernorSettings& settings) {
  Governor governor(settings);
  for (int i = 0; i < 3000; ++i)
    governor.observe(settings.target_ms / 2);
  for (int i = 0; i < 100; ++i)
    governor.observe(settings.target_ms * 0.9);
  EXPECT_EQ(governor.load_reduction(), 1);
  return governor;
}

TEST(Governor, KeepsTheErrorWithoutATarget) {
  Governor governor;
  for (int i = 0; i < 100; ++i)
    governor.observe(1000);
  EXPECT_EQ(governor.load_reduction(), 1);
}

TEST(Governor, SlowFramesGetCoarserUntilTheyAreInTheBand) {
  Governor governor = at_the_finest({.target_ms = 16.7});
  Load load(4, 25, 30);
  double frame_ms = 0;
  for (int i = 0; i < 600; ++i)
    governor.observe(frame_ms = load.frame_ms(governor.load_reduction()));
  EXPECT_LE(frame_ms, 16.7 * 1.02);
  EXPECT_GE(frame_ms, 16.7 * 0.80);
}

// The average growth of the error per frame, over the last `frames` of this length.
double answer_to(Governor& governor, double frame_ms, int frames) {
  const double before = governor.load_reduction();
  for (int i = 0; i < frames; ++i)
    governor.observe(frame_ms);
  return std::pow(governor.load_reduction() / before, 1.0 / frames) - 1;
}

TEST(Governor, AnswersVerySlowFramesFaster) {
  for (const auto& [frame_ms, step] : {std::pair(20.0, 0.012), std::pair(32.0, 3 * 0.012)}) {
    Governor governor = at_the_finest({.target_ms = 16, .max_reduction = 1e9});
    answer_to(governor, frame_ms, 60);
    EXPECT_NEAR(answer_to(governor, frame_ms, 40), step, 1e-4);
  }
}

// The resolution does not change triangle counts: the governor lowers it to its minimum, and no
// further.
TEST(Governor, TooManyTrianglesLowerTheResolutionAtOnce) {
  Governor governor =
      at_the_finest({.target_ms = 16, .max_reduction = 8, .resolution_reduction = 2});
  for (int i = 0; i < 200; ++i) {
    const double triangles = 20'000 + 7000 * (i % 7);
    governor.observe(5 + triangles * 1.5e-4, triangles);
  }
  EXPECT_EQ(governor.load_reduction(), 1);
  int frames = 0;
  for (; governor.load_reduction() < 2 && frames < 60; ++frames)
    governor.observe(15.9, 120'000);
  EXPECT_LE(frames, 8);
}

TEST(Governor, StartsAsSetAndMeasuresBeforeItsFirstStep) {
  for (const double frame_ms : {4.0, 24.0}) {
    Governor governor(
        {.target_ms = 16, .max_reduction = 100, .start_reduction = 10, .rest_share = 0.8});
    for (int i = 0; i < kCold; ++i)
      governor.observe(500);
    for (int i = 0; i < kMeasured - 1; ++i) {
      governor.observe(i % 3 == 0 ? 40 : frame_ms);  // some are disturbed
      EXPECT_EQ(governor.load_reduction(), 10);
    }
    governor.observe(frame_ms);
    const double answer = 10 * frame_ms / (0.8 * 16);
    EXPECT_NEAR(governor.load_reduction(), answer, 1e-9);
    for (int i = 0; i < kAnswered; ++i) {
      governor.observe(frame_ms);  // frames that do not follow yet
      EXPECT_NEAR(governor.load_reduction(), answer, 1e-9);
    }
  }
}

TEST(Governor, TakesNoFirstStepWithinTheBandAndNoneBeyondItsBounds) {
  Governor governor({.target_ms = 16, .start_reduction = 2});
  begin(governor, 15);
  EXPECT_EQ(governor.load_reduction(), 2);
  Governor fast({.target_ms = 16, .start_reduction = 2});
  begin(fast, 0.5);
  EXPECT_EQ(fast.load_reduction(), 1);
  Governor slow({.target_ms = 16, .start_reduction = 2});
  begin(slow, 1000);
  EXPECT_EQ(slow.load_reduction(), 4);
}

TEST(Governor, RefinesFastUntilFramesReachTheBandForTheFirstTime) {
  Governor governor({.target_ms = 16, .max_reduction = 100, .start_reduction = 100});
  begin(governor, 12);
  EXPECT_NEAR(answer_to(governor, 5, 60), -0.012, 1e-9);
  answer_to(governor, 14.5, 60);  // within the band
  const double factor = governor.load_reduction();
  EXPECT_NEAR(answer_to(governor, 15, 60), 0, 1e-12);
  EXPECT_EQ(governor.load_reduction(), factor);
  answer_to(governor, 5, 60);
  EXPECT_NEAR(answer_to(governor, 5, 60), -0.003, 1e-5);
}

// Frames whose triangle counts follow the error some frames late, of a view that may become wider.
class Picture {
 public:
  double triangles(double factor) {
    factors_.push_back(factor);
    const double acting = factors_.front();
    if (factors_.size() > 12) factors_.pop_front();
    return 40'000 * width / acting;
  }
  double width = 1;

 private:
  std::deque<double> factors_;
};

double frame_ms_of(double triangles) {
  return 5 + triangles * 1.5e-4;
}

// Counts frames that take more than a quarter too long after the view has become three times as
// wide.
int slow_frames_behind_a_hilltop(bool knows_triangles) {
  Governor governor = at_the_finest({.target_ms = 16});
  Picture picture;
  int slow = 0;
  for (int i = 0; i < 400; ++i) {
    picture.width = i < 200 ? 1 : 3;
    const double triangles = picture.triangles(governor.load_reduction());
    slow += i >= 200 && frame_ms_of(triangles) > 20 ? 1 : 0;
    governor.observe(frame_ms_of(triangles), knows_triangles ? triangles : 0);
  }
  EXPECT_LE(frame_ms_of(picture.triangles(governor.load_reduction())), 16.1);
  return slow;
}

TEST(Governor, PredictsTheTimeOfAWideViewFromItsTriangles) {
  EXPECT_GT(slow_frames_behind_a_hilltop(false), 25);
  EXPECT_LT(slow_frames_behind_a_hilltop(true), 18);  // of which twelve are unavoidable
}

TEST(Governor, AnswersAWideViewOnlyAsFarAsNeeded) {
  Governor governor = at_the_finest({.target_ms = 16});
  Picture picture;
  double most = 0;
  for (int i = 0; i < 1000; ++i) {
    picture.width = i < 200 ? 1 : 3;
    const double triangles = picture.triangles(governor.load_reduction());
    governor.observe(frame_ms_of(triangles), triangles);
    most = std::max(most, governor.load_reduction());
  }
  const double enough = 3 * 40'000 / ((16 - 5) / 1.5e-4);
  EXPECT_GT(most, enough);
  EXPECT_LT(most, 1.5 * enough);
}

TEST(Governor, TrianglesThatCostNothingChangeNothing) {
  const auto once = [](double times) {
    return [times](int i) { return i < 500 ? 10'000 : 10'000 * times; };
  };
  const auto by_turns = [](int i) { return i / 300 % 2 == 0 ? 10'000 : 14'000; };
  const auto slowly = [](int i) { return 10'000.0 + 200 * std::clamp(i - 300, 0, 60); };
  for (const std::function<double(int)>& triangles :
       {std::function<double(int)>(once(1.3)), std::function<double(int)>(once(100)),
        std::function<double(int)>(by_turns), std::function<double(int)>(slowly)}) {
    for (const double frame_ms : {5.0, 14.5, 15.0, 15.9}) {
      Governor governor = at_the_finest({.target_ms = 16});
      for (int i = 0; i < 2000; ++i) {
        governor.observe(frame_ms, triangles(i));
        ASSERT_EQ(governor.load_reduction(), 1) << frame_ms << " ms, frame " << i;
      }
    }
  }
}

void expect_rest(Governor governor) {
  Load load(4, 40, 40);
  for (int i = 0; i < 3000; ++i)
    governor.observe(load.frame_ms(governor.load_reduction()));
  const double rest = governor.load_reduction();
  for (int i = 0; i < 600; ++i) {
    // Noise of a tenth does not stir it.
    governor.observe(load.frame_ms(governor.load_reduction()) * (i % 2 == 0 ? 0.95 : 1.0));
    EXPECT_NEAR(governor.load_reduction(), rest, 0.03 * rest);
  }
}

TEST(Governor, SettlesInsteadOfOscillating) {
  expect_rest(Governor({.target_ms = 16.7}));
  expect_rest(at_the_finest({.target_ms = 16.7}));
}

TEST(Governor, ReturnsToTheFinestWhenThereIsTime) {
  Governor governor = at_the_finest({.target_ms = 16.7});
  for (int i = 0; i < 300; ++i)
    governor.observe(30);
  EXPECT_GT(governor.load_reduction(), 2);
  for (int i = 0; i < 1500; ++i)
    governor.observe(5);
  EXPECT_EQ(governor.load_reduction(), 1);
}

TEST(Governor, StaysBelowItsBoundAndHardlyReactsToASingleHitch) {
  Governor governor = at_the_finest({.target_ms = 16.7, .max_reduction = 3});
  governor.observe(5000);
  EXPECT_LT(governor.load_reduction(), 1.02);
  for (int i = 0; i < 5000; ++i)
    governor.observe(100);
  EXPECT_EQ(governor.load_reduction(), 3);
  governor.observe(std::numeric_limits<double>::quiet_NaN());
  governor.observe(-1);
  governor.observe(0);
  EXPECT_EQ(governor.load_reduction(), 3);
}

}  // namespace
}  // namespace psygen::scene
