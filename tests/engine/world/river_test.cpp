// Rivers of a world file: beds and surfaces that never rise, flow, joins, and wrong input.
#include <gmock/gmock.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <future>
#include <glm/geometric.hpp>

#include "engine/models/edits.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/river_course.hpp"
#include "tests/engine/world/river_world.hpp"

namespace psygen::world {
namespace {

using ::testing::ElementsAre;
using testing::ground_in;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kBrookLand;
using testing::kBrookTable;
using testing::kLakeTable;
using testing::kRiverTable;
using testing::kSmallWorld;
using testing::kTheBrook;
using testing::kTheLake;
using testing::kTheRiver;
using testing::parsed;
using testing::registry;
using testing::replaced;
using testing::river_text;
using testing::river_world;

// A place on the middle of a river, `share` of its curve downstream.
struct Middle {
  glm::dvec2 at_m{0.0}, direction{1, 0};
};
Middle middle_of(const std::vector<CurvePoint>& curve, double share) {
  const double at = share * static_cast<double>(curve.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), curve.size() - 2);
  const glm::dvec2 along = curve[i + 1].at_m - curve[i].at_m;
  return {curve[i].at_m + along * (at - static_cast<double>(i)), along / length_of(along)};
}

std::string refusal(const std::string& tables, const std::string& land = kBrookLand) {
  models::Registry fresh = models::make_standard_registry();
  const auto world = parse_world(land + tables, "w.toml", fresh);
  return world ? "" : world.error().message;
}
std::vector<std::string> warnings(const std::string& tables, const std::string& land = kBrookLand) {
  models::Registry fresh = models::make_standard_registry();
  const auto world = parse_world(land + tables, "w.toml", fresh);
  if (!world) return {world.error().message};
  return world->shaped.warnings;
}

// 10^5 pairs of random places, the second one downstream.
TEST(River, NeverRisesDownstreamAndLiesAboveItsBed) {
  const World& world = river_world();
  core::RandomStream random(5, 0, 0, 0, core::Purpose::kPosition);
  for (std::size_t r = 0; r < world.shaped.rivers.size(); ++r) {
    const auto curve = river_curve(world, world.shaped.rivers[r]);
    std::vector<std::pair<double, WaterPoint>> samples;
    for (int i = 0; i < 50'000; ++i) {
      const double share = random.next_unit();
      samples.emplace_back(share, water_at(world, world.position(middle_of(curve, share).at_m)));
    }
    std::ranges::sort(samples, {}, &std::pair<double, WaterPoint>::first);
    int rises = 0, dry = 0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
      const WaterPoint& before = samples[i - 1].second;
      const WaterPoint& here = samples[i].second;
      rises += here.surface_m > before.surface_m + 1e-9 ? 1 : 0;
      dry += here.depth_m <= 0 ? 1 : 0;
    }
    EXPECT_EQ(rises, 0) << r;
    EXPECT_EQ(dry, 0) << r;
    EXPECT_GT(samples.front().second.surface_m, samples.back().second.surface_m + 20) << r;
  }
}

TEST(River, BedsNeverRiseByData) {
  const World& world = river_world();
  std::vector<const models::GroundEdit*> pieces = world.shaped.layer->ground.shapes.water_in(
      {models::QuadCoord::kMaxLevel, 0, 0}, world.block_size_m());
  std::ranges::sort(pieces, {}, &models::GroundEdit::id);
  double bed_m = 1e9, surface_m = 1e9;
  WaterBody body = kNoWater;
  int points = 0;
  for (const models::GroundEdit* piece : pieces) {
    if (!piece->river) continue;
    if (piece->river->body != body) bed_m = surface_m = 1e9;
    body = piece->river->body;
    for (const models::RiverPoint& p : piece->river->points) {
      ASSERT_LE(p.bed_m, bed_m);
      ASSERT_LE(p.surface_m, surface_m);
      ASSERT_LE(p.bed_m, p.surface_m - 0.35);
      ASSERT_NEAR(glm::length(p.direction), 1, 1e-12);
      bed_m = p.bed_m, surface_m = p.surface_m;
      ++points;
    }
  }
  EXPECT_GT(points, 300);
}

