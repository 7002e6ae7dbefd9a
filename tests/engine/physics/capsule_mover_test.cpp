#include "engine/physics/capsule_mover.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "engine/physics/terrain.hpp"

namespace psygen::physics {
namespace {

// A capsule of radius 0.5 m and height 2 m among boxes.
class CapsuleMoving : public ::testing::Test {
 protected:
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld bullet{&dispatcher, &broadphase, &solver, &configuration};
  btCapsuleShape capsule{0.5, 1};
  btBoxShape box{btVector3(1, 1, 1)};
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  btRigidBody self{0, nullptr, &capsule};
  CapsuleMover mover{bullet, self, capsule, 80};

  btRigidBody& add(const btVector3& at, double mass_kg, int group) {
    bodies.push_back(std::make_unique<btRigidBody>(mass_kg, nullptr, &box, btVector3(1, 1, 1)));
    bodies.back()->setWorldTransform(btTransform(btQuaternion::getIdentity(), at));
    bullet.addRigidBody(bodies.back().get(), group, kBodies | kCharacters);
    return *bodies.back();
  }
  ~CapsuleMoving() override {
    for (const auto& body : bodies)
      bullet.removeRigidBody(body.get());
  }
};

TEST_F(CapsuleMoving, StopsAtObstacles) {
  add({5, 0, 0}, 0, kModels);
  const Sweep sweep = mover.sweep({0, 0, 0}, {10, 0, 0});
  ASSERT_TRUE(sweep.hit);
  EXPECT_NEAR(sweep.fraction, 0.35, 0.006);  // with Bullet's margin
  EXPECT_NEAR(sweep.normal.x(), -1, 1e-6);
  EXPECT_FALSE(mover.sweep({0, 0, 0}, {0, 0, 10}).hit);
  EXPECT_FALSE(mover.sweep({0, 0, 0}, {0, 0, 0}).hit);
}

TEST_F(CapsuleMoving, IgnoresTheGroundLightBodiesAndItself) {
  add({3, 0, 0}, 0, kGround);
  btRigidBody& light = add({5, 0, 0}, 10, kBodies);
  EXPECT_FALSE(mover.stops(light));
  EXPECT_FALSE(mover.stops(self));
  EXPECT_FALSE(mover.sweep({0, 0, 0}, {20, 0, 0}).hit);
  btRigidBody& heavy = add({9, 0, 0}, 1000, kBodies);
  EXPECT_TRUE(mover.stops(heavy));
  EXPECT_NEAR(mover.sweep({0, 0, 0}, {10, 0, 0}).fraction, 0.75, 0.006);
}

TEST_F(CapsuleMoving, IsNotHeldByABodyThatItLeaves) {
  add({1.5, 0, 0}, 0, kModels);  // touches it
  EXPECT_FALSE(mover.sweep({0, 0, 0}, {-5, 0, 0}).hit);
  EXPECT_FALSE(mover.sweep({0, 0, 0}, {0, 0, 5}).hit);
}

TEST_F(CapsuleMoving, IsPushedOutOfOverlappingBodies) {
  add({1.2, 0, 0}, 0, kModels);
  const btVector3 free = mover.pushed_out({0, 0, 0});
  EXPECT_NEAR(free.x(), -0.3, 0.05);
  EXPECT_NEAR(free.y(), 0, 1e-3);
  const btVector3 far = mover.pushed_out({-5, 0, 0});
  EXPECT_EQ(far, btVector3(-5, 0, 0));
}

}  // namespace
}  // namespace psygen::physics
