#include <array>

#include "engine/image/compare.hpp"
#include "engine/world/files/path_file.hpp"
#include "tests/engine/app/golden.hpp"

namespace psygen::app {
namespace {

// Both paths over the same frames: what was hidden in one may be seen in the next.
TEST(RenderPath, TheGpuPathShowsWhatTheCpuPathShows) {
  std::array<std::unique_ptr<App>, 2> apps;
  for (std::size_t i = 0; i < 2; ++i) {
    Options options = short_flight();
    options.size = {480, 270};
    options.scene.view_distance_m = 2000;
    options.render_path = i == 0 ? render::RenderPath::kCpu : render::RenderPath::kGpu;
    auto app = App::create(options);
    ASSERT_TRUE(app) << app.error().message;
    apps[i] = std::move(*app);
  }
  const auto path = world::load_camera_path(short_flight().path_file);
  ASSERT_TRUE(path);
  for (const double seconds : {1.0, 1.1, 1.2, 13.0, 13.1, 13.2, 25.0}) {
    std::array<image::Image, 2> images;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto pose = path->pose_at(seconds, apps[i]->scene().state().facts.world);
      apps[i]->scene().settle(pose);
      ASSERT_TRUE(apps[i]->frame(pose, 1.0 / 60.0));
      images[i] = captured(*apps[i]);
    }
    const image::ImageDifference difference = image::compare(images[0], images[1]);
    EXPECT_TRUE(image::matches_golden(difference))
        << "share of differing pixels " << difference.share_over << " at " << seconds << " s";
  }
  for (const auto& app : apps)
    EXPECT_THAT(app->renderer().validation_messages(), testing::IsEmpty());
}

}  // namespace
}  // namespace psygen::app
