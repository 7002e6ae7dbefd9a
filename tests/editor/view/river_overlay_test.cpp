// The map of a river network, its lines over the view, and the water under the pointer.
#include "editor/view/river_overlay.hpp"

#include <gtest/gtest.h>

#include <QDeadlineTimer>
#include <QThread>
#include <cmath>
#include <glm/geometric.hpp>

#include "editor/view/water_probe.hpp"
#include "engine/world/water.hpp"
#include "tests/engine/world/network_world.hpp"
#include "tests/engine/world/river_world.hpp"

namespace psygen::editor {
namespace {

using world::World;
using world::testing::network_text;
using world::testing::parsed;

const World& network_world() {
  static const World world = parsed(network_text());
  return world;
}

RiverMap map_of(const World& world, glm::dvec2 at_m, glm::dvec2 blocks = glm::dvec2(0.0)) {
  const std::atomic<bool> never{false};
  return make_river_map(*world.network(), world.position(at_m), blocks, never);
}

core::WorldPosition place(const World& world, const RiverMap& map, const glm::vec3& from_corner) {
  return core::normalised({map.corner, glm::dvec3(from_corner)}, world.block_size_m());
}

TEST(RiverMap, ItsNearChannelsLieInTheRiversOfTheWorld) {
  const World& world = network_world();
  const RiverMap map = map_of(world, {3000, 2000});
  std::size_t near = 0, wet = 0, equal = 0;
  for (const RiverMap::Channel& channel : map.channels) {
    const glm::vec3 middle = 0.5F * (channel.line.from + channel.line.to);
    if (std::max(std::abs(middle.x), std::abs(middle.z)) > 0.7 * map.near_m) continue;
    ++near;
    const core::WorldPosition at = place(world, map, middle);
    const auto water = world::water_surface(world, at);
    const bool in_sea = double{middle.y} < world.water.level_m + 0.1;
    if (!water || (water->body == world::kSea && !in_sea)) continue;
    ++wet;
    EXPECT_EQ(channel.width_px, river_width_px(double{channel.discharge_m3_s}));
    EXPECT_NEAR(water->surface_m, double{middle.y}, 2);
    const double discharge_m3_s = water->discharge_m3_s.value_or(0);
    if (std::abs(discharge_m3_s - double{channel.discharge_m3_s}) < 1e-6) ++equal;
  }
  EXPECT_GT(near, 300U);
  EXPECT_GT(20 * wet, 19 * near);
  EXPECT_GT(10 * equal, 8 * near);
}

TEST(RiverMap, CoversSixteenTimesTheNearSquareWithBoundedWork) {
  const World& world = network_world();
  for (const glm::dvec2 at_m : {glm::dvec2(0, 0), glm::dvec2(-400'000, 1e6), glm::dvec2(3e7, 5)}) {
    const RiverMap map = map_of(world, at_m);
    double farthest_m = 0;
    for (const RiverMap::Channel& channel : map.channels)
      farthest_m = std::max(farthest_m, double{std::abs(channel.line.from.x)});
    EXPECT_GT(farthest_m, 6 * map.near_m);
    EXPECT_LT(farthest_m, 10 * map.near_m);
    EXPECT_LT(map.channels.size(), 40'000U);
    EXPECT_LT(map.shores.size(), 20'000U);
    EXPECT_GT(map.shores.size(), 50U);
    EXPECT_GT(map.divides.size(), 50U);
    EXPECT_LT(map.divides.size(), 20'000U);
  }
}

TEST(RiverMap, ItsShoresPartWaterFromLand) {
  const World& world = network_world();
  const RiverMap map = map_of(world, {3000, 2000});
  std::size_t near = 0, parts = 0;
  for (const RiverMap::Line& shore : map.shores) {
    const glm::vec3 middle = 0.5F * (shore.from + shore.to), along = shore.to - shore.from;
    if (std::max(std::abs(middle.x), std::abs(middle.z)) > 0.7 * map.near_m) continue;
    if (glm::length(along) < 1) continue;
    ++near;
    const glm::vec3 across = 12.0F * glm::normalize(glm::vec3(-along.z, 0, along.x));
    const auto depth_m = [&](const glm::vec3& at) {
      return world::water_at(world, place(world, map, at)).depth_m;
    };
    if ((depth_m(middle + across) > 0) != (depth_m(middle - across) > 0)) ++parts;
  }
  ASSERT_GT(near, 30U);
  EXPECT_GT(10 * parts, 8 * near) << parts << " of " << near;
}

TEST(RiverMap, OfABoundedWorldEndsAtItsBorder) {
  const World& world = network_world();
  const RiverMap map = map_of(world, {1000, 1000}, {40, 50});
  ASSERT_FALSE(map.channels.empty());
  const double block_m = world.block_size_m();
  for (const RiverMap::Channel& channel : map.channels) {
    const glm::dvec2 at_m = glm::dvec2(channel.line.from.x, channel.line.from.z) +
                            glm::dvec2(map.corner.x, map.corner.z) * block_m;
    EXPECT_GT(at_m.x, -200);
    EXPECT_LT(at_m.x, 40 * block_m + 200);
    EXPECT_GT(at_m.y, -200);
    EXPECT_LT(at_m.y, 50 * block_m + 200);
  }
}

TEST(RiverMap, ACancelledOneIsEmpty) {
  const std::atomic<bool> always{true};
  const RiverMap map = make_river_map(*network_world().network(), {}, glm::dvec2(0.0), always);
  EXPECT_TRUE(map.channels.empty() && map.shores.empty() && map.divides.empty());
}

TEST(RiverLook, WiderLinesAreLargerRivers) {
  EXPECT_EQ(river_width_px(0), 1);
  EXPECT_EQ(river_width_px(0.001), 1);
  EXPECT_EQ(river_width_px(1000), kMaxRiverPx);
  int before = 1;
  for (double discharge = 0.001; discharge < 100; discharge *= 1.5) {
    EXPECT_GE(river_width_px(discharge), before);
    before = river_width_px(discharge);
  }
  EXPECT_NE(river_colour(river_width_px(0.01)), river_colour(river_width_px(0.3)));
  EXPECT_NE(river_colour(river_width_px(10)), river_colour(river_width_px(0.3)));
}

// So a legend with these discharges shows the look of each channel.
TEST(RiverLook, EachWidthHasItsDischargeAndColour) {
  for (int px = 1; px <= kMaxRiverPx; ++px) {
    EXPECT_EQ(river_width_px(usual_discharge_m3_s(px)), px);
    EXPECT_EQ(river_width_px(3 * usual_discharge_m3_s(px)), px);
    EXPECT_EQ(river_width_px(usual_discharge_m3_s(px) / 3), px);
    for (int other = 1; other < px; ++other)
      EXPECT_GT(glm::distance(river_colour(px), river_colour(other)), 0.2F) << px << ' ' << other;
  }
}

TEST(RiverLines, EndAtTheirLimitAndAtADistance) {
  const auto map_with = [](std::size_t channels, float x_m, int width_px) {
    RiverMap map;
    map.near_m = 1000;
    map.channels.assign(channels, {{{x_m, 5, 0}, {x_m, 5, 10}}, 1, width_px});
    return map;
  };
  std::vector<render::Line> lines(7);  // of others
  const auto added = [&](const RiverMap& map) {
    lines.resize(7);
    add_river_lines(map, {{0, 0}, {0, 20, 0}}, 64, 0.001, lines);
    return lines.size() - 7;
  };
  EXPECT_EQ(added(map_with(100, 50, 3)), 300U);
  EXPECT_EQ(added(map_with(100, 1500, 3)), 200U) << "thin far away";
  EXPECT_EQ(added(map_with(100, 3100, 3)), 0U);
  EXPECT_EQ(added(map_with(kMaxRiverLines / 2, 50, 3)), kMaxRiverLines);
  RiverMap map = map_with(kMaxRiverLines, 50, 3);
  map.shores.assign(20, {{50, 5, 0}, {50, 5, 10}});
  EXPECT_EQ(added(map), kMaxRiverLines);
  EXPECT_EQ(lines[26].colour, kShoreColour);
  EXPECT_EQ(lines[27].colour, river_colour(3));
}

// Follows until a map is there or the work ends.
void follow(RiverOverlay& overlay, const World& world, const core::WorldPosition& eye) {
  const QDeadlineTimer end(60'000);
  do {
    overlay.follow(world, eye);
    QThread::msleep(2);
  } while (overlay.is_busy() && !end.hasExpired());
  overlay.follow(world, eye);
}

TEST(RiverOverlay, FollowsSwitchCameraAndWorld) {
  const World& world = network_world();
  const core::WorldPosition eye = world.position({3000, 2000});
  RiverOverlay overlay;
  std::vector<render::Line> lines;
  const auto add = [&](const core::WorldPosition& from) {
    lines.clear();
    add_river_lines(*overlay.map(), from, world.block_size_m(), 0.001, lines);
  };
  follow(overlay, world, eye);
  EXPECT_EQ(overlay.map(), nullptr) << "off at first";
  overlay.set_on(true);
  overlay.follow(world, eye);
  EXPECT_EQ(overlay.map(), nullptr) << "no frame waits for a map";
  follow(overlay, world, eye);
  ASSERT_NE(overlay.map(), nullptr);
  add(eye);
  EXPECT_GT(lines.size(), 1000U);
  for (const render::Line& line : lines)
    ASSERT_LT(double{glm::length(line.from)}, 3.5 * overlay.map()->near_m);
  const auto before = overlay.map();
  const glm::vec3 first = lines.front().from;
  core::WorldPosition aside = eye;
  aside.local.x += 10;
  follow(overlay, world, aside);
  EXPECT_EQ(overlay.map(), before) << "a small move keeps the map";
  add(aside);
  EXPECT_NEAR(double{first.x - lines.front().from.x}, 10, 0.6);
  follow(overlay, world, world.position({3000 + before->near_m, 2000}));
  EXPECT_NE(overlay.map(), before);
  const auto far = overlay.map();
  const World other = parsed(world::testing::replaced(network_text(), "seed = 11", "seed = 12"));
  follow(overlay, other, other.position({3000 + before->near_m, 2000}));
  EXPECT_NE(overlay.map(), far) << "another network";
  follow(overlay, parsed(world::testing::kNetworkLand), eye);
  EXPECT_EQ(overlay.map(), nullptr) << "no network";
  overlay.set_on(false);
  follow(overlay, world, eye);
  EXPECT_EQ(overlay.map(), nullptr);
}

// A complete map differs from a part of it, and from that of another world.
std::size_t size_of(const RiverMap& map) {
  return map.channels.size() + map.shores.size() + map.divides.size();
}

void follow_to_first(RiverOverlay& overlay, const World& world, const core::WorldPosition& eye) {
  const QDeadlineTimer end(60'000);
  while (overlay.map() == nullptr && !end.hasExpired()) {
    overlay.follow(world, eye);
    QThread::msleep(1);
  }
}

TEST(RiverOverlay, DropsAMapInWorkThatIsNeededNoLonger) {
  const World& world = network_world();
  const World other = parsed(world::testing::replaced(network_text(), "seed = 11", "seed = 12"));
  const World small =
      parsed(world::testing::replaced(network_text(), "blocks = [0, 0]", "blocks = [40, 50]"));
  const core::WorldPosition eye = world.position({1000, 1000});
  const std::size_t expected = size_of(map_of(world, {1000, 1000}));
  for (const World* before : {&other, &small}) {
    RiverOverlay overlay;
    overlay.set_on(true);
    overlay.follow(*before, eye);
    ASSERT_TRUE(overlay.is_busy());
    follow_to_first(overlay, world, eye);
    ASSERT_NE(overlay.map(), nullptr);
    EXPECT_EQ(size_of(*overlay.map()), expected) << "no map of the other world comes first";
  }
  RiverOverlay overlay;
  overlay.set_on(true);
  overlay.follow(world, eye);
  overlay.set_on(false);
  overlay.follow(world, eye);
  overlay.set_on(true);
  follow_to_first(overlay, world, eye);
  ASSERT_NE(overlay.map(), nullptr);
  EXPECT_EQ(size_of(*overlay.map()), expected) << "no part of a map is shown";
}

TEST(RiverOverlay, MakesAnotherMapIfTheSizeOfTheWorldChanges) {
  const World& world = network_world();
  const World small =
      parsed(world::testing::replaced(network_text(), "blocks = [0, 0]", "blocks = [40, 50]"));
  const core::WorldPosition eye = world.position({1000, 1000});
  RiverOverlay overlay;
  overlay.set_on(true);
  follow(overlay, world, eye);
  ASSERT_NE(overlay.map(), nullptr);
  const std::size_t whole = size_of(*overlay.map());
  follow(overlay, small, eye);
  EXPECT_LT(size_of(*overlay.map()), whole);
}

TEST(RiverOverlay, MeasuresMovesFromThePlaceOfItsMap) {
  const World& world = network_world();
  const double block_m = world.block_size_m(), at_m = 94 * block_m - 1;  // far from its corner
  RiverOverlay overlay;
  overlay.set_on(true);
  follow(overlay, world, world.position({at_m, at_m}));
  ASSERT_NE(overlay.map(), nullptr);
  const auto before = overlay.map();
  const double quarter_m = 0.5 * before->near_m;
  for (const double side : {-1.0, 1.0}) {
    follow(overlay, world, world.position({at_m, at_m + side * (quarter_m - 2)}));
    EXPECT_EQ(overlay.map(), before) << side;
  }
  follow(overlay, world, world.position({at_m - quarter_m - 2, at_m}));
  EXPECT_NE(overlay.map(), before);
}

}  // namespace
}  // namespace psygen::editor
