// The ground is closed: no sky is visible through the true ground.
#include <algorithm>
#include <cmath>
#include <set>

#include "engine/core/hash.hpp"
#include "tests/engine/app/studio.hpp"

namespace psygen::app {
namespace {

SessionOptions wide_view() {
  SessionOptions options = short_session();
  options.validation = false;
  options.scene.view_distance_m = 3000;
  return options;
}

struct Place {
  core::BlockCoord block;
  double x, z, height_m, yaw, pitch;
};

TEST(Holes, LookingForwardAndDownFromAnyHeightTheGroundIsClosed) {
  Studio studio("paper.toml", wide_view());
  for (const Place& place :
       {Place{{250, 250}, 3, 60, 2, 0.3, -0.05}, Place{{256, 200}, 63.9, 0.1, 6, 1.9, -0.3},
        Place{{100, 301}, 31, 31, 25, 3.6, -0.15}, Place{{257, 256}, 10, 10, 90, 5.1, -0.5},
        Place{{300, 130}, 1, 62, 300, 0.0, -1.2}, Place{{333, 333}, 40, 20, 700, 2.5, -0.7},
        Place{{256, 256}, 32, 32, 2000, 4.2, -1.5}}) {
    studio.settle(
        studio.above(place.block, place.x, place.z, place.height_m, place.yaw, place.pitch));
    EXPECT_EQ(studio.scene().statistics().drawn.holes, 0u);
    EXPECT_EQ(studio.holes(), 0u) << "at " << place.height_m << " m";
  }
}

// Over plains, along ridges and from above, up to the view distance of the coarsest nodes.
TEST(Holes, In16KilometresOfGroundNotASinglePixelIsOpen) {
  SessionOptions options = wide_view();
  options.scene.view_distance_m = 16'000;
  for (const char* world : {"paper.toml", "silver_combe.toml"}) {
    Studio studio(world, options);
    std::set<int> levels;
    for (const Place& place :
         {Place{{256, 256}, 20, 30, 3, 0.4, -0.02}, Place{{230, 270}, 63.9, 0.1, 60, 2.0, -0.1},
          Place{{270, 240}, 31, 31, 250, 3.6, -0.15}, Place{{250, 260}, 1, 62, 900, 5.3, -0.2},
          Place{{256, 256}, 40, 20, 3000, 1.1, -0.5}}) {
      studio.settle(
          studio.above(place.block, place.x, place.z, place.height_m, place.yaw, place.pitch));
      EXPECT_EQ(studio.scene().statistics().drawn.holes, 0u);
      EXPECT_EQ(studio.holes(), 0u) << world << " at " << place.height_m << " m";
      for (const std::uint32_t node : studio.state().draws.shown)
        levels.insert(studio.state().view.cut.nodes[node].node.level);
    }
    EXPECT_TRUE(levels.contains(6) && levels.contains(7)) << world;
  }
}

// Where vertices lie on edges of other triangles, single pixels of sky can become visible.
TEST(Holes, InViewsOfAnyPlaceNotASinglePixelIsOpen) {
  for (const char* world : {"paper.toml", "five_species.toml"}) {
    SessionOptions options = wide_view();
    options.scene.budget_bytes = 1ull << 30;
    Studio studio(world, options);
    core::RandomStream random(5, 0, 0, 0, core::Purpose::kParameters);
    for (int i = 0; i < 60; ++i) {
      const auto index = [&] { return static_cast<std::int32_t>(random.next_integer(50, 450)); };
      const core::BlockCoord block{index(), index()};
      const double x = random.next_real(0, 63), z = random.next_real(0, 63);
      const double height_m = std::exp(random.next_real(0.7, 6));
      const double yaw = random.next_real(0, 6.28), pitch = random.next_real(-0.6, 0);
      studio.settle(studio.above(block, x, z, height_m, yaw, pitch));
      EXPECT_EQ(studio.holes(), 0u) << world << ", " << height_m << " m above " << block.x << ", "
                                    << block.z << " at " << x << ", " << z;
    }
  }
}

// Odd block sizes, coarse levels near the camera, steep ground.
TEST(Holes, OddBlocksAndCoarseLevelsOfSteepGroundLeaveNoCracks) {
  for (const char* terrain : {"feature_m = 300\nrelief_m = 300\n", "relief_m = 900\n"}) {
    SessionOptions options = wide_view();
    options.scene.max_error_pixels = 24;
    std::string text = paper_text(0, 0, terrain);
    text.insert(text.find("[terrain]"), "block_vertices = 59\ncell_m = 1.5\n");
    Studio studio(text, options);
    for (const Place& place :
         {Place{{-250, 250}, 3, 60, 3, 0.3, -0.05}, Place{{100, -301}, 31, 31, 40, 3.6, -0.2},
          Place{{7, 9}, 40, 20, 400, 2.5, -0.6}, Place{{0, 0}, 0, 0, 1500, 4.2, -1.0}}) {
      studio.settle(
          studio.above(place.block, place.x, place.z, place.height_m, place.yaw, place.pitch));
      EXPECT_EQ(studio.holes(), 0u) << terrain << " at " << place.height_m << " m";
    }
  }
}

// During changes of levels, with the meshes that are ready.
TEST(Holes, WhileTheCameraClimbsAndFliesTheGroundStaysClosed) {
  Studio studio("silver_combe.toml", wide_view());
  core::CameraPose pose = studio.above({250, 250}, 20, 20, 4, 0.8, -0.25);
  studio.settle(pose);
  for (int i = 0; i < 24; ++i) {
    pose.position.local += glm::dvec3(9, 3.0 * i, -7);
    pose.position = core::normalised(pose.position, 63);
    const double ground_m =
        models::ground_height_m(studio.state().facts.world.terrain, pose.position.block,
                                pose.position.local.x, pose.position.local.z);
    pose.position.local.y = std::max(pose.position.local.y, ground_m + 4);
    studio.draw(pose);
    EXPECT_EQ(studio.holes(), 0u) << "frame " << i;
  }
}

TEST(Holes, AreDetectedIfGroundOrSkirtsAreMissing) {
  Studio studio("paper.toml", wide_view());
  studio.settle(studio.above({250, 250}, 3, 60, 30, 0.3, -0.3));
  EXPECT_EQ(studio.holes(), 0u);
  std::vector<render::TerrainDraw>& draws = studio.state().draws.terrain;
  ASSERT_GE(draws.size(), 12u);
  std::size_t most = 0;  // a hill may lie behind near tiles
  for (std::size_t i = 0; i < 12; ++i) {
    const auto all = draws;
    draws.erase(draws.begin() + static_cast<std::ptrdiff_t>(i));
    most = std::max(most, studio.holes());
    draws = all;
  }
  EXPECT_GT(most, 1000u);
  // Without morphing the borders of two levels do not meet, and skirts hide most of the gap.
  for (render::TerrainDraw& draw : draws)
    draw.morph = 0;
  const std::size_t with_skirts = studio.holes();
  for (render::TerrainDraw& draw : draws)
    draw.skirt_m = 0;
  EXPECT_GT(studio.holes(), with_skirts);
}

}  // namespace
}  // namespace psygen::app
