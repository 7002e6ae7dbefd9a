// Warnings of roads that lead through water.
#include "engine/world/road_crossings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/engine/world/network_world.hpp"
#include "tests/engine/world/river_world.hpp"

namespace psygen::world {
namespace {

using namespace testing;  // worlds
using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

std::string road(const std::string& points) {
  return "[[road]]\npoints_m = [" + points + "]\n";
}

TEST(RoadCrossings, ARoadOverARiverGetsAWarningWithItsPlaceAndLength) {
  const World world = parsed(river_text() + road("[1860, 1650], [1866, 1700], [1880, 1760]"));
  // The river is 6 m wide there, and the road crosses it at a slant.
  EXPECT_THAT(world.shaped.warnings,
              ElementsAre(AllOf(StartsWith("road 1: it crosses river 1 at 186"),
                                EndsWith(" m, 6 m long, and has no bridge there"))));
  const auto same = road_crossings(world, *world.shaped.layer);
  EXPECT_EQ(same, world.shaped.warnings);
}

TEST(RoadCrossings, EachRoadIsNamedAndDryOnesAreNot) {
  const World world = parsed(river_text() + road("[2100, 1200], [2150, 1250]") +
                             road("[1740, 1780], [1740, 1690]"));
  EXPECT_THAT(world.shaped.warnings,
              ElementsAre(StartsWith("road 2: it leads into lake 1 at 174")));
  EXPECT_THAT(parsed(std::string(kBrookLand) + road("[2100, 1200], [2150, 1250]")).shaped.warnings,
              IsEmpty());
}

TEST(RoadCrossings, ARoadBelowTheSeaGetsAWarning) {
  const World world = parsed(std::string(kBrookLand) + road("[1560, 1655], [1760, 1480]"));
  EXPECT_THAT(world.shaped.warnings, ElementsAre(HasSubstr("it leads into the sea at 160")));
}

TEST(RoadCrossings, ARoadThroughANetworkCrossesItsRivers) {
  const World world = parsed(network_text() + road("[0, 0], [700, 400], [1500, 300]"));
  const auto& found = world.shaped.warnings;
  ASSERT_FALSE(found.empty());
  EXPECT_THAT(found, Each(StartsWith("road 1: it ")));
  EXPECT_THAT(found, ::testing::Contains(HasSubstr("crosses a river of the network at ")));
  // The places are those of the water.
  for (const std::string& sentence : found) {
    double x_m = 0, z_m = 0;
    const auto at = sentence.find(" at ");
    ASSERT_NE(at, std::string::npos) << sentence;
    ASSERT_EQ(std::sscanf(sentence.c_str() + at, " at %lf, %lf m,", &x_m, &z_m), 2) << sentence;
    const core::WorldPosition place = world.position({x_m, z_m});
    const bool is_river = sentence.find("a river of the network") != std::string::npos;
    const auto surface = water_surface(world, place);
    ASSERT_TRUE(surface) << sentence;
    EXPECT_EQ(surface->discharge_m3_s.has_value(), is_river) << sentence;
  }
}

TEST(RoadCrossings, ManyCrossingsAreCounted) {
  std::string points;
  for (int i = 0; i < 24; ++i)
    points += (i > 0 ? ", [" : "[") + std::to_string(1950 + 3 * i) + ", " +
              std::to_string(i % 2 == 0 ? 1700 : 1790) + "]";
  const World world = parsed(river_text() + road(points) + "width_m = 2\nborder_m = 0\n");
  ASSERT_EQ(world.shaped.warnings.size(), kMaxCrossings + 1);
  EXPECT_THAT(
      world.shaped.warnings.back(),
      ::testing::MatchesRegex("road 1: it meets water at 1[0-9] more places, without a bridge"));
}

}  // namespace
}  // namespace psygen::world
