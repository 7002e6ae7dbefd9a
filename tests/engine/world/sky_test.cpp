#include <gtest/gtest.h>

#include "engine/world/atmosphere.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/world.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using testing::kSmallWorld;
using testing::parsed;

TEST(Sky, TheSunRisesInTheEastStandsInTheSouthAndSetsInTheWest) {
  Sky sky;
  sky.day_length_s = 240;
  sky.start_hour = 0;
  const SunPlace morning = sky.sun_at(60), noon = sky.sun_at(120), evening = sky.sun_at(180);
  EXPECT_NEAR(noon.azimuth_deg, 180, 1e-6);
  EXPECT_NEAR(noon.elevation_deg, 90 - sky.latitude_deg + 12, 1e-6);
  EXPECT_NEAR(morning.azimuth_deg, 90, 15);
  EXPECT_NEAR(evening.azimuth_deg, 270, 15);
  EXPECT_NEAR(morning.elevation_deg, evening.elevation_deg, 1e-6);
  EXPECT_LT(sky.sun_at(0).elevation_deg, -20);
  EXPECT_NEAR(sky.sun_at(240).elevation_deg, sky.sun_at(0).elevation_deg, 1e-6);
}

TEST(Sky, WithoutADayTheSunStandsStill) {
  Sky sky;
  EXPECT_EQ(sky_at(sky, 0), sky);
  EXPECT_EQ(sky_at(sky, 1e6), sky);
}

TEST(Sky, ALowSunIsRedderAndNightIsDark) {
  const Sky sky;
  const Sky low = with_sun(sky, {128, 4}), night = with_sun(sky, {128, -40});
  EXPECT_GT(low.sun_colour.x / low.sun_colour.z, 2 * sky.sun_colour.x / sky.sun_colour.z);
  EXPECT_LT(night.sun_colour.x, 1e-4F) << "no sun";
  EXPECT_LT(night.zenith_colour.z, 0.25F * sky.zenith_colour.z);
  EXPECT_GT(night.zenith_colour.z, 0.0F);
}

TEST(Sky, LightChangesSmoothlyOverTheDay) {
  Daylight before = daylight(-30);
  for (double elevation = -29.75; elevation <= 90; elevation += 0.25) {
    const Daylight now = daylight(elevation);
    for (int i = 0; i < 3; ++i) {
      EXPECT_LT(std::abs(now.haze[i] - before.haze[i]), 0.25F * before.haze[i] + 1e-4F)
          << elevation;
      EXPECT_GT(now.zenith[i], 0.0F);
      EXPECT_TRUE(std::isfinite(now.glow[i]) && std::isfinite(now.ground[i])) << elevation;
    }
    before = now;
  }
}

TEST(Sky, AFileWithoutColoursHasThoseOfItsSun) {
  const World low = parsed(std::string(kSmallWorld) +
                           "\n[sky]\nsun_elevation_deg = 5\nhaze_colour = [1, 2, 3]\n");
  const World usual = parsed(std::string(kSmallWorld) + "\n[sky]\n");
  EXPECT_EQ(usual.sky, Sky{});
  EXPECT_EQ(low.sky.sun_colour, with_sun(Sky{}, {128, 5}).sun_colour);
  EXPECT_EQ(low.sky.haze_colour, glm::vec3(1, 2, 3));
}

TEST(Sky, WaterExistsOnlyInFilesThatDefineIt) {
  EXPECT_FALSE(parsed(kSmallWorld).water.exists());
  const World wet = parsed(std::string(kSmallWorld) + "\n[water]\nlevel_m = 12.5\n");
  EXPECT_TRUE(wet.water.exists());
  EXPECT_EQ(wet.water.level_m, 12.5);
  EXPECT_EQ(parsed(write_world(wet, testing::registry())), wet);
  const auto wrong = parse_world(std::string(kSmallWorld) + "\n[water]\nlevel = 12\n", "w.toml",
                                 testing::registry());
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("level_m"), std::string::npos) << wrong.error().message;
}

}  // namespace
}  // namespace psygen::world
