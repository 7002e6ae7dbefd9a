#include <array>

#include "engine/image/compare.hpp"
#include "engine/world/files/path_file.hpp"
#include "engine/world/world.hpp"
#include "tests/engine/app/golden.hpp"

namespace psygen::app {
namespace {

// Both paths draw the same frames. Occlusion results of one frame apply to the next.
TEST(RenderPath, TheGpuPathShowsWhatTheCpuPathShows) {
  std::array<std::unique_ptr<Session>, 2> sessions;
  for (std::size_t i = 0; i < 2; ++i) {
    SessionOptions options = short_session();
    options.size = {480, 270};
    options.scene.view_distance_m = 2000;
    options.render_path = i == 0 ? render::RenderPath::kCpu : render::RenderPath::kGpu;
    auto session = Session::create(options);
    ASSERT_TRUE(session) << session.error().message;
    sessions[i] = std::move(*session);
  }
  const auto path = world::load_camera_path(kWalk);
  ASSERT_TRUE(path);
  for (const double seconds : {1.0, 1.1, 1.2, 13.0, 13.1, 13.2, 25.0}) {
    std::array<image::Image, 2> images;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto pose = path->pose_at(seconds, sessions[i]->scene().world());
      sessions[i]->scene().settle(pose);
      ASSERT_TRUE(sessions[i]->tick(pose, 1.0 / 60.0));
      images[i] = captured(*sessions[i]);
    }
    const image::ImageDifference difference = image::compare(images[0], images[1]);
    EXPECT_TRUE(image::matches_golden(difference))
        << "fraction of differing pixels " << difference.share_over << " at " << seconds << " s";
  }
  for (const auto& session : sessions)
    EXPECT_THAT(session->renderer().validation_messages(), testing::IsEmpty());
}

}  // namespace
}  // namespace psygen::app
