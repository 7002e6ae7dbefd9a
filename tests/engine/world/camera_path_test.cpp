#include "engine/world/camera_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

#include "engine/models/terrain/terrain.hpp"
#include "engine/world/files/path_file.hpp"
#include "engine/world/files/world_file.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using testing::game_file;
using testing::kSmallWorld;
using testing::parsed;
using testing::registry;

World paper() {
  return load_world(game_file("worlds/paper.toml"), registry()).value();
}
CameraPath walk() {
  return load_camera_path(game_file("paths/walk27.toml")).value();
}

double clearance_m(const core::CameraPose& pose, const World& world) {
  const glm::dvec3 at = pose.position.local;
  return at.y - models::ground_height_m(world.terrain, pose.position.block, at.x, at.z);
}

glm::dvec3 move(const core::CameraPose& a, const core::CameraPose& b, const World& world) {
  return core::offset_m(b.position.block, a.position, world.block_size_m()) + b.position.local;
}

PathPoint point(double time_s, glm::dvec2 at_m, double height_m = 10) {
  PathPoint p;
  p.time_s = time_s;
  p.at_m = at_m;
  p.height_m = height_m;
  return p;
}

TEST(Walk27, Lasts27SecondsAtAbout50MetresASecond) {
  const World world = paper();
  const CameraPath path = walk();
  EXPECT_DOUBLE_EQ(path.duration_seconds(), 27);
  double length = 0;
  for (int i = 0; i < 270; ++i) {
    const glm::dvec3 step =
        move(path.pose_at(i / 10.0, world), path.pose_at((i + 1) / 10.0, world), world);
    const double speed = std::hypot(step.x, step.z) * 10;
    EXPECT_NEAR(speed, 50, 3) << i;
    length += speed / 10;
  }
  EXPECT_NEAR(length, 1350, 10);
}

TEST(Walk27, NeverComesNearerThanTwoMetresToTheGroundAndStaysLow) {
  const World world = paper();
  const CameraPath path = walk();
  double sum = 0;
  for (int i = 0; i <= 27 * 60; ++i) {
    const double clearance = clearance_m(path.pose_at(i / 60.0, world), world);
    EXPECT_GE(clearance, CameraPath::kClearance_m - 1e-9);
    EXPECT_LE(clearance, 60);
    sum += clearance;
  }
  EXPECT_LT(sum / (27 * 60), 30);
}

TEST(Walk27, StaysInTheMiddleOfThePapersWorldAndClimbsOverARidge) {
  const World world = paper();
  const CameraPath path = walk();
  double lowest = 1e9, highest = 0;
  for (int i = 0; i <= 270; ++i) {
    const core::CameraPose pose = path.pose_at(i / 10.0, world);
    ASSERT_TRUE(core::is_valid(pose));
    EXPECT_LT(std::abs(pose.position.block.x - 256), 20);
    EXPECT_LT(std::abs(pose.position.block.z - 256), 20);
    EXPECT_GE(pose.position.local.x, 0);
    EXPECT_LT(pose.position.local.x, world.block_size_m());
    lowest = std::min(lowest, pose.position.local.y);
    highest = std::max(highest, pose.position.local.y);
  }
  EXPECT_GT(highest - lowest, 80);
}

TEST(Walk27, TurnsGentlyAndChangesItsVelocitySmoothly) {
  const World world = paper();
  const CameraPath path = walk();
  constexpr double dt = 1 / 60.0;
  glm::dvec3 last{0.0};
  for (int i = 0; i + 1 <= 27 * 60; ++i) {
    const core::CameraPose a = path.pose_at(i * dt, world), b = path.pose_at((i + 1) * dt, world);
    EXPECT_LT(std::abs(b.yaw - a.yaw) / dt, glm::radians(35.0)) << i;
    EXPECT_LT(std::abs(b.pitch - a.pitch) / dt, glm::radians(15.0)) << i;
    const glm::dvec3 velocity = move(a, b, world) / dt;
    if (i > 0) {
      EXPECT_LT(glm::length(velocity - last), 2.5) << i;
    }
    last = velocity;
  }
}

TEST(Spin, TurnsInPlaceTwice) {
  const World world = paper();
  const CameraPath path = load_camera_path(game_file("paths/spin.toml")).value();
  const core::CameraPose first = path.pose_at(0, world);
  for (double t = 0; t <= path.duration_seconds(); t += 0.25) {
    const core::CameraPose pose = path.pose_at(t, world);
    EXPECT_NEAR(glm::length(move(first, pose, world)), 0, 1e-9);
    EXPECT_NEAR(pose.yaw, 4 * 3.14159265358979 * t / path.duration_seconds(), 1e-6);
  }
}

TEST(CameraPath, EveryPathOfTheGameLoads) {
  for (const auto& entry : std::filesystem::directory_iterator(game_file("paths"))) {
    const auto path = load_camera_path(entry.path());
    EXPECT_TRUE(path.has_value()) << path.error().message;
  }
}