TEST(River, LeadsFromItsSpringThroughTheLakeIntoTheSea) {
  const World& world = river_world();
  EXPECT_THAT(world.shaped.warnings, IsEmpty());
  const auto curve = river_curve(world, world.shaped.rivers[0]);
  std::vector<WaterBody> bodies;
  for (int i = 0; i <= 2000; ++i) {
    const WaterPoint water = water_at(world, world.position(middle_of(curve, i / 2000.0).at_m));
    if (bodies.empty() || bodies.back() != water.body) bodies.push_back(water.body);
  }
  EXPECT_THAT(bodies, ElementsAre(kTheRiver, kTheLake, kTheRiver));
  const WaterPoint mouth = water_at(world, world.position(curve.back().at_m));
  EXPECT_EQ(mouth.surface_m, world.water.level_m);
  const WaterPoint beyond = water_at(world, world.position(curve.back().at_m - glm::dvec2(20, 0)));
  EXPECT_EQ(beyond.body, kSea);
}

TEST(River, TheBrookJoinsTheRiverAtItsSurface) {
  const World& world = river_world();
  const auto brook = river_curve(world, world.shaped.rivers[1]);
  const WaterPoint join = water_at(world, world.position(brook.back().at_m));
  EXPECT_EQ(join.body, kTheRiver);
  double last_m = 0;
  for (const CurvePoint& point : brook) {
    const WaterPoint water = water_at(world, world.position(point.at_m));
    if (water.body == kTheBrook) last_m = water.surface_m;
  }
  EXPECT_NEAR(last_m, join.surface_m, 0.1);
  // A file may name the brook first.
  const World other = parsed(std::string(kBrookLand) + kLakeTable + kBrookTable + kRiverTable);
  EXPECT_THAT(other.shaped.warnings, IsEmpty());
  for (int i = 0; i < 400; ++i) {
    const auto at = world.position(middle_of(brook, i / 400.0).at_m);
    EXPECT_EQ(water_at(world, at).surface_m, water_at(other, at).surface_m);
    EXPECT_EQ(water_at(world, at).depth_m, water_at(other, at).depth_m);
  }
}

TEST(River, FlowsDownstreamWithItsDischarge) {
  const World world = parsed(std::string(kBrookLand) +
                             replaced(kRiverTable, "bank_m = 8", "bank_m = 8\ndischarge_m3_s = 3"));
  const auto curve = river_curve(world, world.shaped.rivers[0]);
  int measured = 0;
  for (double share = 0.05; share < 0.75; share += 0.01) {
    const Middle middle = middle_of(curve, share);
    const glm::dvec2 side{-middle.direction.y, middle.direction.x};
    const auto here = water_surface(world, world.position(middle.at_m));
    ASSERT_TRUE(here);
    const glm::dvec2 flow(here->flow_m_s);
    ASSERT_GT(glm::dot(flow, middle.direction), 0.95 * glm::length(flow));
    double discharge = 0;
    constexpr double kStepM = 0.05;
    for (double across = -8; across <= 8; across += kStepM) {
      const WaterPoint water = water_at(world, world.position(middle.at_m + side * across));
      discharge += glm::length(glm::dvec2(water.flow_m_s)) * water.depth_m * kStepM;
    }
    EXPECT_NEAR(discharge, 3, 0.9) << share;  // the bed has cells of a metre
    ++measured;
  }
  EXPECT_GT(measured, 60);
}

