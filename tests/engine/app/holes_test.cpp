// The ground is closed: wherever the true ground stands in the way, no sky is seen.
#include "tests/engine/app/studio.hpp"

namespace psygen::app {
namespace {

Options wide_view() {
  Options options = short_flight();
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
    EXPECT_EQ(studio.state().counters.holes, 0u);
    EXPECT_EQ(studio.holes(), 0u) << "at " << place.height_m << " m";
  }
}

}  // namespace
}  // namespace psygen::app
