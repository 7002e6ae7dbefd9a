#include "engine/render/meshes/contact_shadow_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace psygen::render {
namespace {

constexpr int kShadeSide = PSYGEN_SHADE_SIDE;

// The missing share of the sun, of 255, in the cell at a place relative to the camera.
std::uint32_t sun_at(const ContactShadowMap& shade, glm::vec2 place) {
  const glm::vec2 cell = place - shade.corner();
  const int x = static_cast<int>(cell.x), z = static_cast<int>(cell.y);
  return shade.words()[static_cast<std::size_t>(z * kShadeSide + x) / 2] >> ((x & 1) * 16) & 0xFF;
}

TEST(ContactShadowMap, ASpotIsDarkestInItsMiddleAndEndsAtItsRadius) {
  ContactShadowMap shade;
  const std::array spots{GroundSpot{{10.5F, -3.5F}, 4, 0.5F, 0}};
  shade.build(spots, {0, 0});
  EXPECT_NEAR(sun_at(shade, {10.5F, -3.5F}), 127, 2);
  EXPECT_LT(sun_at(shade, {12.5F, -3.5F}), 127U);
  EXPECT_GT(sun_at(shade, {12.5F, -3.5F}), 10U);
  EXPECT_EQ(sun_at(shade, {15.5F, -3.5F}), 0U);
  EXPECT_TRUE(std::ranges::all_of(shade.words(), [](std::uint32_t word) {
    return (word & 0xFF00FF00U) == 0;
  })) << "nothing of the sky is missing";
}

TEST(ContactShadowMap, SpotsOverEachOtherLeaveAShareOfAShare) {
  ContactShadowMap shade;
  const std::array spots{GroundSpot{{0.5F, 0.5F}, 4, 0.5F, 1},
                         GroundSpot{{0.5F, 0.5F}, 4, 0.5F, 0}};
  shade.build(spots, {0, 0});
  EXPECT_NEAR(sun_at(shade, {0.5F, 0.5F}), 191, 2);
}

TEST(ContactShadowMap, CellsStayWhereTheyAreInTheWorld) {
  ContactShadowMap from, to;
  const std::array at{GroundSpot{{7.3F, 5.1F}, 3, 0.8F, 0.2F}};
  from.build(at, {100.25, 200.5});
  const std::array moved{GroundSpot{{6.9F, 5.0F}, 3, 0.8F, 0.2F}};
  to.build(moved, {100.65, 200.6});
  EXPECT_TRUE(std::ranges::equal(from.words(), to.words()));
  EXPECT_NE(from.corner(), to.corner());
}

TEST(ContactShadowMap, DiscsOutsideTheMapAndWithoutRadiusLeaveNothing) {
  ContactShadowMap shade;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::array spots{GroundSpot{{1000, 0}, 4, 1, 1},      GroundSpot{{0, 0}, 0, 1, 1},
                         GroundSpot{{0, 0}, -1, 1, 1},        GroundSpot{{nan, 0}, 4, 1, 1},
                         GroundSpot{{1e30F, 1e30F}, 4, 1, 1}, GroundSpot{{0, 0}, nan, 1, 1}};
  shade.build(spots, {0, 0});
  EXPECT_TRUE(std::ranges::all_of(shade.words(), [](std::uint32_t word) { return word == 0; }));
  const std::array border{GroundSpot{{-64, -64}, 3, 1, 1}, GroundSpot{{64, 64}, 3, 1, 1}};
  shade.build(border, {0, 0});
  EXPECT_NE(shade.words().front(), 0U);
  EXPECT_NE(shade.words().back(), 0U);
}

}  // namespace
}  // namespace psygen::render
