// Culling behind ridges does not change the image: in any world, from any height.
#include "engine/image/compare.hpp"
#include "engine/world/files/path_file.hpp"
#include "tests/engine/app/studio.hpp"

namespace psygen::app {
namespace {

// Coarse ground hides as much as fine ground.
SessionOptions occlusion_view() {
  SessionOptions options = short_session();
  options.validation = false;
  options.scene.view_distance_m = 5000;
  options.scene.max_error_pixels = 12;
  return options;
}

// Draws merged meshes as a whole from now on.
void forget_parts(ecs::World& entities) {
  entities.each<scene::MeshParts>(
      [](std::span<const ecs::Entity>, std::span<scene::MeshParts> parts) {
        for (scene::MeshParts& of_one : parts)
          of_one = {};
      });
}

// Counts pixels that differ with and without culling, and with merged meshes in parts or as a
// whole.
std::uint64_t differing(Studio& studio, const core::CameraPose& pose, std::uint32_t& hidden) {
  studio.state().settings.occlusion = true;
  studio.settle(pose);
  hidden += studio.scene().statistics().nodes_hidden;
  const image::Image without = studio.picture();
  studio.state().settings.occlusion = false;
  studio.settle(pose);
  EXPECT_EQ(studio.scene().statistics().nodes_hidden, 0u);
  forget_parts(studio.state().entities);
  return image::compare(studio.picture(), without, 0).pixels_over;
}

TEST(Occlusion, MakesNoDifferenceOnTheWalk) {
  const auto path = world::load_camera_path(kWalk);
  ASSERT_TRUE(path);
  Studio studio("paper.toml", occlusion_view());
  std::uint32_t hidden = 0;
  for (const double seconds : {1.0, 3.0, 5.0, 9.0, 11.0, 13.5, 16.0, 18.0, 20.0, 22.0, 25.0}) {
    const core::CameraPose pose = path->pose_at(seconds, studio.state().facts.world);
    EXPECT_EQ(differing(studio, pose, hidden), 0u) << "at " << seconds << " s";
  }
  EXPECT_GT(hidden, 50u);
}

class OcclusionOf : public testing::TestWithParam<const char*> {};

TEST_P(OcclusionOf, MakesNoDifferenceToAnyImage) {
  Studio studio(GetParam(), occlusion_view());
  std::uint32_t hidden = 0;
  int turn = 0;
  for (const core::BlockCoord block : {core::BlockCoord{250, 250},
                                       {140, 311},
                                       {402, 199},
                                       {81, 104},
                                       {303, 290},
                                       {199, 420},
                                       {355, 77}}) {
    for (const double height_m : {2.0, 12.0, 60.0, 250.0}) {
      const core::CameraPose pose = studio.above(block, 13, 50, height_m, 0.9 * turn++, -0.06);
      EXPECT_EQ(differing(studio, pose, hidden), 0u)
          << height_m << " m above block " << block.x << ", " << block.z;
    }
  }
  EXPECT_GT(hidden, 50u);
}

INSTANTIATE_TEST_SUITE_P(Worlds, OcclusionOf,
                         testing::Values("paper.toml", "silver_combe.toml", "five_species.toml"),
                         [](const auto& test) {
                           const std::string file = test.param;
                           return file.substr(0, file.find('.'));
                         });

}  // namespace
}  // namespace psygen::app
