// Pictures of settled scenes against stored ones. To accept new pictures after looking at them:
//   PSYGEN_GOLDEN_UPDATE=1 ctest --preset release -R Golden
#include "engine/image/compare.hpp"
#include "engine/image/image_io.hpp"
#include "tests/engine/app/fixture.hpp"

namespace psygen::app {
namespace {

class Golden : public testing::TestWithParam<std::tuple<const char*, const char*, double>> {};

TEST_P(Golden, ASettledSceneLooksAsItDid) {
  const auto& [name, world, seconds] = GetParam();
  Options options = short_flight();
  options.world_file = std::filesystem::path(PSYGEN_SOURCE_DIR "/game/worlds") / world;
  options.size = {480, 270};
  options.scene.view_distance_m = 400;
  auto app = App::create(options);
  ASSERT_TRUE(app) << app.error().message;
  const auto path = world::load_camera_path(options.path_file);
  ASSERT_TRUE(path);
  const core::CameraPose pose = path->pose_at(seconds, (*app)->scene().state().facts.world);
  (*app)->scene().settle(pose);
  ASSERT_TRUE((*app)->frame(pose, 1.0 / 60.0));

  auto picture = (*app)->renderer().capture();
  ASSERT_TRUE(picture);
  const image::Image image{picture->width, picture->height, std::move(picture->rgba)};
  const auto stored = std::filesystem::path(PSYGEN_SOURCE_DIR "/tests/engine/app/golden") /
                      (std::string(name) + ".png");
  if (std::getenv("PSYGEN_GOLDEN_UPDATE") != nullptr) {
    ASSERT_TRUE(image::write_png(stored, image));
  }
  const auto golden = image::read_image(stored);
  ASSERT_TRUE(golden) << golden.error().message;
  const image::ImageDifference difference = image::compare(*golden, image);
  const auto found = std::filesystem::path(testing::TempDir()) / (std::string(name) + ".png");
  if (!image::matches_golden(difference)) {
    ASSERT_TRUE(image::write_png(found, image));
  }
  EXPECT_TRUE(image::matches_golden(difference))
      << "share of differing pixels " << difference.share_over << "; look at " << found;
  EXPECT_THAT((*app)->renderer().validation_messages(), testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Worlds, Golden,
                         testing::Values(std::tuple("paper_start", "paper.toml", 0.0),
                                         std::tuple("paper_middle", "paper.toml", 13.0)),
                         [](const auto& test) { return std::get<0>(test.param); });

}  // namespace
}  // namespace psygen::app
