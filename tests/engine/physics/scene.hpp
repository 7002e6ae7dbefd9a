// A shipped world with its queries and physics, for tests.
#pragma once

#include <limits>

#include "engine/physics/world.hpp"
#include "tests/engine/query/worlds.hpp"

namespace psygen::physics::testing {

using query::testing::kBounded;
using query::testing::kWorldNames;
using query::testing::Loaded;

inline constexpr double kStep = 1.0 / 60;
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Loaded first, as queries and physics refer to it.
struct Scene {
  Loaded loaded;
  query::World query;
  World physics;

  explicit Scene(Loaded from, const Settings& settings = {})
      : loaded(std::move(from)),
        query(loaded.world, loaded.registry),
        physics(*World::create(query, settings)) {}
  static Scene shipped(const std::string& name) { return Scene(Loaded::shipped(name)); }
  Scene(const Scene&) = delete;

  double ground_m(const core::WorldPosition& at) {
    const auto ground = query.ground(at);
    EXPECT_TRUE(ground) << ground.error().message;
    return ground ? ground->height_m : 0;
  }
  // A position some metres above the ground.
  core::WorldPosition above(core::BlockCoord block, double x, double z, double height_m) {
    core::WorldPosition at{block, {x, 0, z}};
    at.local.y = ground_m(at) + height_m;
    return at;
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i)
      ASSERT_TRUE(physics.step(kStep));
  }
};

inline models::Collider ball(float radius) {
  models::Collider c;
  c.shapes.emplace_back(models::Collider::Sphere{{0, 0, 0}, radius});
  return c;
}
inline models::Collider box(const glm::vec3& half) {
  models::Collider c;
  c.shapes.emplace_back(models::Collider::Box{-half, half});
  return c;
}

}  // namespace psygen::physics::testing
