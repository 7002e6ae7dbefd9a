// Far from the origin, and across the seam of the block indices, pictures are as steady and as
// complete as anywhere.
#include "engine/image/compare.hpp"
#include "tests/engine/app/studio.hpp"

namespace psygen::app {
namespace {

TEST(FarPlaces, AMillimetreChangesThePictureNoMoreThanAtTheOrigin) {
  Options options = short_flight();
  options.validation = false;
  options.scene.view_distance_m = 1500;
  Studio studio(paper_text(0, 0), options);
  for (const core::BlockCoord block :
       {core::BlockCoord{0, 0}, {1 << 30, -(1 << 30)}, {INT32_MAX, INT32_MIN}}) {
    SCOPED_TRACE(testing::Message() << "block " << block.x << ", " << block.z);
    core::CameraPose pose = studio.above(block, 62.9995, 0.0005, 0, 0.8, -0.3);
    pose.position.local.y = 130;  // higher than any ground: at the seam there is a cliff
    studio.settle(pose);
    EXPECT_EQ(studio.state().counters.holes, 0u);
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

}  // namespace
}  // namespace psygen::app
