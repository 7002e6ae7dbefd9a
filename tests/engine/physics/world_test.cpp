#include "engine/physics/world.hpp"

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/world/edits/edits.hpp"
#include "tests/engine/physics/scene.hpp"

namespace psygen::physics {
namespace {

using testing::ball;
using testing::box;
using testing::kStep;
using testing::Loaded;
using testing::Scene;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// All bits of a simulation of some seconds: bodies that meet each other and models, and characters
// among them.
std::vector<double> simulated(Scene& scene, const core::BlockCoord& block) {
  std::vector<BodyId> bodies;
  std::vector<CharacterId> characters;
  for (int i = 0; i < 25; ++i) {
    core::WorldPosition at = scene.above(block, 20 + 0.8 * (i % 5), 20 + 0.9 * (i / 5), 3 + i);
    bodies.push_back(*scene.physics.add({.shape = i % 2 == 0 ? ball(0.4F) : box(glm::vec3(0.4F)),
                                         .position = at,
                                         .velocity = {1, 0, 2}}));
    if (i % 5 == 0) characters.push_back(*scene.physics.add(CharacterSettings{.feet = at}));
  }
  std::vector<double> bits;
  for (int step = 0; step < 400; ++step) {
    for (const CharacterId id : characters)
      EXPECT_TRUE(scene.physics.tell(
          id, {{std::sin(step * 0.01), std::cos(step * 0.02)}, step % 90 < 45, step % 70 == 0}));
    EXPECT_TRUE(scene.physics.step(kStep));
  }
  for (const BodyId id : bodies) {
    const BodyState s = *scene.physics.state(id);
    for (const glm::dvec3& v : {s.position.local, s.velocity, s.spin})
      bits.insert(bits.end(), {v.x, v.y, v.z});
    bits.insert(bits.end(), {s.rotation.w, s.rotation.x, s.rotation.y, s.rotation.z});
  }
  for (const CharacterId id : characters) {
    const CharacterState s = *scene.physics.state(id);
    for (const glm::dvec3& v : {s.feet.local, s.velocity})
      bits.insert(bits.end(), {v.x, v.y, v.z});
  }
  return bits;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

TEST(PhysicsWorld, TheSameInputsGiveTheSameBits) {
  for (const char* name : {"paper", "silver_combe"}) {
    Scene first(Loaded::shipped(name)), second(Loaded::shipped(name));
    // Other blocks were asked about before, in another order.
    for (int i = 30; i-- > 0;)
      (void)second.query.cast(
          {.origin = {{35 - i % 9, 30 + i}, {5, 400, 5}}, .direction = {1, -1, 1}});
    const std::vector<double> a = simulated(first, {33, 33}), b = simulated(second, {33, 33});
    EXPECT_TRUE(same_bits(a, b)) << name;
    for (const double v : a)
      ASSERT_TRUE(std::isfinite(v));
  }
}

TEST(PhysicsWorld, IsAsPreciseAtTheEndsOfTheWorld) {
  // The same block of a world without relief has the same simulation anywhere.
  const std::string flat = R"(format = 1
[world]
name = "flat"
seed = 3
blocks = [0, 0]
block_vertices = 64
cell_m = 1
[terrain]
relief_m = 0.01
)";
  Scene near(Loaded::parsed(flat)), far(Loaded::parsed(flat));
  const std::vector<double> a = simulated(near, {0, 0}), b = simulated(far, {1 << 30, -(1 << 30)});
  ASSERT_EQ(a.size(), b.size());
  // Bodies tumble, so tiny differences of the ground grow; but nothing is coarser out there.
  double moved = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_TRUE(std::isfinite(b[i]));
    moved = std::max(moved, std::abs(b[i]));
  }
  EXPECT_GT(moved, 1);
  const auto id =
      far.physics.add(CharacterSettings{.feet = far.above({1 << 30, -(1 << 30)}, 5, 5, 0)});
  ASSERT_TRUE(id);
  ASSERT_TRUE(far.physics.tell(*id, {{1, 0}}));
  far.steps(60);
  const double x = far.physics.state(*id)->feet.local.x;
  far.steps(1);
  EXPECT_NEAR(far.physics.state(*id)->feet.local.x - x, 1.6 / 60, 1e-9);
}

TEST(PhysicsWorld, CoordinatesFollowTheFirstActorOverManyKilometres) {
  Scene scene(Loaded::shipped("endless"));
  const auto id = scene.physics.add(CharacterSettings{.feet = scene.above({0, 0}, 5, 5, 300)});
  const auto body =
      scene.physics.add({.shape = ball(0.5F), .position = scene.above({0, 0}, 9, 9, 300)});
  ASSERT_TRUE(id && body);
  core::WorldPosition last = scene.physics.state(*id)->feet;
  for (int i = 0; i < 1500; ++i) {  // 7.5 km: past a move of the origin
    ASSERT_TRUE(scene.physics.set_velocity(*id, {300, 0, 0}));
    ASSERT_TRUE(scene.physics.set_velocity(*body, {300, 9, 0}, {}));
    ASSERT_TRUE(scene.physics.step(kStep));
    const core::WorldPosition now = scene.physics.state(*id)->feet;
    const double way = core::offset_m(now.block, last, 63).x + now.local.x;
    ASSERT_LT(way, 5.01);
    ASSERT_GE(way, -0.01);
    last = now;
  }
  EXPECT_GT(last.block.x, 70);
}

TEST(PhysicsWorld, RaysMeetBodiesAndCharactersAndNothingElse) {
  Scene scene(Loaded::shipped("paper"));
  core::WorldPosition at = scene.above({9, 9}, 30, 30, 50);
  const auto body =
      scene.physics.add({.shape = ball(1), .motion = Motion::kKinematic, .position = at});
  core::WorldPosition feet = at;
  feet.local.x += 10;
  feet.local.y -= 1;
  const auto character = scene.physics.add(CharacterSettings{.feet = feet});
  ASSERT_TRUE(body && character);
  core::WorldPosition eye = at;
  eye.local.x -= 5;
  const auto first = scene.physics.cast(eye, {3, 0, 0}, 100);
  ASSERT_TRUE(first && *first);
  EXPECT_EQ((*first)->body, *body);
  EXPECT_NEAR((*first)->distance_m, 4, 1e-6);
  EXPECT_NEAR((*first)->normal.x, -1, 1e-6);
  eye.local.x += 10;
  const auto second = scene.physics.cast(eye, {1, 0, 0}, 100);
  ASSERT_TRUE(second && *second);
  EXPECT_EQ((*second)->character, *character);
  const auto down = scene.physics.cast(eye, {0, -1, 0}, 1000);
  ASSERT_TRUE(down);
  EXPECT_FALSE(*down);
  EXPECT_FALSE(scene.physics.cast(eye, {0, kNan, 0}, 5));
  EXPECT_FALSE(scene.physics.cast(eye, {0, 0, 0}, 5));
  EXPECT_FALSE(scene.physics.cast(eye, {0, 1, 0}, 0));
}

TEST(PhysicsWorld, RefusesStepsAndSettingsOutOfTheirRanges) {
  Scene scene(Loaded::shipped("paper"));
  for (const double dt : {0.0, -1.0, 1.0, kNan})
    EXPECT_FALSE(scene.physics.step(dt));
  EXPECT_FALSE(World::create(scene.query, {.gravity = kNan}));
  EXPECT_FALSE(World::create(scene.query, {.gravity = -1}));
  EXPECT_FALSE(World::create(scene.query, {.most_bodies = 1'000'000'000}));
}

TEST(PhysicsWorld, TerrainIsThereBeforeTheFirstStepEndsAndGoesWhenNobodyIsThere) {
  Scene scene(Loaded::shipped("paper"), {.keep_steps = 5});
  EXPECT_EQ(scene.physics.block_count(), 0U);
  const auto id = scene.physics.add(CharacterSettings{.feet = scene.above({50, 50}, 30, 30, 0)});
  ASSERT_TRUE(id);
  scene.steps(1);
  EXPECT_GE(scene.physics.block_count(), 1U);
  scene.physics.refresh({50, 50});
  scene.steps(1);
  EXPECT_GE(scene.physics.block_count(), 1U);
  ASSERT_TRUE(scene.physics.remove(*id));
  scene.steps(10);
  EXPECT_EQ(scene.physics.block_count(), 0U);
}

TEST(PhysicsWorld, BodiesAndCharactersFollowEditsOfTheGround) {
  Scene scene(Loaded::shipped("five_species"));
  const core::WorldPosition place = scene.above({3, 4}, 20, 20, 0.5);
  const auto body = scene.physics.add(BodySettings{.shape = ball(0.4F), .position = place});
  const auto walker = scene.physics.add(CharacterSettings{.feet = scene.above({3, 4}, 26, 20, 0)});
  ASSERT_TRUE(body);
  ASSERT_TRUE(walker);
  scene.steps(120);
  const double before_m = scene.ground_m(place);
  world::Edits edits;
  ASSERT_TRUE(edits.raise(scene.loaded.world, place, 30, -4));
  world::set_edits(scene.loaded.world, edits.layer());
  scene.steps(240);
  const double after_m = scene.ground_m(place);
  EXPECT_NEAR(before_m - after_m, 4, 0.2);
  const core::WorldPosition lies = scene.physics.state(*body)->position;
  EXPECT_LT(lies.local.y - scene.ground_m(lies), 1) << "it does not hang in the air";
  const core::WorldPosition feet = scene.physics.state(*walker)->feet;
  EXPECT_NEAR(feet.local.y, scene.ground_m(feet), 0.05);
}

}  // namespace
}  // namespace psygen::physics
