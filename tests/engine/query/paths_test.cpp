// The shipped camera paths over the land and the water that they were made for.
#include "engine/world/camera_path.hpp"
#include "engine/world/files/path_file.hpp"
#include "tests/engine/query/worlds.hpp"

namespace psygen::query::testing {
namespace {

struct Flight {
  const char* world;
  const char* path;
};

class ShippedPath : public ::testing::TestWithParam<Flight> {};

// A camera path follows the ground alone, so only a height over the bed keeps it over the water.
TEST_P(ShippedPath, KeepsClearOfGroundWaterAndSlopes) {
  const Loaded loaded = Loaded::shipped(GetParam().world);
  World queries(loaded.world, loaded.registry);
  const auto path = world::load_camera_path(
      world::testing::game_file("paths/" + std::string(GetParam().path) + ".toml"));
  ASSERT_TRUE(path) << path.error().message;
  for (double t = 0; t <= path->duration_seconds(); t += 0.125) {
    const core::CameraPose pose = path->pose_at(t, loaded.world);
    const auto ground = queries.ground(pose.position);
    ASSERT_TRUE(ground) << ground.error().message;
    EXPECT_GT(pose.position.local.y - ground->surface_m, 8) << "at " << t << " s";
    Ray ray;
    ray.origin = pose.position;
    ray.direction = glm::dvec3(core::forward_of(pose));
    ray.models = false;
    ray.water = true;
    const auto hit = queries.cast(ray);
    ASSERT_TRUE(hit) << hit.error().message;
    EXPECT_GT(hit->distance_m, 80) << "the view ends at a slope at " << t << " s";
  }
}

INSTANTIATE_TEST_SUITE_P(Flights, ShippedPath,
                         ::testing::Values(Flight{"watershed", "watershed"},
                                           Flight{"silver_combe", "combe"},
                                           Flight{"lakes", "lakes"}),
                         [](const auto& flight) { return std::string(flight.param.path); });

}  // namespace
}  // namespace psygen::query::testing
