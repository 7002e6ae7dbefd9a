#include "engine/physics/ground_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <memory>
#include <vector>

#include "engine/physics/shapes.hpp"
#include "engine/world/edits/edits.hpp"
#include "tests/engine/physics/scene.hpp"

namespace psygen::physics {
namespace {

using models::Collider;
using testing::ball;
using testing::box;
using testing::kStep;
using testing::Loaded;
using testing::Scene;

struct Slider {
  const char* name;
  Collider shape;
  double rest_m;  // height of its position above the ground when it rests
  glm::dquat rotation{1, 0, 0, 0};
};

std::vector<Slider> sliders() {
  const glm::dquat lying = glm::angleAxis(glm::half_pi<double>(), glm::dvec3(0, 0, 1));
  Collider capsule, hull, sledge;
  capsule.shapes.emplace_back(Collider::Capsule{{0, -0.3F, 0}, {0, 0.3F, 0}, 0.3F});
  Collider::Hull prism;
  for (const float x : {-0.7F, 0.7F})
    for (const glm::vec2 at : {glm::vec2(-0.5F, -0.2F), {0.5F, -0.2F}, {0, 0.4F}})
      prism.points.emplace_back(x, at.y, at.x);
  hull.shapes.emplace_back(std::move(prism));
  sledge.shapes.emplace_back(Collider::Box{{-0.8F, -0.2F, -0.4F}, {0.8F, -0.1F, -0.3F}});
  sledge.shapes.emplace_back(Collider::Box{{-0.8F, -0.2F, 0.3F}, {0.8F, -0.1F, 0.4F}});
  sledge.shapes.emplace_back(Collider::Sphere{{0, 0, 0}, 0.15F});
  return {{"box", box(glm::vec3(0.5F)), 0.5},
          {"plate", box({1.5F, 0.1F, 2}), 0.1},
          {"crumb", box(glm::vec3(0.03F)), 0.03},
          {"ball", ball(0.3F), 0.3},
          {"capsule", capsule, 0.3, lying},
          {"hull", hull, 0.24},  // a margin of 4 cm
          {"sledge", sledge, 0.2}};
}

TEST(GroundContacts, BodiesSlideOverEvenGroundAndItsBorders) {
  Scene scene(Loaded::parsed(R"(format = 1
[world]
name = "even"
seed = 3
blocks = [0, 0]
[terrain]
relief_m = 100
feature_m = 500
)"));
  world::Edits edits;
  ASSERT_TRUE(edits.flatten(scene.loaded.world, {{0, 0}, {31, 0, 31}}, 500, 30));
  world::set_edits(scene.loaded.world, edits.layer());
  const double size = scene.loaded.world.block_size_m();
  for (const Slider& slider : sliders()) {
    for (const glm::dvec2 way : {glm::dvec2(1, 0), {0, -1}, {-0.8, 0.6}}) {
      const core::WorldPosition from = scene.above({0, 0}, 20.13, 20.29, slider.rest_m + 0.005);
      const BodyId id = *scene.physics.add({.shape = slider.shape,
                                            .position = from,
                                            .rotation = slider.rotation,
                                            .mass_kg = 10,
                                            .friction = 0});
      scene.steps(40);
      const core::WorldPosition start = scene.physics.state(id)->position;
      ASSERT_TRUE(scene.physics.set_velocity(id, {10 * way.x, 0, 10 * way.y}, {}));
      double hop_m = 0;
      for (int i = 0; i < 1200; ++i) {
        scene.steps(1);
        hop_m = std::max(hop_m, scene.physics.state(id)->position.local.y - start.local.y);
      }
      const BodyState end = *scene.physics.state(id);
      const glm::dvec3 gone = core::offset_m(end.position.block, {start.block}, size) +
                              end.position.local - start.local;
      EXPECT_LT(hop_m, 0.01) << slider.name;
      EXPECT_NEAR(gone.x * way.x + gone.z * way.y, 200, 0.1) << slider.name;
      EXPECT_NEAR(gone.x * way.y - gone.z * way.x, 0, 0.01) << slider.name;
      EXPECT_NEAR(glm::length(end.velocity), 10, 0.01) << slider.name;
      ASSERT_TRUE(scene.physics.remove(id));
    }
  }
}

// Two blocks of ground side by side along x, of 33² vertices and 1 m, with their corner at the
// origin.
class Ground {
 public:
  static constexpr int kSize = 33, kLast = kSize - 1;

  template <class Height>
  explicit Ground(const Height& height_m) {
    bullet_.setGravity({0, -10, 0});
    for (int block = 0; block < 2; ++block) {
      std::vector<double>& heights = heights_[block];
      for (int z = 0; z < kSize; ++z)
        for (int x = 0; x < kSize; ++x)
          heights.push_back(height_m(x + block * kLast, z));
      const auto [low, high] = std::ranges::minmax(heights);
      shapes_[block] = std::make_unique<GroundShape>(
          kSize, heights.data(), 1, low, high, [height_m, block](int x, int z) {
            const int along = x + block * kLast;
            return z < 0 || z > kLast || along < 0 || along > 2 * kLast ? testing::kNan
                                                                        : height_m(along, z);
          });
      objects_[block].setCollisionShape(shapes_[block].get());
      objects_[block].setWorldTransform(upright({16.0 + 32 * block, 0.5 * (low + high), 16}));
      bullet_.addCollisionObject(&objects_[block]);
    }
  }
  ~Ground() {
    for (const auto& body : bodies_)
      bullet_.removeRigidBody(body.get());
    for (btCollisionObject& object : objects_)
      bullet_.removeCollisionObject(&object);
  }
  Ground(const Ground&) = delete;
  Ground& operator=(const Ground&) = delete;

  btRigidBody& add(btCollisionShape& shape, const btTransform& pose, const btVector3& velocity) {
    btVector3 inertia;
    shape.calculateLocalInertia(1, inertia);
    bodies_.push_back(std::make_unique<btRigidBody>(1, nullptr, &shape, inertia));
    btRigidBody& body = *bodies_.back();
    put(bullet_, body, pose);
    body.setFriction(0);
    body.setLinearVelocity(velocity);
    body.setActivationState(DISABLE_DEACTIVATION);
    bullet_.addRigidBody(&body);
    return body;
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i)
      bullet_.stepSimulation(kStep, 0);
  }
  bool allows(const btVector3& normal, double x, double z, const btVector3 (&triangle)[3]) {
    btVector3 local[3];
    const btVector3 origin = objects_[0].getWorldTransform().getOrigin();
    for (int i = 0; i < 3; ++i)
      local[i] = triangle[i] - origin;
    btVector3 point(x, 0, z);
    const btVector3 up = (local[1] - local[0]).cross(local[2] - local[0]);
    point.setY(triangle[0].y() -
               (up.x() * (x - triangle[0].x()) + up.z() * (z - triangle[0].z())) / up.y());
    return shapes_[0]->allows(normal.normalized(), point - origin, local);
  }

 private:
  GroundConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld bullet_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<double> heights_[2];
  std::unique_ptr<GroundShape> shapes_[2];
  btCollisionObject objects_[2];
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

TEST(GroundContacts, BodiesSlideDownSlopesAsOnAPlane) {
  const double slope = std::tan(glm::radians(15.0));
  const btVector3 downhill = btVector3(1, -slope, 0).normalized();
  const btQuaternion turn(btVector3(0, 0, 1), -glm::radians(15.0));
  btBoxShape box({0.5, 0.2, 0.4});
  btSphereShape ball(0.25);
  btCapsuleShape capsule(0.2, 0.8);
  Ground ground([&](int x, int) { return -slope * x; });
  double z = 5.3;
  for (const auto& [shape, height_m] :
       {std::pair<btCollisionShape*, double>{&box, 0.2}, {&ball, 0.25}, {&capsule, 0.2}}) {
    const btQuaternion lies =
        shape == &capsule ? turn * btQuaternion(btVector3(0, 0, 1), glm::half_pi<double>()) : turn;
    const btVector3 normal = downhill.rotate({0, 0, 1}, glm::half_pi<double>());
    const btVector3 start = btVector3(3.1, -slope * 3.1, z) + normal * height_m;
    btRigidBody& body = ground.add(*shape, btTransform(lies, start), {0, 0, 0});
    ground.steps(360);  // past the border of the blocks, at x = 32
    const btVector3 gone = body.getWorldTransform().getOrigin() - start;
    // Semi-implicit steps: a · dt² · n (n + 1) / 2.
    const double way = 10 * std::sin(glm::radians(15.0)) * kStep * kStep * 360 * 361 / 2;
    EXPECT_GT(start.x() + gone.x(), 40);
    EXPECT_NEAR(gone.dot(downhill), way, 0.01 * way);
    EXPECT_NEAR(gone.dot(normal), 0, 0.01) << height_m << shape->getName();
    EXPECT_NEAR(gone.z(), 0, 0.01);
    z += 6;
  }
}

TEST(GroundContacts, RisesAndTheirEdgesStopBodies) {
  // A terrace of 3 m, one cell steep, beyond the border of the blocks.
  btBoxShape box({0.5, 0.5, 0.5});
  btSphereShape ball(0.4);
  for (const int from : {10, 31, 32, 40}) {
    Ground ground([&](int x, int) { return x > from ? 3.0 : 0.0; });
    const btRigidBody& a = ground.add(box, upright({from - 6.0, 0.5, 10.3}), {10, 0, 0});
    const btRigidBody& b = ground.add(ball, upright({from - 6.0, 0.4, 20.3}), {5, 0, 0});
    ground.steps(120);
    for (const btRigidBody* body : {&a, &b}) {
      const btVector3& at = body->getWorldTransform().getOrigin();
      EXPECT_TRUE(at.x() < from + 1 || at.y() > 3.2) << from;
      EXPECT_GT(at.y(), 0.2) << from;
    }
    EXPECT_LT(b.getLinearVelocity().x(), 0) << from;
  }
}

TEST(GroundContacts, RidgesAndPeaksCarryBodies) {
  btBoxShape box({1.5, 0.2, 1.5});
  for (const int x0 : {12, 32}) {
    Ground ridge([&](int x, int) { return -0.8 * std::abs(x - x0); });
    Ground peak([&](int x, int z) { return -0.8 * (std::abs(x - x0) + std::abs(z - 16)); });
    for (Ground* ground : {&ridge, &peak}) {
      const btRigidBody& body =
          ground->add(box, upright({static_cast<double>(x0), 0.2, 16}), {0, 0, 0});
      ground->steps(30);
      EXPECT_NEAR(body.getWorldTransform().getOrigin().y(), 0.2, 0.02) << x0;
    }
  }
}

TEST(GroundContacts, NormalsLieBetweenTheTrianglesOfConvexEdges) {
  const btVector3 left[] = {{11, 0, 10}, {11, 0, 11}, {12, 0, 10}};
  const auto at = [&](auto&& height_m) {
    btVector3 triangle[3] = {left[0], left[1], left[2]};
    for (btVector3& v : triangle)
      v.setY(height_m(static_cast<int>(v.x()), 0));
    Ground ground(height_m);
    return std::vector<bool>{ground.allows({0, 1, 0}, 11, 10.4, triangle),
                             ground.allows({0.5, 1, 0}, 11, 10.4, triangle),
                             ground.allows({-0.5, 1, 0}, 11, 10.4, triangle),
                             ground.allows({0, 1, 0}, 11, 10, triangle),
                             ground.allows({0, 1, 0.2}, 11, 10, triangle),
                             ground.allows({0, -1, 0}, 11, 10, triangle)};
  };
  EXPECT_EQ(at([](int, int) { return 0.0; }),
            (std::vector<bool>{true, false, false, true, false, false}));
  EXPECT_EQ(at([](int x, int) { return -1.0 * std::abs(x - 11); }),
            (std::vector<bool>{true, true, true, true, false, false}));
  EXPECT_EQ(at([](int x, int) { return -1.0 * std::max(x - 11, 0); }),
            (std::vector<bool>{true, true, false, true, false, false}));
  EXPECT_EQ(at([](int x, int) { return 1.0 * std::abs(x - 11); }),
            (std::vector<bool>{false, false, false, false, false, false}));
}

}  // namespace
}  // namespace psygen::physics
