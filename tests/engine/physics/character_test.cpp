// Characters of physics::World: walking, slopes, steps, jumps.
#include "engine/physics/character.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "tests/engine/physics/scene.hpp"

namespace psygen::physics {
namespace {

using testing::ball;
using testing::box;
using testing::kBounded;
using testing::Loaded;
using testing::Scene;

// A wide floor in the air, so that neither slopes nor models matter.
struct Floor {
  Scene scene{Loaded::shipped("five_species")};
  core::WorldPosition middle = scene.above({5, 5}, 30, 30, 60);
  BodyId floor;
  CharacterId character;

  explicit Floor(double feet_above_m = 0.5) {
    floor = *scene.physics.add(
        {.shape = box({40, 0.5F, 40}), .motion = Motion::kKinematic, .position = middle});
    middle.local.y += 0.5;
    core::WorldPosition feet = middle;
    feet.local.y += feet_above_m;
    character = *scene.physics.add(CharacterSettings{.feet = feet});
    scene.steps(90);
  }
  CharacterState state() { return *scene.physics.state(character); }
  // Metres from the middle of the floor.
  glm::dvec3 at() {
    const CharacterState s = state();
    const double size = scene.loaded.world.block_size_m();
    return s.feet.local - middle.local +
           glm::dvec3((s.feet.block.x - middle.block.x) * size, 0,
                      (s.feet.block.z - middle.block.z) * size);
  }
  void walk(const glm::dvec2& direction, int steps, bool run = false, bool jump = false) {
    ASSERT_TRUE(scene.physics.tell(character, {direction, run, jump}));
    scene.steps(steps);
  }
  BodyId add_box(const glm::vec3& half, const glm::dvec3& place, Motion motion,
                 double mass_kg = 1) {
    core::WorldPosition p = middle;
    p.local += place;
    return *scene.physics.add(
        {.shape = box(half), .motion = motion, .position = p, .mass_kg = mass_kg});
  }
};

TEST(Character, StandsOnABody) {
  Floor f;
  EXPECT_TRUE(f.state().on_ground);
  EXPECT_NEAR(f.at().y, 0, 0.03);
  const glm::dvec3 before = f.at();
  f.scene.steps(300);
  EXPECT_NEAR(glm::length(f.at() - before), 0, 1e-6);
}

TEST(Character, WalksAndRunsAtItsSpeeds) {
  Floor f;
  f.walk({0, 1}, 60);
  EXPECT_NEAR(glm::length(f.state().velocity), 1.6, 1e-6);
  EXPECT_NEAR(f.at().z, 1.6, 0.1);
  f.walk({10, 0}, 120, true);
  EXPECT_NEAR(f.state().velocity.x, 5, 1e-6);
  f.walk({0, 0}, 30);
  EXPECT_NEAR(glm::length(f.state().velocity), 0, 1e-6);
  EXPECT_NEAR(f.at().y, 0, 0.03);
}

TEST(Character, JumpsAsHighAsItsSpeedAllowsAndOnlyFromTheGround) {
  Floor f;
  double highest = 0;
  f.walk({0, 0}, 1, false, true);
  EXPECT_FALSE(f.state().on_ground);
  for (int i = 0; i < 120; ++i) {
    f.scene.steps(1);
    highest = std::max(highest, f.at().y);
  }
  EXPECT_NEAR(highest, 4.5 * 4.5 / (2 * 9.81), 0.1);
  EXPECT_TRUE(f.state().on_ground);
  EXPECT_NEAR(f.at().y, 0, 0.03);
}

TEST(Character, ClimbsLowStepsAndStopsAtHighOnes) {
  for (const double height : {0.2, 0.35, 0.8, 2.0}) {
    Floor f;
    const auto half = static_cast<float>(0.5 * height);
    f.add_box({1, half, 3}, {3, 0.5 * height, 0}, Motion::kKinematic);
    f.scene.steps(2);
    f.walk({1, 0}, 150);
    if (height < 0.4) {
      EXPECT_GT(f.at().x, 2.2) << height;
      f.scene.steps(120);
      EXPECT_GT(f.at().x, 4.2) << height;
      EXPECT_NEAR(f.at().y, 0, 0.05);
    } else {
      EXPECT_LT(f.at().x, 1.75) << height;
      EXPECT_GT(f.at().x, 1.5) << height;
      EXPECT_NEAR(f.at().y, 0, 0.05);
    }
  }
}

TEST(Character, SlidesAlongWalls) {
  Floor f;
  f.add_box({0.5F, 2, 30}, {2, 2, 0}, Motion::kKinematic);
  f.scene.steps(2);
  f.walk(glm::normalize(glm::dvec2(1, 1)), 400, true);
  EXPECT_LT(f.at().x, 1.25);
  EXPECT_GT(f.at().z, 20);
}

TEST(Character, PushesLightBodiesAndIsStoppedByHeavyOnes) {
  Floor f;
  const BodyId light = f.add_box(glm::vec3(0.4F), {2, 0.41, 0}, Motion::kDynamic, 5);
  f.walk({1, 0}, 240);
  EXPECT_GT(f.at().x, 4);
  core::WorldPosition place = f.scene.physics.state(light)->position;
  EXPECT_GT(place.local.x - f.middle.local.x, 2.5);
  Floor g;
  g.add_box(glm::vec3(0.4F), {2, 0.41, 0}, Motion::kDynamic, 5000);
  g.walk({1, 0}, 240);
  EXPECT_LT(g.at().x, 2.0);
}

TEST(Character, IsStoppedByAnotherCharacter) {
  Floor f;
  core::WorldPosition other = f.middle;
  other.local.x += 3;
  ASSERT_TRUE(f.scene.physics.add(CharacterSettings{.feet = other}));
  f.walk({1, 0}, 300);
  EXPECT_LT(f.at().x, 2.5);
  EXPECT_GT(f.at().x, 2.2);
}

TEST(Character, HitsItsHeadAndFallsBack) {
  Floor f;
  f.add_box({5, 0.1F, 5}, {0, 2.2, 0}, Motion::kKinematic);
  f.scene.steps(2);
  double highest = 0;
  f.walk({0, 0}, 1, false, true);
  for (int i = 0; i < 60; ++i) {
    highest = std::max(highest, f.at().y);
    f.scene.steps(1);
  }
  EXPECT_LT(highest, 0.35);
  EXPECT_TRUE(f.state().on_ground);
}

TEST(Character, FollowsTheGroundDownhillWithoutHopping) {
  for (const char* name : testing::kWorldNames) {
    Scene scene(Loaded::shipped(name));
    int checked = 0;
    for (int i = 0; i < 12; ++i) {
      const core::WorldPosition start = scene.above({20 + 3 * i, 20}, 31, 31, 0);
      const auto ground = scene.query.ground(start);
      const glm::dvec2 downhill(static_cast<double>(ground->normal.x),
                                static_cast<double>(ground->normal.z));
      if (ground->normal.y < 0.75F || glm::length(downhill) < 0.05) continue;
      const auto id = scene.physics.add(CharacterSettings{.feet = start});
      ASSERT_TRUE(id);
      ASSERT_TRUE(scene.physics.tell(*id, {glm::normalize(downhill)}));
      for (int k = 0; k < 60; ++k) {
        scene.steps(1);
        const CharacterState s = *scene.physics.state(*id);
        if (!s.on_ground) continue;  // steep places are allowed
        ++checked;
      }
      ASSERT_TRUE(scene.physics.remove(*id));
    }
    EXPECT_GT(checked, 100) << name;
  }
}

TEST(Character, DoesNotClimbGroundThatIsTooSteep) {
  Scene scene(Loaded::shipped("silver_combe"));
  int steep = 0;
  for (int i = 0; i < 4000 && steep < 25; ++i) {
    // In the middle of a triangle.
    const core::WorldPosition at = scene.above({i % 60, i / 60}, 31.33, 31.33, 0);
    const auto ground = scene.query.ground(at);
    if (ground->normal.y > 0.6F) continue;  // 53° and steeper
    ++steep;
    const auto id = scene.physics.add(CharacterSettings{.feet = at});
    ASSERT_TRUE(id);
    const glm::dvec2 uphill = -glm::normalize(
        glm::dvec2(static_cast<double>(ground->normal.x), static_cast<double>(ground->normal.z)));
    ASSERT_TRUE(scene.physics.tell(*id, {uphill}));
    scene.steps(20);
    EXPECT_LT(scene.physics.state(*id)->feet.local.y, at.local.y + 0.01);
    ASSERT_TRUE(scene.physics.remove(*id));
  }
  EXPECT_GT(steep, 3);
}

TEST(Character, RefusesWhatIsNotLegal) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Scene scene(Loaded::parsed(kBounded));
  const CharacterSettings sound{.feet = scene.above({1, 1}, 5, 5, 1)};
  const auto refused = [&](auto&& change) {
    CharacterSettings s = sound;
    change(s);
    return !scene.physics.add(s);
  };
  EXPECT_TRUE(refused([](CharacterSettings& s) { s.feet.local.x = kNan; }));
  EXPECT_TRUE(refused([](CharacterSettings& s) { s.feet.block = {-1, 0}; }));
  EXPECT_TRUE(refused([](CharacterSettings& s) { s.radius_m = 0; }));
  EXPECT_TRUE(refused([](CharacterSettings& s) { s.height_m = 0.1; }));
  EXPECT_TRUE(refused([](CharacterSettings& s) { s.walk_speed = kNan; }));
  EXPECT_TRUE(refused([](CharacterSettings& s) { s.jump_speed = -1; }));
  EXPECT_TRUE(refused([](CharacterSettings& s) { s.step_height_m = 99; }));
  EXPECT_TRUE(refused([](CharacterSettings& s) { s.steepest_deg = 90; }));
  EXPECT_TRUE(refused([](CharacterSettings& s) { s.mass_kg = 0; }));
  const auto id = scene.physics.add(sound);
  ASSERT_TRUE(id);
  EXPECT_FALSE(scene.physics.tell(*id, {{kNan, 0}}));
  EXPECT_FALSE(scene.physics.set_velocity(*id, {0, kNan, 0}));
  EXPECT_FALSE(scene.physics.set_feet(*id, {{50, 0}, {0, 0, 0}}));
  EXPECT_FALSE(scene.physics.tell({77}, {}));
  ASSERT_TRUE(scene.physics.remove(*id));
  EXPECT_FALSE(scene.physics.state(*id));
  EXPECT_FALSE(scene.physics.remove(*id));
}

}  // namespace
}  // namespace psygen::physics
