#include "engine/physics/world.hpp"

#include <algorithm>
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
using testing::kNan;
using testing::kStep;
using testing::Loaded;
using testing::Scene;

// Returns all bits of a simulation of some seconds: bodies that hit each other and models, and
// characters among them.
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
    // Queries other blocks first, in another order.
    for (int i = 30; i-- > 0;)
      (void)second.query.cast(
          {.origin = {{35 - i % 9, 30 + i}, {5, 400, 5}}, .direction = {1, -1, 1}});
    const std::vector<double> a = simulated(first, {33, 33}), b = simulated(second, {33, 33});
    EXPECT_TRUE(same_bits(a, b)) << name;
    for (const double v : a)
      ASSERT_TRUE(std::isfinite(v));
  }
}

// Returns the positions of a thrown ball and a walking character after a second, in a block of a
// flat world. Both start at the same positions of any block.
std::vector<double> second_in(core::BlockCoord block) {
  Scene scene(Loaded::parsed(R"(format = 1
[world]
name = "flat"
seed = 3
blocks = [0, 0]
block_vertices = 64
cell_m = 1
[terrain]
relief_m = 0.01
)"));
  const auto ball = scene.physics.add(
      {.shape = testing::ball(0.5F), .position = {block, {3, 100, 4}}, .velocity = {10, 0, -7}});
  const auto walker = scene.physics.add(CharacterSettings{.feet = scene.above(block, 5, 5, 0)});
  EXPECT_TRUE(scene.physics.tell(*walker, {{1, 0.5}}));
  scene.steps(60);
  const BodyState b = *scene.physics.state(*ball);
  const CharacterState c = *scene.physics.state(*walker);
  const glm::dvec3 at = core::offset_m(b.position.block, {block}, 63) + b.position.local;
  EXPECT_GT(c.feet.local.x, 5.5);
  return {at.x, at.y, at.z, b.velocity.y, c.feet.local.x, c.feet.local.z};
}

TEST(PhysicsWorld, IsAsPreciseAtTheEndsOfTheWorld) {
  const std::vector<double> near = second_in({0, 0}), far = second_in({1 << 30, -(1 << 30)});
  for (std::size_t i = 0; i < near.size(); ++i)
    EXPECT_NEAR(near[i], far[i], 1e-9) << i;
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

TEST(PhysicsWorld, RaysHitBodiesAndCharactersOnly) {
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

TEST(PhysicsWorld, RejectsStepsAndSettingsOutOfTheirRanges) {
  Scene scene(Loaded::shipped("paper"));
  for (const double dt : {0.0, -1.0, 1.0, kNan})
    EXPECT_FALSE(scene.physics.step(dt));
  EXPECT_FALSE(World::create(scene.query, {.gravity = kNan}));
  EXPECT_FALSE(World::create(scene.query, {.gravity = -1}));
  EXPECT_FALSE(World::create(scene.query, {.max_bodies = 1'000'000'000}));
}

TEST(PhysicsWorld, LoadsTerrainInTheFirstStepAndUnloadsItWithoutActors) {
  Scene scene(Loaded::shipped("paper"), {.keep_steps = 5});
  EXPECT_EQ(scene.physics.block_count(), 0U);
  const auto id = scene.physics.add(CharacterSettings{.feet = scene.above({50, 50}, 30, 30, 0)});
  ASSERT_TRUE(id);
  scene.steps(1);
  // 2.2 m by its size, 2 m of margin, and the reach of models of other blocks.
  const double size = scene.loaded.world.block_size_m();
  const double reach = 2.2 + 2 + scene.query.models_reach_m();
  const auto aside = static_cast<std::size_t>(std::floor((30 + reach) / size) -
                                              std::floor((30 - reach) / size) + 1);
  EXPECT_EQ(scene.physics.block_count(), aside * aside);
  ASSERT_TRUE(scene.physics.remove(*id));
  scene.steps(10);
  EXPECT_EQ(scene.physics.block_count(), 0U);
}

// Steps until all bodies are asleep.
void let_sleep(Scene& scene, const std::vector<BodyId>& bodies) {
  const auto sleeps = [&](BodyId id) { return scene.physics.state(id)->asleep; };
  for (int i = 0; i < 6000 && !std::ranges::all_of(bodies, sleeps); ++i)
    scene.steps(1);
  ASSERT_TRUE(std::ranges::all_of(bodies, sleeps));
}

TEST(PhysicsWorld, EditsWakeOnlyTheBodiesThatTheyReach) {
  Scene scene(Loaded::shipped("five_species"));
  std::vector<BodyId> bodies;
  for (const core::BlockCoord block : {core::BlockCoord{3, 4}, {9, 4}, {3, 12}})
    bodies.push_back(*scene.physics.add({.shape = box(glm::vec3(0.5F)),
                                         .position = scene.above(block, 20, 20, 0.6),
                                         .friction = 10}));
  let_sleep(scene, bodies);
  const core::WorldPosition place = scene.physics.state(bodies[0])->position;
  world::Edits edits;
  ASSERT_TRUE(edits.raise(scene.loaded.world, place, 12, 5));
  world::set_edits(scene.loaded.world, edits.layer());
  scene.steps(1);
  EXPECT_FALSE(scene.physics.state(bodies[0])->asleep);
  EXPECT_TRUE(scene.physics.state(bodies[1])->asleep);
  EXPECT_TRUE(scene.physics.state(bodies[2])->asleep);
  const core::WorldPosition now = scene.physics.state(bodies[0])->position;
  EXPECT_GE(now.local.y, scene.ground_m(now)) << "it is not inside the new ground";
}

TEST(PhysicsWorld, SleepingBodiesKeepTheirGroundWhenTheOriginMoves) {
  Scene scene(Loaded::shipped("endless"));
  const auto walker = scene.physics.add(CharacterSettings{.feet = scene.above({0, 0}, 5, 5, 0)});
  const auto body = scene.physics.add({.shape = box(glm::vec3(0.5F)),
                                       .position = scene.above({1, 1}, 20, 20, 0.6),
                                       .friction = 10});
  ASSERT_TRUE(walker && body);
  let_sleep(scene, {*body});
  const core::WorldPosition before = scene.physics.state(*body)->position;
  ASSERT_TRUE(scene.physics.set_feet(*walker, scene.above({90, -80}, 5, 5, 0)));
  scene.steps(300);  // longer than idle blocks stay loaded
  EXPECT_TRUE(scene.physics.state(*body)->asleep);
  EXPECT_EQ(scene.physics.state(*body)->position.block, before.block);
  EXPECT_NEAR(glm::length(scene.physics.state(*body)->position.local - before.local), 0, 1e-9);
  ASSERT_TRUE(scene.physics.push(*body, {0, 0.01, 0}));
  scene.steps(60);
  EXPECT_NEAR(scene.physics.state(*body)->position.local.y, before.local.y, 0.05);
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
  EXPECT_LT(lies.local.y - scene.ground_m(lies), 1) << "it does not float";
  const core::WorldPosition feet = scene.physics.state(*walker)->feet;
  EXPECT_NEAR(feet.local.y, scene.ground_m(feet), 0.05);
}

TEST(PhysicsWorld, FollowsAReplacedWorldInTheNextStep) {
  const std::string before = kBounded;
  const auto with = [&](const char* what, const char* by) {
    std::string text = before;
    return text.replace(text.find(what), std::string(what).size(), by);
  };
  for (const std::string& after :
       {with("seed = 5", "seed = 8"), with("relief_m = 60", "relief_m = 150"),
        with("relief_m = 60", "relief_m = 9"),
        with("block_vertices = 33", "block_vertices = 17")}) {
    Scene scene(Loaded::parsed(before));
    const auto walker = scene.physics.add(CharacterSettings{.feet = scene.above({2, 1}, 9, 9, 0)});
    std::vector<BodyId> boxes;
    for (int i = 0; i < 4; ++i)
      boxes.push_back(*scene.physics.add({.shape = box(glm::vec3(0.5F)),
                                          .position = scene.above({2, 1}, 20 + 8.0 * i, 30, 0.6),
                                          .friction = 10}));
    let_sleep(scene, boxes);
    const double block_m = scene.loaded.world.block_size_m();
    const core::WorldPosition feet = scene.physics.state(*walker)->feet;
    Loaded next = Loaded::parsed(after);
    next.world.revision.number = 1;
    std::swap(scene.loaded, next);
    const core::WorldPosition now = scene.physics.state(*walker)->feet;
    const core::WorldPosition same =
        world::rebased(feet, block_m, scene.loaded.world.block_size_m());
    EXPECT_EQ(now.block, same.block);
    EXPECT_NEAR(now.local.x, same.local.x, 1e-9);
    scene.steps(1);
    for (const BodyId id : boxes) {
      const auto state = scene.physics.state(id);
      EXPECT_FALSE(state->asleep);
      EXPECT_GT(state->position.local.y, scene.ground_m(state->position) - 0.01);
    }
    scene.steps(600);
    const auto state = scene.physics.state(*walker);
    EXPECT_NEAR(state->feet.local.y, scene.ground_m(state->feet), 2);
    EXPECT_GE(state->feet.local.y, scene.ground_m(state->feet) - 1e-6);
    for (const BodyId id : boxes) {
      const core::WorldPosition at = scene.physics.state(id)->position;
      EXPECT_LT(at.local.y - scene.ground_m(at), 3) << "fell onto the new ground";
    }
  }
}

}  // namespace
}  // namespace psygen::physics