TEST(River, FoamsWhereItFallsAndItsNormalLeansDownstream) {
  const World& world = river_world();
  const auto curve = river_curve(world, world.shaped.rivers[0]);
  float most = 0, least = 1;
  double steepest = 0;
  for (int i = 0; i < 1000; ++i) {
    const Middle middle = middle_of(curve, i / 1000.0);
    const auto water = water_surface(world, world.position(middle.at_m));
    ASSERT_TRUE(water);
    most = std::max(most, water->foam), least = std::min(least, water->foam);
    ASSERT_NEAR(glm::length(water->normal), 1, 1e-6);
    const glm::dvec2 lean(water->normal.x, water->normal.z);
    ASSERT_GE(glm::dot(lean, middle.direction), -1e-6);
    steepest = std::max(steepest, glm::length(lean));
  }
  EXPECT_GT(steepest, 0.25);
  EXPECT_GT(most, 0.9F);
  EXPECT_EQ(least, 0);
}

TEST(River, AnswersTheSameFromAnyBlockThreadAndRoundingMode) {
  const World& world = river_world();
  const double block_m = world.block_size_m();
  const auto answers = [&](int mode) {
    std::vector<double> all;
    std::fesetround(mode);
    for (int i = 0; i < 4000; ++i) {
      // Positions with exact metres, named from another block.
      const glm::dvec2 at_m{1600 + 0.125 * (i % 2000), 1600 + 0.25 * (i / 5)};
      const std::int32_t x = i % 40, z = i % 37;
      const core::WorldPosition at{{x, z}, {at_m.x - x * block_m, 0, at_m.y - z * block_m}};
      const WaterPoint water = water_at(world, at);
      for (const double v : {water.surface_m, water.depth_m, double{water.flow_m_s.x},
                             double{water.flow_m_s.y}, double{water.foam}, double(water.body)})
        all.push_back(v);
    }
    std::fesetround(FE_TONEAREST);
    return all;
  };
  const auto expected = answers(FE_TONEAREST);
  int wet = 0;
  for (std::size_t i = 1; i < expected.size(); i += 6)
    wet += expected[i] > 0 ? 1 : 0;
  EXPECT_GT(wet, 300);
  std::vector<std::future<std::vector<double>>> others;
  for (const int mode : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD})
    others.push_back(std::async(std::launch::async, answers, mode));
  for (auto& other : others)
    EXPECT_EQ(other.get(), expected);
}

TEST(River, ShapesTheSameGroundInNeighbouringBlocksAndCoarseNodes) {
  const World& world = river_world();
  const auto last = static_cast<std::size_t>(world.terrain.integer(models::kTerrainSize) - 1);
  std::vector<std::uint16_t> here((last + 1) * (last + 1)), next = here;
  int compared = 0;
  for (std::int32_t x = 24; x < 34; ++x) {
    const core::BlockCoord block{x, 26};
    models::BlockGround(world.terrain, block, here.size()).heights(here);
    models::BlockGround(world.terrain, {x + 1, 26}, here.size()).heights(next);
    for (std::size_t k = 0; k <= last; ++k, ++compared)
      ASSERT_EQ(here[k * (last + 1) + last], next[k * (last + 1)]);
  }
  EXPECT_EQ(compared, 650);
}

TEST(River, DigsItsBedAndLeavesTheGroundBeyondItsBanks) {
  const World& world = river_world();
  const World base = parsed(kBrookLand);
  const auto curve = river_curve(world, world.shaped.rivers[1]);
  for (double share = 0.1; share < 0.8; share += 0.01) {
    const Middle middle = middle_of(curve, share);
    const glm::dvec2 side{-middle.direction.y, middle.direction.x};
    EXPECT_LT(ground_in(world, middle.at_m), ground_in(base, middle.at_m) - 0.5);
    for (double across = -60; across <= 60; across += 1.5)
      ASSERT_LE(ground_in(world, middle.at_m + side * across),
                ground_in(base, middle.at_m + side * across) + 0.003);
  }
  EXPECT_EQ(ground_in(world, {1750, 1300}), ground_in(base, {1750, 1300}));
}

