#include "engine/physics/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "engine/physics/shapes.hpp"
#include "tests/engine/physics/scene.hpp"

namespace psygen::physics {
namespace {

using testing::kBounded;
using testing::Loaded;

// A Bullet world without bodies.
struct Bare {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld bullet{&dispatcher, &broadphase, &solver, &configuration};

  // Returns the first hit of a ray in these groups, as a fraction of its length; 1: none.
  double cast(const btVector3& from, const btVector3& to, int groups) {
    btCollisionWorld::ClosestRayResultCallback hit(from, to);
    hit.m_collisionFilterGroup = kBodies;
    hit.m_collisionFilterMask = groups;
    bullet.rayTest(from, to, hit);
    return hit.m_closestHitFraction;
  }
};

TEST(PhysicsTerrain, HeightfieldsAreTheTrianglesOfTheFinestMesh) {
  for (const char* name : testing::kWorldNames) {
    const Loaded loaded = Loaded::shipped(name);
    query::World query(loaded.world, loaded.registry);
    Bare bare;
    Terrain terrain(bare.bullet, query);
    terrain.set_origin(query::testing::some_block(loaded.world));
    terrain.need({0, 0}, {100, 100}, 1);
    core::RandomStream random(1, 0, 0, 0, core::Purpose::kPosition);
    for (int i = 0; i < 2000; ++i) {
      const btVector3 at{random.next_real(0, 100), 0, random.next_real(0, 100)};
      const double height = terrain.ground(at).height_m;
      const double hit = bare.cast(at + btVector3(0, 5000, 0), at - btVector3(0, 5000, 0), kGround);
      ASSERT_NEAR(5000 - hit * 10'000, height, 1e-6) << name;
    }
  }
}

TEST(PhysicsTerrain, ModelsAreThoseThatRaysHit) {
  const Loaded loaded = Loaded::shipped("paper");
  query::World query(loaded.world, loaded.registry);
  Bare bare;
  Terrain terrain(bare.bullet, query);
  terrain.set_origin({7, 9});
  terrain.need({0, 0}, {63, 63}, 1);
  std::vector<query::NearbyModel> near;
  ASSERT_TRUE(query.models_within({{7, 9}, {31, 100, 31}}, 130, near));
  int hits = 0;
  for (const query::NearbyModel& m : near) {
    if (!(m.block == core::BlockCoord{7, 9})) continue;
    const btVector3 foot = terrain.coordinates(m.position), up(0, 20, 0);
    const double hit = bare.cast(foot + up, foot, kModels);
    const auto expected =
        query.cast({.origin = terrain.position(foot + up), .longest_m = 20, .ground = false});
    ASSERT_TRUE(expected);
    ASSERT_EQ(hit < 1, expected->kind == query::HitKind::kModel);
    if (hit == 1) continue;
    ++hits;
    // Bullet's hulls have margins of 4 cm, which are longer along a ray that grazes.
    ASSERT_NEAR(hit * 20, expected->distance_m,
                0.05 / std::max(static_cast<double>(expected->normal.y), 0.05));
  }
  EXPECT_GT(hits, 40);
}

TEST(PhysicsTerrain, IsKeptForAWhileAndThenRemoved) {
  const Loaded loaded = Loaded::shipped("endless");
  query::World query(loaded.world, loaded.registry);
  Bare bare;
  Terrain terrain(bare.bullet, query);
  const double size = loaded.world.block_size_m(), reach = query.models_reach_m();
  const auto aside = static_cast<std::size_t>(std::floor((30 + reach) / size) -
                                              std::floor((30 - reach) / size) + 1);
  for (std::uint64_t step = 1; step <= 100; ++step) {
    const double x = static_cast<double>(step) * size + 30;
    terrain.need({x, 30}, {x, 30}, step);
    terrain.drop_idle(step, 10, 5);
    // Those around it, and five of those that it has left.
    EXPECT_EQ(terrain.size(), aside * aside + std::min<std::size_t>(5, (step - 1) * aside));
    EXPECT_GE(bare.bullet.getNumCollisionObjects(), static_cast<int>(terrain.size()));
  }
  terrain.drop_idle(105, 10, 100);
  EXPECT_EQ(terrain.size(), aside * aside + 5);
  terrain.drop_idle(110, 10, 100);
  EXPECT_EQ(terrain.size(), aside * aside);
  terrain.drop_idle(111, 10, 100);
  EXPECT_EQ(terrain.size(), 0U);
  EXPECT_EQ(bare.bullet.getNumCollisionObjects(), 0);
}

TEST(PhysicsTerrain, EndsAtTheWallsOfABoundedWorld) {
  const Loaded loaded = Loaded::parsed(kBounded);
  query::World query(loaded.world, loaded.registry);
  Bare bare;
  Terrain terrain(bare.bullet, query);
  terrain.set_origin({2, 1});
  terrain.need({-1e5, -1e5}, {1e5, 1e5}, 1);
  EXPECT_EQ(terrain.size(), 32U);
  const btVector3 in = terrain.inside({-1000, 3, 1000}, 0.5);
  EXPECT_NEAR(in.x(), -2 * 64 + 0.5, 1e-9);
  EXPECT_NEAR(in.z(), 3 * 64 - 0.5, 1e-9);
  EXPECT_EQ(in.y(), 3);
  EXPECT_EQ(terrain.inside({10, 3, 10}, 0.5), btVector3(10, 3, 10));
  const auto border = query.ground({{0, 3}, {0, 0, 64 - 1e-6}});
  ASSERT_TRUE(border) << border.error().message;
  EXPECT_NEAR(terrain.ground({-1000, 3, 1000}).height_m, border->height_m, 1e-5);
}

TEST(PhysicsTerrain, MovesWithTheOriginWithoutBeingRebuilt) {
  const Loaded loaded = Loaded::shipped("endless");
  query::World query(loaded.world, loaded.registry);
  Bare bare;
  Terrain terrain(bare.bullet, query);
  terrain.need({0, 0}, {100, 100}, 1);
  const auto objects = [&] {
    const auto& all = bare.bullet.getCollisionObjectArray();
    return std::set<const btCollisionObject*>(&all[0], &all[0] + all.size());
  };
  const std::set<const btCollisionObject*> before = objects();
  core::RandomStream random(1, 0, 0, 0, core::Purpose::kPosition);
  std::vector<std::pair<core::WorldPosition, double>> models;  // positions above ground and models
  for (int i = 0; i < 500; ++i) {
    const btVector3 at{random.next_real(0, 100), 2000, random.next_real(0, 100)};
    models.emplace_back(terrain.position(at),
                        bare.cast(at, at - btVector3(0, 2000, 0), kGround | kModels));
  }
  for (const core::BlockCoord to : {core::BlockCoord{70, -3}, {1 << 20, 5}, {0, 0}}) {
    terrain.set_origin(to);
    EXPECT_EQ(objects(), before);
    for (const auto& [place, share] : models) {
      const btVector3 at = terrain.coordinates(place);
      ASSERT_NEAR(bare.cast(at, at - btVector3(0, 2000, 0), kGround | kModels), share, 1e-6);
    }
  }
}

TEST(PhysicsTerrain, CoordinatesAreExactFarFromTheOrigin) {
  const Loaded loaded = Loaded::shipped("endless");
  query::World query(loaded.world, loaded.registry);
  Bare bare;
  Terrain terrain(bare.bullet, query);
  const core::BlockCoord far{1 << 30, INT32_MIN + 1};
  terrain.set_origin(far);
  const core::BlockCoord other{far.x + 2, INT32_MAX - 1};  // 3 blocks north, across the seam
  const btVector3 at = terrain.coordinates({other, {1.25, 7, 2.5}});
  EXPECT_EQ(at, btVector3(127.25, 7, -186.5));
  const core::WorldPosition back = terrain.position(at);
  EXPECT_EQ(back.block, other);
  EXPECT_EQ(back.local, glm::dvec3(1.25, 7, 2.5));
}

}  // namespace
}  // namespace psygen::physics
