// Lakes of a world file: level, bed and shore, and wrong input.
#include <gmock/gmock.h>

#include <cmath>

#include "engine/world/curve.hpp"
#include "tests/engine/world/river_world.hpp"

namespace psygen::world {
namespace {

using ::testing::ElementsAre;
using testing::ground_in;
using ::testing::HasSubstr;
using testing::kBrookLand;
using testing::kLakeTable;
using testing::kTheLake;
using testing::parsed;
using testing::replaced;

std::string refusal(const std::string& tables, const std::string& land = kBrookLand) {
  models::Registry fresh = models::make_standard_registry();
  const auto world = parse_world(land + tables, "w.toml", fresh);
  return world ? "" : world.error().message;
}

World round_lake(const std::string& more = "") {
  return parsed(std::string(kBrookLand) +
                "[[lake]]\ncentre_m = [1000, 1000]\nradius_m = 100\ndepth_m = 6\nshore_m = 20\n" +
                more);
}

TEST(Lake, LiesAtTheLowestGroundOfItsOutlineByDefault) {
  const World world = round_lake(), base = parsed(kBrookLand);
  double lowest_m = 1e9;
  for (int i = 0; i < 3600; ++i) {
    const double angle = i * 0.1 * 3.14159265358979 / 180;
    lowest_m = std::min(
        lowest_m, ground_in(base, {1000 + 100 * std::cos(angle), 1000 + 100 * std::sin(angle)}));
  }
  const WaterPoint middle = water_at(world, world.position({1000, 1000}));
  EXPECT_EQ(middle.body, kTheLake);
  EXPECT_NEAR(middle.surface_m, lowest_m, 0.15);
  EXPECT_NEAR(middle.depth_m, 6, 0.02);
  EXPECT_EQ(middle.flow_m_s, glm::vec2(0.0F));
}

TEST(Lake, IsWetInsideItsOutlineAndDryOutside) {
  for (const char* level : {"", "spill_m = 60\n", "spill_m = 90\n"}) {
    const World world = round_lake(level);
    const double level_m = water_at(world, world.position({1000, 1000})).surface_m;
    int wet = 0, dry = 0;
    for (double z = -140; z <= 140; z += 1.7) {
      for (double x = -140; x <= 140; x += 1.7) {
        const double away_m = std::hypot(x, z);
        const WaterPoint water = water_at(world, world.position({1000 + x, 1000 + z}));
        if (away_m < 97) {
          ASSERT_EQ(water.body, kTheLake) << x << ' ' << z;
          ASSERT_EQ(water.surface_m, level_m);
          ASSERT_LE(water.depth_m, away_m < 80 ? 200 : 6.1);
          if (away_m < 75) {
            ASSERT_GE(water.depth_m, 5.98);
          }
          ++wet;
        } else if (away_m > 103) {
          ASSERT_TRUE(water.is_dry()) << x << ' ' << z << ' ' << level;
          ++dry;
        }
      }
    }
    EXPECT_GT(wet, 5000);
    EXPECT_GT(dry, 5000);
  }
}

// A lake that bends needs the right side of its outline everywhere, over all tiles.
TEST(Lake, AnOutlineWithBaysHasTheRightSideEverywhere) {
  const World world =
      parsed(std::string(kBrookLand) +
             "[[lake]]\npoints_m = [[800, 800], [1200, 780], [1180, 1000], [1010, 1015], "
             "[1000, 1100], [1190, 1120], [1200, 1300], [820, 1290]]\nspill_m = 80\n"
             "shore_m = 5\n");
  const auto outline = closed_curve_through(world.shaped.lakes[0].points_m, 420 / 80.0);
  const auto inside = [&](glm::dvec2 at) {
    bool in = false;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const glm::dvec2 a = outline[i], b = outline[(i + 1) % outline.size()];
      if ((a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x))
        in = !in;
    }
    return in;
  };
  const auto away_m = [&](glm::dvec2 at) {
    double nearest = 1e9;
    for (const glm::dvec2& corner : outline)
      nearest = std::min(nearest, length_of(corner - at));
    return nearest;
  };
  int wet = 0, dry = 0;
  for (double z = 760; z <= 1330; z += 3.1) {
    for (double x = 770; x <= 1230; x += 3.1) {
      if (away_m({x, z}) < 7) continue;
      const auto water = water_surface(world, world.position({x, z}));
      ASSERT_EQ(water && water->body == kTheLake, inside({x, z})) << x << ' ' << z;
      ++(water ? wet : dry);
    }
  }
  EXPECT_GT(wet, 5000);
}

TEST(Lake, ChangesNoGroundBeyondItsShore) {
  const World world = round_lake(), base = parsed(kBrookLand);
  for (int i = 0; i < 360; ++i) {
    const double angle = i * 3.14159265358979 / 180;
    const glm::dvec2 at{1000 + 123 * std::cos(angle), 1000 + 123 * std::sin(angle)};
    EXPECT_EQ(ground_in(world, at), ground_in(base, at));
  }
}

TEST(Lake, TheSeaOwnsItsPlaceWhereItIsHigher) {
  World world = round_lake();
  const core::WorldPosition at = world.position({1000, 1000});
  world.water.level_m = water_at(world, at).surface_m + 1;  // a sea that rises later
  EXPECT_EQ(water_at(world, at).body, kSea);
}

TEST(Lake, WrongLakesAreRejectedInOneSentence) {
  const auto lake = [](const std::string& keys) { return "[[lake]]\n" + keys + "\n"; };
  const std::vector<std::pair<std::string, std::string>> cases{
      {lake("centre_m = [900, 900]\nradius_m = 0"), "radius_m"},
      {lake("centre_m = [900, 900]"), "radius_m"},
      {lake("radius_m = 50"), "centre_m"},
      {lake("centre_m = [nan, 900]\nradius_m = 50"), "centre_m"},
      {lake("depth_m = 3"), "points_m"},
      {lake("points_m = [[0, 0], [9, 9]]"), "3 to 1000 points"},
      {lake("points_m = [[900, 900], [990, 900], [990, 990], [900, 900]]"),
       "the outline closes by itself"},
      {lake("points_m = [[900, 900], [990, 990], [990, 900], [900, 990]]"),
       "the outline crosses itself near"},
      {lake(
           "centre_m = [900, 900]\nradius_m = 50\npoints_m = [[900, 900], [990, 990], [990, 900]]"),
       "a lake has an outline or a circle, not both"},
      {lake("centre_m = [60, 900]\nradius_m = 60"), "the lake with its shore leaves the world"},
      {lake("centre_m = [1500, 1500]\nradius_m = 1530"), "as large as the world"},
      {lake("centre_m = [1500, 1500]\nradius_m = 2001"), "radius_m"},
      {lake("centre_m = [900, 900]\nradius_m = 1.5"), "narrower than four cells"},
      {lake("centre_m = [900, 900]\nradius_m = 50\nspill_m = 141"),
       "a surface at 141 m is not allowed: it must be 0 to 140 m"},
      {lake("centre_m = [900, 900]\nradius_m = 50\nspill_m = -1"), "a surface at -1 m is not"},
      {lake("centre_m = [900, 900]\nradius_m = 50\nspill_m = nan"), "spill_m"},
      {lake("centre_m = [900, 900]\nradius_m = 50\nspill_m = 20"), "would lie below the sea"},
      {lake("centre_m = [900, 900]\nradius_m = 50") + lake("centre_m = [990, 900]\nradius_m = 50"),
       "the lake overlaps another lake near"},
      {lake("centre_m = [900, 900]\nradius_m = 30") + lake("centre_m = [900, 900]\nradius_m = 90"),
       "the lake overlaps another lake near"},
  };
  for (const auto& [tables, sentence] : cases) {
    const std::string message = refusal(tables);
    EXPECT_THAT(message, HasSubstr(sentence)) << tables;
    EXPECT_THAT(message, HasSubstr("lake")) << tables;
  }
  const std::string endless = replaced(kBrookLand, "[48, 48]", "[0, 0]");
  EXPECT_THAT(refusal(lake("points_m = [[0, 0], [5000, 0], [0, 5000]]"), endless),
              HasSubstr("the lake is 5000 m wide, but at most 4000 m are allowed"));
  EXPECT_THAT(refusal(lake("centre_m = [900, 900]\nradius_m = 300"),
                      std::string(kBrookLand) + "[rivers]\nroot_spacing_m = 1024\nhalvings = 5\n"),
              HasSubstr("the lake overlaps a river or lake of the river network near"));
}

TEST(Lake, AHighDamGetsAWarning) {
  EXPECT_THAT(round_lake("spill_m = 100\n").shaped.warnings,
              ElementsAre(HasSubstr("lake 1: its surface at 100.0 m needs a dam of")));
}

}  // namespace
}  // namespace psygen::world
