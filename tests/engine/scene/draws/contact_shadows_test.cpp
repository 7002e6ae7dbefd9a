#include "engine/scene/draws/contact_shadows.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace psygen::scene {
namespace {

const glm::vec3 kSun = glm::normalize(glm::vec3(1, 1, 0));

std::vector<render::GroundSpot> spots_of(glm::vec3 least, glm::vec3 greatest, bool shadow,
                                         glm::vec3 sun = kSun, bool grass = false) {
  std::vector<render::GroundSpot> spots;
  add_spots({least, greatest}, grass, {10, -2, -20}, sun, shadow, spots);
  return spots;
}

TEST(ContactShadows, ATreeDarkensTheGroundUnderItsCrownAtItsStemAndAwayFromTheSun) {
  const auto spots = spots_of({-2, 0, -3}, {4, 8, 3}, true);
  ASSERT_EQ(spots.size(), 3U);
  EXPECT_EQ(spots[0].middle, glm::vec2(11, -20)) << "the middle of the crown";
  EXPECT_EQ(spots[0].radius_m, 3.0F);
  EXPECT_EQ(spots[1].middle, glm::vec2(10, -20)) << "the foot";
  EXPECT_LT(spots[2].middle.x, 8.0F) << "away from the sun";
  EXPECT_EQ(spots[2].middle.y, -20.0F);
}

TEST(ContactShadows, ThereIsNoSpotAwayFromTheSunIfShadowsAreDrawnOrTheSunIsDown) {
  EXPECT_EQ(spots_of({-2, 0, -3}, {4, 8, 3}, false).size(), 2U);
  EXPECT_EQ(spots_of({-2, 0, -3}, {4, 8, 3}, true, {1, 0, 0}).size(), 2U);
  EXPECT_EQ(spots_of({-1, 0, -1}, {1, 1, 1}, false).size(), 1U);
}

TEST(ContactShadows, ARocksSpotReachesBeyondItAndTuftsOfGrassTakeLittleLight) {
  const auto rock = spots_of({-1, -0.2F, -1}, {1, 1, 1}, true);
  ASSERT_EQ(rock.size(), 2U);
  EXPECT_GT(rock[0].radius_m, 1.2F);
  const auto grass = spots_of({-1, 0, -1}, {1, 0.3F, 1}, true, kSun, true);
  ASSERT_EQ(grass.size(), 1U);
  EXPECT_LT(grass[0].sky, rock[0].sky);
  EXPECT_EQ(spots_of({-0.5F, -0.2F, -0.5F}, {0.5F, 0.4F, 0.5F}, true).size(), 2U) << "a low rock";
}

TEST(ContactShadows, AMeshWithoutVerticesLeavesNone) {
  EXPECT_TRUE(spots_of({}, {}, true).empty());
  EXPECT_TRUE(spots_of(glm::vec3(1e9F), glm::vec3(-1e9F), true).empty());
}

}  // namespace
}  // namespace psygen::scene