TEST(CameraPath, KnowsWhetherItComesNearTheWorld) {
  const World world = paper();  // 0 … 32768 m
  const auto near = [&](core::BlockCoord origin, glm::dvec2 at_m) {
    return CameraPath({"", origin}, {point(0, at_m)}).comes_within(100, world);
  };
  const double side_m = world.block_size_m() * static_cast<double>(world.blocks_x);
  EXPECT_TRUE(near({0, 0}, {5, 5}));
  EXPECT_TRUE(near({0, 0}, {-99, 5}));
  EXPECT_FALSE(near({0, 0}, {-101, 5}));
  EXPECT_FALSE(near({0, 0}, {-80, -80})) << "113 m from the corner";
  EXPECT_TRUE(near({0, 0}, {side_m + 99, 5}));
  EXPECT_FALSE(near({0, 0}, {5, side_m + 101}));
  EXPECT_FALSE(near({9999, 0}, {0, 0}));
  World endless = paper();
  endless.blocks_x = endless.blocks_z = 0;
  EXPECT_TRUE(CameraPath({"", {-90000, 90000}}, {point(0, {0, 0})}).comes_within(1, endless));
  EXPECT_TRUE(
      CameraPath({"", {0, 0}}, {point(0, {-500, 0}), point(1, {5, 5})}).comes_within(1, world))
      << "one point suffices";
}

