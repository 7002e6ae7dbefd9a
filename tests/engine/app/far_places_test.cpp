// Far from the origin, and across the seam of the block indices, images are as stable and as
// complete as elsewhere.
#include "engine/image/compare.hpp"
#include "tests/engine/app/studio.hpp"

namespace psygen::app {
namespace {

TEST(FarPlaces, AMillimetreChangesTheImageNoMoreThanAtTheOrigin) {
  SessionOptions options = short_session();
  options.validation = false;
  options.scene.view_distance_m = 1500;
  Studio studio(paper_text(0, 0), options);
  for (const core::BlockCoord block :
       {core::BlockCoord{0, 0}, {1 << 30, -(1 << 30)}, {INT32_MAX, INT32_MIN}}) {
    SCOPED_TRACE(testing::Message() << "block " << block.x << ", " << block.z);
    core::CameraPose pose = studio.above(block, 62.9995, 0.0005, 0, 0.8, -0.3);
    pose.position.local.y = 130;  // higher than any ground: at the seam there is a cliff
    studio.settle(pose);
    EXPECT_EQ(studio.scene().statistics().drawn.holes, 0u);
    EXPECT_EQ(studio.holes(), 0u);
    const image::Image before = studio.picture();
    pose.position.local += glm::dvec3(0.001, 0, -0.001);  // into the next block
    studio.fly(pose);
    EXPECT_NE(studio.state().camera.pose.position.block, block);
    const image::ImageDifference moved = image::compare(before, studio.picture(), 12);
    // Edges of leaves cross the middle of a few pixels.
    EXPECT_LT(moved.share_over, 0.004);
  }
}

// All meshes of the previous place are evicted, including those that frames in flight might read.
TEST(FarPlaces, SettlingAfterALeapWithAFullCacheEqualsAFreshStart) {
  SessionOptions options = short_session();
  options.validation = false;
  options.scene.view_distance_m = 3000;
  options.scene.max_error_pixels = 3;
  options.scene.budget_bytes = 24ull << 20;  // room for one place, not for two
  Studio studio("silver_combe.toml", options);
  for (const core::BlockCoord block : {core::BlockCoord{300, 300}, {100, 400}, {200, 100}}) {
    Studio fresh("silver_combe.toml", options);
    const core::CameraPose pose = studio.above(block, 20, 30, 6, 0.5, -0.2);
    for (Studio* at : {&studio, &fresh}) {
      at->settle(pose);
      EXPECT_EQ(at->scene().statistics().meshes.requests, 0u) << block.x;
      EXPECT_EQ(at->scene().statistics().meshes.refused, 0u) << block.x;
    }
    EXPECT_EQ(studio.state().quality.coarsening, fresh.state().quality.coarsening);
    EXPECT_EQ(image::compare(studio.picture(), fresh.picture(), 0).pixels_over, 0u) << block.x;
  }
  EXPECT_GT(studio.state().supply.stats().evictions, 1000u);
}

// Meshes that frames in flight may read are freed later: that is no lack of memory.
TEST(FarPlaces, AFlightThroughAFullCacheIsNoCoarserThanAFreshStart) {
  SessionOptions options = short_session();
  options.validation = false;
  options.scene.view_distance_m = 1500;
  options.scene.budget_bytes = 24ull << 20;
  Studio studio("silver_combe.toml", options);
  core::CameraPose pose = studio.above({300, 300}, 20, 30, 6, 1.57, -0.1);
  pose.position.local.y = 470;  // above every hill
  studio.settle(pose);
  for (int i = 0; i < 500; ++i) {
    pose.position.local.x += 20;
    pose.position = core::normalised(pose.position, 63);
    studio.draw(pose);
    studio.state().supply.wait();
  }
  const synthesis::CacheStats stats = studio.state().supply.stats();
  EXPECT_GT(stats.evictions, 1000u);
  EXPECT_GT(stats.peak_bytes, options.scene.budget_bytes * 9 / 10);
  EXPECT_EQ(studio.state().quality.coarsening, 1.0F);
}

// Meshes of the last images may be freed too late for the next one: images must then become coarser
// until three of them fit into memory.
TEST(FarPlaces, LazyEvaluationMissesLittleIfOnlyOneImageFits) {
  SessionOptions options = short_session();
  options.validation = false;
  options.scene.view_distance_m = 4000;
  options.scene.max_error_pixels = 1;
  options.scene.paradigm = scene::Paradigm::kLazyEvaluation;
  Studio ample("paper.toml", options);
  const core::CameraPose pose = ample.above({256, 256}, 20, 30, 6, 0.5, -0.2);
  ample.draw(pose);
  options.scene.budget_bytes = ample.state().supply.stats().bytes * 5 / 4;
  Studio studio("paper.toml", options);
  for (int i = 0; i < 80; ++i)
    studio.draw(pose);
  EXPECT_GT(studio.state().quality.coarsening, 1.0F);
  for (int i = 0; i < 8; ++i) {
    studio.draw(pose);
    EXPECT_EQ(studio.scene().statistics().drawn.holes, 0u) << i;
  }
}

}  // namespace
}  // namespace psygen::app
