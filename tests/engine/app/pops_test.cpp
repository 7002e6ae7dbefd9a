// A change of level is not seen: the picture of a frame and what the lists of the frame before
// would show from the same place are nearly the same, everywhere. That leaves out the movement of
// the camera and is all that levels of detail and what comes and goes change.
#include <algorithm>
#include <cmath>
#include <set>

#include "tests/engine/app/studio.hpp"

namespace psygen::app {
namespace {

constexpr std::uint32_t kTile = 20;
constexpr double kGroundTile = 12, kModelTile = 15;

// Of 255: the mean over the picture, and over the tile that differs most.
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

// What was worst on a flight.
struct Pops {
  Difference ground, models;
  double motion = 0;         // the median over the frames of the mean that the flight itself makes
  std::size_t switches = 0;  // frames in which nodes were split or merged
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
    before = now;
    picture_before = picture;
  }
  std::ranges::nth_element(motion, motion.begin() + frames / 2);
  pops.motion = motion[static_cast<std::size_t>(frames / 2)];
  return pops;
}

void expect_unseen(const Pops& pops) {
  EXPECT_LT(pops.ground.worst, kGroundTile);
  EXPECT_LT(pops.ground.mean, pops.motion) << "less than a step of the flight changes";
  EXPECT_LT(pops.models.worst, kModelTile);
  EXPECT_LT(pops.models.mean, pops.motion) << "less than a step of the flight changes";
  EXPECT_GT(pops.switches, 3u);
}

Options view() {
  Options options = short_flight();
  options.validation = false;
  options.scene.view_distance_m = 1200;
  return options;
}

TEST(Pops, FlyingForwardNoChangeOfLevelIsSeen) {
  Studio studio("paper.toml", view());
  expect_unseen(fly(studio, studio.above({250, 250}, 5, 60, 40, 0.3, -0.2), 30,
                    [](int) { return glm::dvec3(0.6, 0, -2.0); }));
}

TEST(Pops, FlyingBackwardNoChangeOfLevelIsSeen) {
  Studio studio("paper.toml", view());
  expect_unseen(fly(studio, studio.above({300, 120}, 5, 60, 30, 0.3, -0.2), 30,
                    [](int) { return glm::dvec3(-0.5, 0.1, 2.0); }));
}

TEST(Pops, ClimbingNoChangeOfLevelIsSeen) {
  Studio studio("paper.toml", view());
  expect_unseen(fly(studio, studio.above({200, 270}, 5, 60, 20, 4.0, -0.35), 30,
                    [](int i) { return glm::dvec3(0.5, 0.1 * i, -0.5); }));
}

}  // namespace
}  // namespace psygen::app
