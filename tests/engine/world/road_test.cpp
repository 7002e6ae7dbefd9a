// Roads of a world file: flat, clear of models, marked in the ground.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/road_shapes.hpp"
#include "tests/engine/world/ground_meshes.hpp"
#include "tests/engine/world/shaped_worlds.hpp"

namespace psygen::world {
namespace {

using testing::each_vertex;
using testing::height_at;
using testing::kQuantumM;
using testing::kShapedBlockM;
using testing::kShapes;
using testing::kSmallWorld;
using testing::mesh_of;
using testing::parsed;
using testing::read_shaped_world;
using testing::registry;
using testing::replaced;
using testing::shaped_world;

TEST(Road, IsFlatAcrossItsWidth) {
  const World world =
      shaped_world("[[road]]\npoints_m = [[40, 100], [440, 100]]\nwidth_m = 16\nborder_m = 12\n");
  const World base = parsed(kSmallWorld);
  double moved = 0;
  for (double x = 42; x < 438; x += 2) {
    const double middle = height_at(world, x, 100);
    for (double across = -8; across <= 8; across += 2)
      EXPECT_NEAR(height_at(world, x, 100 + across), middle, 1.01 * kQuantumM) << x << across;
    EXPECT_EQ(height_at(world, x, 120.5), height_at(base, x, 120.5));
    moved = std::max(moved, std::abs(height_at(world, x, 108) - height_at(base, x, 108)));
  }
  EXPECT_GT(moved, 0.3);
}

// Everywhere on a road that bends, crosses a stamp and comes near itself, the ground has the height
// of the nearest point of the centre line.
TEST(Road, HasTheHeightOfItsMiddleAlsoInBends) {
  const World world = shaped_world(kShapes);
  const Road& road = world.shaped.roads[0];
  const World stamped =
      shaped_world(std::string(kShapes).substr(0, std::string(kShapes).find("[[road]]")));
  const auto line =
      road_line(road, 2 * 10.0 / 6, [&](glm::dvec2 at) { return height_at(stamped, at.x, at.y); });
  int on_it = 0;
  each_vertex([&](double x, double z) {
    double nearest = 1e9, height_m = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
      const glm::dvec2 along = line[i].at_m - line[i - 1].at_m;
      const glm::dvec2 to = glm::dvec2(x, z) - line[i - 1].at_m;
      const double share = std::clamp(
          (to.x * along.x + to.y * along.y) / (along.x * along.x + along.y * along.y), 0.0, 1.0);
      const double away = std::hypot(to.x - share * along.x, to.y - share * along.y);
      if (away >= nearest) continue;
      nearest = away;
      height_m = line[i - 1].height_m + share * (line[i].height_m - line[i - 1].height_m);
    }
    if (nearest > 5) return;
    ++on_it;
    EXPECT_NEAR(height_at(world, x, z), height_m, 0.02) << x << ' ' << z;
  });
  EXPECT_GT(on_it, 500);
}

TEST(Road, FollowsTheGroundCalmlyAndMeetsItAtItsEnds) {
  Road road{{{0, 0}, {100, 0}, {200, 40}}, 6, 6, 30, 1};
  const auto ground = [](glm::dvec2 at) { return 10 + std::sin(at.x / 3); };
  const auto line = road_line(road, 2, ground);
  EXPECT_EQ(line.front().height_m, ground(line.front().at_m));
  EXPECT_EQ(line.back().height_m, ground(line.back().at_m));
  EXPECT_EQ(line.front().at_m, road.points_m.front());
  EXPECT_EQ(line.back().at_m, road.points_m.back());
  for (std::size_t i = 1; i < line.size(); ++i) {
    EXPECT_LT(line[i].along_m - line[i - 1].along_m, 2.5);
    EXPECT_GT(line[i].along_m, line[i - 1].along_m);
    if (line[i].along_m > 40 && line.back().along_m - line[i].along_m > 40) {
      EXPECT_NEAR(line[i].height_m, 10, 0.15);
    }
  }
  road.smoothing_m = 0;
  for (const RoadPoint& point : road_line(road, 2, ground))
    EXPECT_EQ(point.height_m, ground(point.at_m));
}

TEST(Road, ClearsItsOwnStripOfModelsOnly) {
  const std::string many = replaced(kSmallWorld, "count = 5", "count = 400");
  const World base = parsed(many);
  const World world = *read_shaped_world(
      "[[road]]\npoints_m = [[40, 100], [440, 100]]\nwidth_m = 16\nclear_m = 3\n", many);
  std::size_t cleared = 0;
  for (std::int32_t i = 0; i < 32; ++i) {
    const core::BlockCoord block{i % 8, i / 8};
    std::vector<Placement> before, now;
    place_models(base, registry(), block, before);
    place_models(world, registry(), block, now);
    for (const Placement& was : before) {
      const double x = block.x * kShapedBlockM + static_cast<double>(was.position.x);
      const double z = block.z * kShapedBlockM + static_cast<double>(was.position.z);
      const double ahead = std::max({40 - x, x - 440, 0.0});
      const bool clear = std::hypot(ahead, z - 100) <= 11;
      const auto same = std::ranges::find(now, was.index, &Placement::index);
      EXPECT_EQ(same == now.end(), clear) << x << ' ' << z;
      cleared += clear ? 1 : 0;
      if (same == now.end()) continue;
      EXPECT_EQ(same->position.x, was.position.x);
      EXPECT_EQ(same->position.z, was.position.z);
      EXPECT_NEAR(static_cast<double>(same->position.y), height_at(world, x, z), 1e-4);
    }
  }
  EXPECT_GT(cleared, 500U);
  EXPECT_LT(world_size(world, registry()).models, world_size(base, registry()).models);
}

// Vertices have the fraction of road in meshes of all levels, as in queries.
TEST(Road, IsMarkedInTheGround) {
  const World world =
      shaped_world("[[road]]\npoints_m = [[40, 100], [440, 100]]\nwidth_m = 16\nborder_m = 12\n");
  for (int level = 0; level < 3; ++level) {
    const auto vertices = mesh_of(world, {0, 0}, level, 0);
    const int step_m = 2 << level;
    for (int k = 0; k < 33; ++k) {
      for (int i = 0; i < 33; ++i) {
        const int x = i * step_m, z = k * step_m;
        const bool on_it = x >= 40 && x <= 440 && std::abs(z - 100) <= 7;
        const bool off_it = x < 31 || x > 449 || std::abs(z - 100) >= 9;
        const std::uint8_t road = vertices[static_cast<std::size_t>(k * 33 + i)].road;
        if (on_it) {
          EXPECT_EQ(road, 255) << x << ' ' << z;
        }
        if (off_it) {
          EXPECT_EQ(road, 0) << x << ' ' << z;
        }
        const core::BlockCoord block{x / 64, z / 64};
        EXPECT_NEAR(road_at(world, block, {x % 64, z % 64}), road / 255.0F, 0.003F);
      }
    }
  }
  const World base = parsed(kSmallWorld);
  EXPECT_EQ(road_at(base, {1, 1}, {36, 36}), 0);
}

TEST(Road, RoadsAndStampsMayLieOnEachOther) {
  std::string tables;
  for (int i = 0; i < 20; ++i) {
    tables +=
        "[[stamp]]\nimage = \"ramp.png\"\ncentre_m = [200, 128]\nsize_m = 100\nheight_m = 9\n";
    tables += "[[road]]\npoints_m = [[20, 128], [480, 128]]\n";
    tables += "[[road]]\npoints_m = [[200, 20], [200, 240]]\n";
  }
  const World world = shaped_world(tables);
  each_vertex([&](double x, double z) {
    const double height_m = height_at(world, x, z);
    EXPECT_TRUE(height_m >= 0 && height_m <= 60.001) << x << ' ' << z;
  });
}

}  // namespace
}  // namespace psygen::world
