#include "engine/audio/tones.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace psygen::audio {
namespace {

double power(std::span<const float> samples) {
  double sum = 0;
  for (const float v : samples)
    sum += static_cast<double>(v) * static_cast<double>(v);
  return sum / static_cast<double>(std::max<std::size_t>(samples.size(), 1));
}

// The power of a frequency in the samples: 0.25 for a full sine.
double share_of_hz(const Samples& samples, double hz) {
  double re = 0, im = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double turn = 2 * std::numbers::pi * hz * static_cast<double>(i) / kToneRateHz;
    re += static_cast<double>(samples[i]) * std::cos(turn);
    im += static_cast<double>(samples[i]) * std::sin(turn);
  }
  const auto n = static_cast<double>(samples.size());
  return (re * re + im * im) / (n * n);
}

TEST(Tones, NoiseDependsOnItsSeedAndHasOnlyItsFrequencies) {
  const Samples a = noise(1, 200, 800, 3);
  EXPECT_EQ(a.size(), kToneRateHz);
  EXPECT_EQ(a, noise(1, 200, 800, 3));
  EXPECT_NE(a, noise(1, 200, 800, 4));
  const auto around = [&](double hz) {
    double sum = 0;
    for (double f = 0.9 * hz; f < 1.1 * hz; f += 0.01 * hz)
      sum += share_of_hz(a, f);
    return sum;
  };
  EXPECT_GT(around(400), 4 * around(20));
  EXPECT_GT(around(400), 4 * around(6000));
}

TEST(Tones, AToneHasItsPitchStartsAtItsTimeAndDecays) {
  Samples out(samples_of(2));
  add_tone(out, 0.5, 441, 0.5F, 0.2, {0.5F});
  EXPECT_EQ(power(std::span(out).first(samples_of(0.5))), 0);
  EXPECT_GT(share_of_hz(out, 441), 50 * share_of_hz(out, 600));
  EXPECT_GT(share_of_hz(out, 882), 10 * share_of_hz(out, 600));
  EXPECT_GT(power(std::span(out).subspan(samples_of(0.52), 1000)),
            20 * power(std::span(out).subspan(samples_of(1.0), 1000)));
  EXPECT_EQ(power(std::span(out).subspan(samples_of(1.8))), 0) << "six decays are over";
  Samples none;
  add_tone(none, 1, 441, 1, 1);  // after the end
  EXPECT_TRUE(none.empty());
}

TEST(Tones, AddedSamplesFadeBetweenTheGainsAndEndWithTheSound) {
  Samples out(samples_of(0.1), 0.0F);
  const Samples ones(samples_of(0.1), 1.0F);
  add(out, 0.05, ones, 1, 0);
  EXPECT_EQ(out[samples_of(0.04)], 0.0F);
  EXPECT_NEAR(out[samples_of(0.05)], 1.0F, 1e-3F);
  EXPECT_NEAR(out.back(), 0.5F, 1e-2F);
}

TEST(Tones, ALoopHasNoSeam) {
  Samples sine(samples_of(1));
  for (std::size_t i = 0; i < sine.size(); ++i)
    sine[i] = std::sin(0.037F * static_cast<float>(i));
  const auto jump = [](const Samples& s) { return std::abs(s.front() - s.back()); };
  Samples cut(sine.begin(), sine.begin() + 20000);
  ASSERT_GT(jump(cut), 0.2F);
  const Samples loop = looped(cut, 0.2);
  EXPECT_EQ(loop.size(), cut.size() - samples_of(0.2));
  EXPECT_LT(jump(loop), 0.05F);
  EXPECT_EQ(looped({}, 1).size(), 0U);
  EXPECT_EQ(looped(Samples(10, 1.0F), 5).size(), 5U);
}

TEST(Tones, AClipHasOneChannelOrTwoAndIsClipped) {
  Samples left{0, 0.5F, 2}, right{-3, 0, 1};
  shape(left, [](float) { return 1.0F; });
  const Clip mono_clip = clip_of(left);
  EXPECT_EQ(mono_clip.channels, 1U);
  EXPECT_EQ(mono_clip.samples, (std::vector<std::int16_t>{0, 16383, 32767}));
  const Clip both = clip_of(left, right);
  EXPECT_EQ(both.channels, 2U);
  EXPECT_EQ(both.samples, (std::vector<std::int16_t>{0, -32767, 16383, 0, 32767, 32767}));
  EXPECT_TRUE(check_clip(both));
  EXPECT_FALSE(check_clip(clip_of({})));
}

}  // namespace
}  // namespace psygen::audio
