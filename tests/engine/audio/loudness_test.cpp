#include <gtest/gtest.h>

#include <limits>

#include "engine/audio/audio.hpp"

namespace psygen::audio {
namespace {

TEST(Loudness, FallsFromOneToNothing) {
  const Range range{2, 100};
  EXPECT_EQ(attenuation(0, range), 1);
  EXPECT_EQ(attenuation(2, range), 1);
  EXPECT_NEAR(attenuation(2.001, range), 1, 1e-3);
  EXPECT_NEAR(attenuation(51, range), 2.0 / 51 * 0.5, 1e-12);
  EXPECT_EQ(attenuation(100, range), 0);
  EXPECT_EQ(attenuation(std::numeric_limits<double>::quiet_NaN(), range), 0);
  for (double d = 0; d < 110; d += 0.5)
    EXPECT_GE(attenuation(d, range), attenuation(d + 0.5, range)) << d;
}

}  // namespace
}  // namespace psygen::audio