TEST(CameraPath, HoldsItsEndsAndTreatsNanAsTheStart) {
  const World world = parsed(kSmallWorld);
  const CameraPath path({"p", {}, 1}, {point(1, {0, 0}), point(3, {40, 0})});
  const core::CameraPose begin = path.pose_at(1, world), end = path.pose_at(3, world);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double t : {-5.0, 0.0, nan, -std::numeric_limits<double>::infinity()})
    EXPECT_EQ(glm::length(move(begin, path.pose_at(t, world), world)), 0);
  for (const double t : {4.0, 1e300, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(glm::length(move(end, path.pose_at(t, world), world)), 0);
}

TEST(CameraPath, LooksAlongTheFlightAtPointsAndAtHeadings) {
  const World world = parsed(kSmallWorld);
  std::vector<PathPoint> points{point(0, {0, 0}), point(1, {10, 0}), point(2, {20, 0})};
  EXPECT_NEAR(CameraPath({"p", {}, 1}, points).pose_at(1, world).yaw, glm::radians(90.0), 1e-6);
  points[1].look_at_m = glm::dvec2(10, -50);
  EXPECT_NEAR(CameraPath({"p", {}, 1}, points).pose_at(1, world).yaw, 0, 1e-6);
  points[1].look_at_m.reset();
  points[1].heading_deg = 45;
  points[1].pitch_deg = -12;
  const core::CameraPose pose = CameraPath({"p", {}, 1}, points).pose_at(1, world);
  EXPECT_NEAR(pose.yaw, glm::radians(45.0), 1e-6);
  EXPECT_NEAR(pose.pitch, glm::radians(-12.0), 1e-6);
}

TEST(CameraPath, HashCoversEverythingThatAffectsPoses) {
  const auto hash_of = [](auto change) {
    std::vector<PathPoint> points(2);
    points[0].heading_deg = 90;
    points[1].time_s = 1;
    CameraPath::Settings settings;
    change(settings, points);
    return CameraPath(settings, points).hash();
  };
  using Settings = CameraPath::Settings;
  using Points = std::vector<PathPoint>;
  const std::uint64_t hash = hash_of([](Settings&, Points&) {});
  EXPECT_EQ(hash_of([](Settings& s, Points&) { s.name = "another name"; }), hash);
  EXPECT_NE(hash_of([](Settings& s, Points&) { s.origin_block.z = 1; }), hash);
  EXPECT_NE(hash_of([](Settings& s, Points&) { s.smoothing_s = 1; }), hash);
  EXPECT_NE(hash_of([](Settings&, Points& p) { p[1].at_m.y = 1; }), hash);
  EXPECT_NE(hash_of([](Settings&, Points& p) { p[1].height_m = 3; }), hash);
  EXPECT_NE(hash_of([](Settings&, Points& p) { p[1].jump = true; }), hash);
  EXPECT_NE(hash_of([](Settings&, Points& p) { p[0].heading_deg = 91; }), hash);
  EXPECT_NE(hash_of([](Settings&, Points& p) { p[1].look_at_m = glm::dvec2(1, 2); }), hash);
}

TEST(CameraPath, TurnsTheShortWayAcrossTheBack) {
  const World world = parsed(kSmallWorld);
  // From south-east to south-west through the south.
  const CameraPath path({"p", {}, 1}, {point(0, {0, 0}), point(1, {10, 30}), point(2, {0, 60})});
  EXPECT_LT(std::abs(path.pose_at(2, world).yaw - path.pose_at(0, world).yaw), glm::radians(90.0));
}

TEST(CameraPath, JumpsWithoutIntermediatePosesOrTraces) {
  const World world = paper();
  std::vector<PathPoint> before{point(0, {100, 200}), point(2, {160, 200})};
  std::vector<PathPoint> after{point(4, {9000, 300}), point(6, {9000, 400})};
  const CameraPath first({"first", {200, 200}, 1.5}, before);
  const CameraPath second({"second", {200, 200}, 1.5}, after);
  after[0].jump = true;
  std::vector<PathPoint> all = before;
  all.insert(all.end(), after.begin(), after.end());
  const CameraPath path({"both", {200, 200}, 1.5}, all);
  EXPECT_DOUBLE_EQ(path.duration_seconds(), 6);
  for (const double t : {-1.0, 0.0, 1.3, 2.0, 4.0, 4.1, 6.0, 7.0}) {
    const core::CameraPose pose = path.pose_at(t, world);
    const core::CameraPose alone = (t < 4 ? first : second).pose_at(t, world);
    EXPECT_EQ(pose.position.block, alone.position.block) << t;
    EXPECT_EQ(pose.position.local, alone.position.local) << t;
    EXPECT_EQ(pose.yaw, alone.yaw) << t;
    EXPECT_EQ(pose.pitch, alone.pitch) << t;
  }
  const glm::dvec3 stood = move(path.pose_at(2, world), path.pose_at(3.9999, world), world);
  EXPECT_NEAR(stood.x, 0, 1e-9);
  EXPECT_NEAR(stood.z, 0, 1e-9);
}

TEST(CameraPath, APathOfOnePointStandsStill) {
  const World world = parsed(kSmallWorld);
  const CameraPath path({"p", {3, -2}, 1}, {point(0, {5, 6}, 7)});
  EXPECT_EQ(path.duration_seconds(), 0);
  const core::CameraPose pose = path.pose_at(0, world);
  EXPECT_EQ(pose.position.block, (core::BlockCoord{3, -2}));
  EXPECT_NEAR(clearance_m(pose, world), 7, 1e-6);
}

TEST(CameraPath, IsTheSameFarFromTheOriginAndAcrossTheSeamOfTheIndices) {
  const World world = parsed(testing::replaced(kSmallWorld, "[8, 4]", "[0, 0]"));
  const CameraPath path({"p", {INT32_MAX, INT32_MIN}, 1}, {point(0, {0, 0}), point(4, {300, 0})});
  const core::CameraPose pose = path.pose_at(4, world);
  EXPECT_EQ(pose.position.block.x, INT32_MIN + 3);
  EXPECT_NEAR(pose.position.local.x, 300 - 4 * 64, 1e-6);
  EXPECT_GE(clearance_m(pose, world), 2);
}

World rough() {
  return parsed(
      "format = 1\n[world]\nname = \"rough\"\nseed = 1\nblocks = [0, 0]\ncell_m = 0.5\n"
      "[terrain]\noctaves = 12\nheight = 0.4\nrelief_m = 400\nfeature_m = 60\n");
}

TEST(CameraPath, KeepsItsDistanceOnTheRoughestGround) {
  const World world = rough();
  const CameraPath path({"p", {}, 0.1}, {point(0, {0, 0}, 2), point(20, {1000, 300}, 2)});
  for (double t = 0; t <= 20; t += 0.01)
    EXPECT_GE(clearance_m(path.pose_at(t, world), world), CameraPath::kClearance_m - 1e-9);
}

TEST(CameraPath, WalksAtTheHeightOfAnEye) {
  const World world = rough();
  const CameraPath standing({"p", {}, 1}, {point(0, {5, 6}, 1.7)});
  EXPECT_NEAR(clearance_m(standing.pose_at(0, world), world), 1.7, 1e-6);
  const CameraPath path({"p", {}, 0.1}, {point(0, {0, 0}, 1.7), point(20, {28, 0}, 1.7)});
  double lowest = 100;
  for (double t = 0; t <= 20; t += 0.01)
    lowest = std::min(lowest, clearance_m(path.pose_at(t, world), world));
  EXPECT_GE(lowest, 1.7 - 1e-9);
  EXPECT_LT(lowest, 1.75);
}

TEST(CameraPath, NeverComesNearerToTheGroundThanItsLowestPoint) {
  const World world = rough();
  const std::vector<PathPoint> points{point(0, {0, 0}, 1.7), point(4, {20, 0}, 1.7),
                                      point(5, {25, 0}, 90), point(9, {45, 0}, 1.7)};
  const CameraPath path({"p", {}, 0.1}, points);
  for (double t = 0; t <= 9; t += 0.01)
    EXPECT_GE(clearance_m(path.pose_at(t, world), world), 1.7 - 1e-9) << t;
}

}  // namespace
}  // namespace psygen::world