// Beside water there is higher ground, or lower water.
TEST(River, HoldsItsWater) {
  const World& world = river_world();
  constexpr int kSide = 240;
  std::vector<double> ground_m;
  std::vector<std::optional<WaterSurface>> water;
  for (int i = 0; i < kSide * kSide; ++i) {
    const glm::dvec2 at_m{1630 + i % kSide, 1580 + i / kSide};
    ground_m.push_back(ground_in(world, at_m));
    water.push_back(water_surface(world, world.position(at_m)));
    if (water.back() && water.back()->body == kSea && ground_m.back() >= world.water.level_m)
      water.back().reset();
  }
  int wet = 0, leaks = 0;
  for (int i = kSide; i < kSide * (kSide - 1); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (i % kSide == 0 || i % kSide == kSide - 1) continue;
    if (!water[at] || water[at]->body == kSea || water[at]->depth_over(ground_m[at]) <= 0) continue;
    ++wet;
    for (const int way : {-kSide, -1, 1, kSide}) {
      const auto beside = static_cast<std::size_t>(i + way);
      leaks += !water[beside] && ground_m[beside] < water[at]->surface_m - 0.05 ? 1 : 0;
    }
  }
  EXPECT_GT(wet, 6000);
  EXPECT_LE(leaks, 4);
}

TEST(River, AWorldWithoutRiversKeepsItsHashes) {
  const World before = parsed(kBrookLand);
  EXPECT_EQ(shape_hash(before), 0U);
  EXPECT_EQ(bodies_hash_in(before, {27, 26}), 0U);
  EXPECT_EQ(before.layer(), nullptr);
  EXPECT_NE(shape_hash(river_world()), 0U);
  EXPECT_NE(bodies_hash_in(river_world(), {27, 26}), 0U);
  EXPECT_EQ(bodies_hash_in(river_world(), {2, 2}), 0U);
}

TEST(River, WrongCoursesAreRejectedInOneSentence) {
  const auto river = [](const std::string& points, const std::string& more = "") {
    return "[[river]]\npoints_m = " + points + "\n" + more;
  };
  const std::vector<std::pair<std::string, std::string>> cases{
      {river("[[100, 100]]"), "must be 2 to 1000 points"},
      {river("[[100, 100], [100.5, 100]]"), "point 1 must be at least 1 m from the previous one"},
      {river("[[100, 100], [nan, 100]]"), "point 1 must be [x, z]"},
      {river("[[100, 100], [300, 100]]", "width_m = 0\n"), "width_m"},
      {river("[[100, 100], [300, 100]]", "width_m = 1.5\n"), "narrower than two cells"},
      {river("[[100, 100], [300, 100]]", "width_m = [4, 5, 6]\n"),
       "one number, or one for each of the 2 points, not 3 numbers"},
      {river("[[100, 100], [300, 100]]", "depth_m = [1, nan]\n"), "number 1 must be 0.1 to 100"},
      {river("[[100, 100], [300, 100]]", "discharge_m3_s = -1\n"), "discharge_m3_s"},
      {river("[[100, 100], [4000, 100]]"), "the river leaves the world at"},
      {river("[[100, 100], [300, 100], [300, 200], [200, 50]]"), "the river crosses itself near"},
      {river("[[1600, 1400], [1900, 1400]]") + kBrookTable, "the river crosses another river near"},
      {river("[[100, 100], [300, 100], [500, 100]]") + river("[[200, 100], [400, 100]]"),
       "the whole river lies in another river"},
  };
  for (const auto& [tables, sentence] : cases) {
    const std::string message = refusal(tables);
    EXPECT_THAT(message, HasSubstr(sentence)) << tables;
    EXPECT_THAT(message, HasSubstr("river")) << tables;
    EXPECT_EQ(std::ranges::count(message, '\n'), 0) << message;
  }
}

