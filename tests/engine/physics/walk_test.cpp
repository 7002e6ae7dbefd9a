// A character runs several kilometres through every shipped world. Where something stops it, it
// turns, as a player would.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/engine/physics/scene.hpp"

namespace psygen::physics {
namespace {

using testing::kStep;
using testing::Loaded;
using testing::Scene;

class Walk : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(, Walk,
                         ::testing::Values("paper", "endless", "lakes", "silver_combe",
                                           "five_species", "ember_pass", "thorn_country",
                                           "frost_isle"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(Walk, OfKilometresNeitherFallsThroughTheGroundNorGetsStuck) {
  Scene scene(Loaded::shipped(GetParam()));
  const double size = scene.loaded.world.block_size_m();
  const auto id = scene.physics.add(CharacterSettings{.feet = scene.above({10, 100}, 20, 20, 2)});
  ASSERT_TRUE(id);
  constexpr int kSecond = 60, kSeconds = 800;
  double walked_m = 0, turned = 0, longest_wait = 0, wait = 0;
  core::WorldPosition before = scene.physics.state(*id)->feet;
  for (int second = 0; second < kSeconds; ++second) {
    ASSERT_TRUE(scene.physics.tell(*id, {{std::cos(turned), std::sin(turned)}, true}));
    for (int k = 0; k < kSecond; ++k) {
      ASSERT_TRUE(scene.physics.step(kStep));
      const CharacterState s = *scene.physics.state(*id);
      ASSERT_GE(s.feet.local.y, scene.ground_m(s.feet) - 1e-5);
      // On the ground or a model, or falling, but never far above; or swimming, not above water.
      ASSERT_LE(s.feet.local.y,
                std::max(scene.ground_m(s.feet) + 25, scene.query.ground(s.feet)->surface_m));
    }
    const core::WorldPosition now = scene.physics.state(*id)->feet;
    const glm::dvec3 way =
        core::offset_m(now.block, before, size) + glm::dvec3(now.local.x, now.local.y, now.local.z);
    const double metres = glm::length(glm::dvec2(way.x, way.z));
    walked_m += metres;
    wait = metres < 1 ? wait + 1 : 0;
    longest_wait = std::max(longest_wait, wait);
    turned = metres < 1 ? turned + 0.7 : 0.9 * turned;  // back to the old course, slowly
    before = now;
  }
  EXPECT_GT(walked_m, 2000);
  EXPECT_LT(longest_wait, 15);
  EXPECT_LE(scene.physics.block_count(), 9U + 64);
}

}  // namespace
}  // namespace psygen::physics
