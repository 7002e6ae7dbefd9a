// A change of level is invisible: the image of a frame, and the image of the previous frame's draw
// lists from the same camera, are nearly the same everywhere. This excludes the movement of the
// camera and includes all changes by LODs and fades.
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "tests/engine/app/studio.hpp"

namespace psygen::app {
namespace {

constexpr std::uint32_t kTile = 20;
constexpr double kGroundTile = 12, kModelTile = 15;

// Of 255: the mean over the image, and over the tile that differs most.
struct Difference {
  double mean = 0, worst = 0;
};

Difference difference(const image::Image& a, const image::Image& b) {
  Difference found;
  std::size_t tiles = 0;
  for (std::uint32_t y = 0; y + kTile <= a.height; y += kTile) {
    for (std::uint32_t x = 0; x + kTile <= a.width; x += kTile) {
      double sum = 0;
      for (std::uint32_t i = 0; i < kTile * kTile; ++i) {
        const auto p = a.pixel(x + i % kTile, y + i / kTile),
                   q = b.pixel(x + i % kTile, y + i / kTile);
        for (std::size_t c = 0; c < 3; ++c)
          sum += std::abs(int{p[c]} - int{q[c]});
      }
      const double tile = sum / (3.0 * kTile * kTile);
      found.mean += tile;
      found.worst = std::max(found.worst, tile);
      ++tiles;
    }
  }
  found.mean /= static_cast<double>(tiles);
  return found;
}

// The worst values of a flight.
struct Pops {
  Difference ground, models;
  // Median over the frames of the mean difference that the camera's movement makes.
  double motion = 0;
  std::size_t switches = 0;  // frames in which nodes were split or merged
  std::set<int> levels;      // of drawn nodes
};

void keep_worst(const Difference& now, Difference& worst) {
  worst.mean = std::max(worst.mean, now.mean);
  worst.worst = std::max(worst.worst, now.worst);
}

template <class Move>
Pops fly(Studio& studio, core::CameraPose pose, int frames, const Move& move) {
  Pops pops;
  std::vector<double> motion;
  studio.settle(pose);
  Studio::Lists before = studio.lists();
  image::Image picture_before = studio.picture();
  for (int i = 0; i < frames; ++i) {
    const double above_m =
        pose.position.local.y -
        studio.above(pose.position.block, pose.position.local.x, pose.position.local.z, 0, 0, 0)
            .position.local.y;
    pose.position.local += move(i);
    pose.position = core::normalised(pose.position, studio.state().facts.world.block_size_m());
    pose = studio.above(pose.position.block, pose.position.local.x, pose.position.local.z,
                        above_m + move(i).y, pose.yaw, pose.pitch);
    studio.fly(pose);
    const Studio::Lists now = studio.lists();
    const image::Image old_lists = studio.picture_of(before, before);
    const image::Image new_ground = studio.picture_of(now, before);
    const image::Image picture = studio.picture();
    keep_worst(difference(old_lists, new_ground), pops.ground);
    keep_worst(difference(new_ground, picture), pops.models);
    motion.push_back(difference(picture_before, old_lists).mean);
    const auto cells = [](const Studio::Lists& lists) {
      std::multiset<std::pair<float, std::uint32_t>> sizes;
      for (const render::TerrainDraw& draw : lists.terrain)
        sizes.insert({draw.cell_m, draw.range.vertex_count});
      return sizes;
    };
    pops.switches += cells(now) != cells(before);
    for (const std::uint32_t node : studio.state().draws.shown)
      pops.levels.insert(studio.state().view.cut.nodes[node].node.level);
    before = now;
    picture_before = picture;
  }
  std::ranges::nth_element(motion, motion.begin() + frames / 2);
  pops.motion = motion[static_cast<std::size_t>(frames / 2)];
  return pops;
}

void expect_unseen(const Pops& pops) {
  EXPECT_LT(pops.ground.worst, kGroundTile);
  EXPECT_LT(pops.ground.mean, pops.motion) << "less than the change by one step of the flight";
  EXPECT_LT(pops.models.worst, kModelTile);
  EXPECT_LT(pops.models.mean, pops.motion) << "less than the change by one step of the flight";
  EXPECT_GT(pops.switches, 3u);
}

SessionOptions view() {
  SessionOptions options = short_session();
  options.validation = false;
  options.scene.view_distance_m = 1200;
  return options;
}

TEST(Pops, FlyingForwardNoChangeOfLevelIsVisible) {
  Studio studio("paper.toml", view());
  expect_unseen(fly(studio, studio.above({250, 250}, 5, 60, 40, 0.3, -0.2), 30,
                    [](int) { return glm::dvec3(0.6, 0, -2.0); }));
}

TEST(Pops, FlyingBackwardNoChangeOfLevelIsVisible) {
  Studio studio("paper.toml", view());
  expect_unseen(fly(studio, studio.above({300, 120}, 5, 60, 30, 0.3, -0.2), 30,
                    [](int) { return glm::dvec3(-0.5, 0.1, 2.0); }));
}

TEST(Pops, ClimbingNoChangeOfLevelIsVisible) {
  Studio studio("paper.toml", view());
  expect_unseen(fly(studio, studio.above({200, 270}, 5, 60, 20, 4.0, -0.35), 30,
                    [](int i) { return glm::dvec3(0.5, 0.1 * i, -0.5); }));
}

// The largest errors of a flight at 60 frames a second, up to a distance at which trees only colour
// the ground.
SessionOptions coarse_view() {
  SessionOptions options = view();
  options.scene.view_distance_m = 6500;
  options.scene.max_error_pixels = 16;
  return options;
}

void expect_unseen_near_and_far(const Studio& studio, const Pops& pops) {
  expect_unseen(pops);
  const std::vector<scene::NodeLevel>& levels = studio.state().facts.levels;
  EXPECT_TRUE(pops.levels.contains(0) && pops.levels.contains(5) && pops.levels.contains(6));
  EXPECT_TRUE(levels[4].merged && !levels.back().merged);
}

TEST(Pops, FlyingForwardWithALargeErrorNoChangeOfLevelIsVisible) {
  Studio studio("paper.toml", coarse_view());
  expect_unseen_near_and_far(studio, fly(studio, studio.above({250, 250}, 5, 60, 40, 0.3, -0.2), 24,
                                         [](int) { return glm::dvec3(0.6, 0, -2.0); }));
}

TEST(Pops, FlyingBackwardWithALargeErrorNoChangeOfLevelIsVisible) {
  Studio studio("paper.toml", coarse_view());
  expect_unseen_near_and_far(studio, fly(studio, studio.above({300, 120}, 5, 60, 30, 0.3, -0.2), 24,
                                         [](int) { return glm::dvec3(-0.5, 0.1, 2.0); }));
}

TEST(Pops, ClimbingWithALargeErrorNoChangeOfLevelIsVisible) {
  Studio studio("paper.toml", coarse_view());
  expect_unseen_near_and_far(studio, fly(studio, studio.above({200, 270}, 5, 60, 20, 4.0, -0.35),
                                         24, [](int i) { return glm::dvec3(0.5, 0.1 * i, -0.5); }));
}

// A frame takes 5 ms and 150 ns for each triangle.
double frame_ms_of(double triangles) {
  return 5 + triangles * 1.5e-4;
}

// A slow flight during which the error grows from 2 to 8 pixels as fast as the governor allows.
Pops fly_while_coarsening(Studio& studio, const core::CameraPose& pose, glm::dvec3 step) {
  for (int i = 0; i < 2000; ++i) {
    const double triangles = 20'000 + 1000 * (i % 7);
    studio.state().quality.governor.observe(frame_ms_of(triangles), triangles);
  }
  EXPECT_EQ(studio.state().quality.governor.load_reduction(), 1);
  double before = 2, largest_step = 0;
  const Pops pops = fly(studio, pose, 40, [&](int) {
    const double error = studio.state().quality.error_pixels;
    largest_step = std::max(largest_step, error / std::exchange(before, error) - 1);
    studio.frame_took(frame_ms_of(1e6), 1e6);
    return step;
  });
  EXPECT_GT(largest_step, 0.12);
  EXPECT_EQ(studio.state().quality.error_pixels, 8);
  return pops;
}

TEST(Pops, WhileTheGovernorCoarsensNoChangeOfLevelIsVisible) {
  SessionOptions options = coarse_view();
  options.scene.max_error_pixels = 2;
  options.scene.max_error_factor = 4;
  options.scene.min_resolution = 1;
  options.target_hz = 60;
  for (const auto& [block, height_m, yaw, step] :
       {std::tuple(core::BlockCoord{250, 250}, 40.0, 0.3, glm::dvec3(0.15, 0, -0.5)),
        std::tuple(core::BlockCoord{300, 120}, 30.0, 0.3, glm::dvec3(-0.15, 0.02, 0.5)),
        std::tuple(core::BlockCoord{200, 270}, 80.0, 4.0, glm::dvec3(0.15, 0.3, -0.15))}) {
    Studio studio("paper.toml", options);
    expect_unseen_near_and_far(
        studio,
        fly_while_coarsening(studio, studio.above(block, 5, 60, height_m, yaw, -0.2), step));
  }
}

}  // namespace
}  // namespace psygen::app