TEST(River, TellsItsDischarge) {
  const World& world = river_world();
  const auto curve = river_curve(world, world.shaped.rivers[0]);
  const auto discharge_at = [&](const World& of, glm::dvec2 at_m) {
    const auto surface = water_surface(of, of.position(at_m));
    return surface ? surface->discharge_m3_s : std::nullopt;
  };
  int rivers = 0, lakes = 0;
  for (int i = 0; i <= 500; ++i) {
    const glm::dvec2 at_m = middle_of(curve, i / 500.0).at_m;
    const auto found = discharge_at(world, at_m);
    const WaterBody body = water_at(world, world.position(at_m)).body;
    ASSERT_EQ(found.has_value(), body == kTheRiver) << i;
    ++(found ? rivers : lakes);
    // The mean speed through two thirds of width times depth, below the fastest.
    if (found) {
      EXPECT_GT(*found, 0.2);
      EXPECT_LT(*found, 40);
    }
  }
  EXPECT_GT(rivers, 200);
  EXPECT_GT(lakes, 50);
  EXPECT_FALSE(discharge_at(world, curve.back().at_m - glm::dvec2(20, 0))) << "the sea";
  EXPECT_FALSE(discharge_at(world, {2100, 1200})) << "dry land";
  const std::string text = std::string(kBrookLand) + replaced(kBrookTable, "depth_m = 0.7",
                                                              "depth_m = 0.7\ndischarge_m3_s = "
                                                              "[3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 9]");
  const World given = parsed(text);
  EXPECT_NEAR(discharge_at(given, {1852, 1330}).value_or(0), 3, 1e-9);
  const auto brook = river_curve(given, given.shaped.rivers[0]);
  const auto near_mouth = discharge_at(given, middle_of(brook, 0.96).at_m);
  EXPECT_GT(near_mouth.value_or(0), 4);
  EXPECT_LT(near_mouth.value_or(0), 9);
}

TEST(River, DoubtfulCoursesGetAWarningWithTheirName) {
  const auto climbing = warnings("[[river]]\npoints_m = [[1560, 1655], [2150, 1750]]\n");
  ASSERT_FALSE(climbing.empty());
  EXPECT_THAT(climbing[0], HasSubstr("river 1: it cuts 6"));
  EXPECT_THAT(climbing[0], HasSubstr("because its course climbs there"));
  EXPECT_THAT(warnings("[[river]]\npoints_m = [[2150, 1750], [1960, 1752]]\n"),
              ElementsAre(HasSubstr("river 1: it ends on dry land at 1960.0, 1752.0 m")));
  EXPECT_THAT(warnings(kBrookTable), IsEmpty()) << "it ends in the sea";
  EXPECT_THAT(warnings("[[river]]\npoints_m = [[40, 600], [6, 600]]\n",
                       replaced(kBrookLand, "level_m = 26.25", "level_m = -5")),
              IsEmpty())
      << "it ends at the border of the world";
  // Two rivers in a row.
  EXPECT_THAT(warnings("[[river]]\npoints_m = [[1850, 1700], [1700, 1650], [1560, 1655]]\n"
                       "[[river]]\npoints_m = [[2150, 1750], [1990, 1740], [1850, 1700]]\n"),
              IsEmpty());
}

TEST(River, MustBeginOrEndInAnother) {
  EXPECT_EQ(refusal("[[river]]\npoints_m = [[1850, 1700], [1700, 1650], [1560, 1655]]\n"
                    "[[river]]\npoints_m = [[2150, 1750], [1990, 1740], [1850, 1700]]\n"),
            "");
  EXPECT_THAT(refusal("[[river]]\npoints_m = [[1850, 1700], [1700, 1650], [1600, 1800]]\n"
                      "[[river]]\npoints_m = [[1600, 1800], [1990, 1840], [1850, 1700]]\n"),
              HasSubstr("rivers end in each other in a circle"));
}

}  // namespace
}  // namespace psygen::world
