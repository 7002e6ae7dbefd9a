// Characters of physics::World: walking, slopes, steps, jumps.
#include "engine/physics/character.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/world/edits/edits.hpp"
#include "tests/engine/physics/scene.hpp"

namespace psygen::physics {
namespace {

using testing::ball;
using testing::box;
using testing::kBounded;
using testing::Loaded;
using testing::Scene;

// A wide floor in the air, so that slopes and models do not matter.
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

TEST(Character, RisesAndSinksAsSetInsteadOfFalling) {
  Floor f;
  ASSERT_TRUE(f.scene.physics.tell(f.character, {.rise = 2}));
  f.scene.steps(60);
  EXPECT_NEAR(f.state().velocity.y, 2, 1e-9);
  EXPECT_NEAR(f.at().y, 2, 0.1);
  ASSERT_TRUE(f.scene.physics.tell(f.character, {.direction = {1, 0}, .speed = 9, .rise = -0.5}));
  f.scene.steps(120);
  EXPECT_NEAR(f.state().velocity.x, 9, 1e-9);
  EXPECT_NEAR(f.state().velocity.y, -0.5, 1e-9);
  ASSERT_TRUE(f.scene.physics.tell(f.character, {.rise = -3}));
  f.scene.steps(120);
  EXPECT_TRUE(f.state().on_ground);  // the floor stops it
  ASSERT_TRUE(f.scene.physics.tell(f.character, {}));
  f.scene.steps(1);
  EXPECT_TRUE(f.state().on_ground);
}

TEST(Character, RejectsInvalidSpeeds) {
  Floor f;
  for (const double speed : {-1.0, 1e4, testing::kNan})
    EXPECT_FALSE(f.scene.physics.tell(f.character, {.speed = speed})) << speed;
  for (const double rise : {-1e4, 1e4, testing::kNan})
    EXPECT_FALSE(f.scene.physics.tell(f.character, {.rise = rise})) << rise;
}

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

TEST(Character, ClimbsStepsNoFasterThanItWalks) {
  for (const double height : {0.1, 0.2, 0.35}) {
    for (const bool run : {false, true}) {
      Floor f;
      const auto half = static_cast<float>(0.5 * height);
      f.add_box({4, half, 3}, {6, 0.5 * height, 0}, Motion::kKinematic);
      f.scene.steps(2);
      const double way_m = (run ? 5 : 1.6) * testing::kStep;
      double fastest = 0;
      glm::dvec3 before = f.at();
      for (int i = 0; i < (run ? 60 : 150); ++i) {
        f.walk({1, 0}, 1, run);
        const glm::dvec3 now = f.at();
        fastest = std::max(fastest, now.x - before.x);
        ASSERT_GE(now.x, before.x - 1e-6) << height << " " << i;
        before = now;
      }
      EXPECT_LE(fastest, way_m + 0.02) << height;
      EXPECT_GT(before.x, 2.2) << height;
      EXPECT_NEAR(before.y, height, 0.05) << "it is on the step";
      EXPECT_TRUE(f.state().on_ground);
    }
  }
}

// The sides of a notch are too steep to stand on, but together they hold a character.
TEST(Character, JumpsFromTheBottomOfANotch) {
  for (const double depth_m : {2.5, 4.0}) {
    Scene scene = Scene::shipped("paper");
    const core::WorldPosition bottom = scene.above({256, 256}, 30, 30, 0);
    world::Edits edits;
    ASSERT_TRUE(edits.raise(scene.loaded.world, bottom, 1.01, -depth_m));  // one vertex
    world::set_edits(scene.loaded.world, edits.layer());
    const auto id =
        scene.physics.add(CharacterSettings{.feet = scene.above(bottom.block, 30.06, 30.02, 0.2)});
    ASSERT_TRUE(id);
    const auto state = [&] { return *scene.physics.state(*id); };
    scene.steps(120);
    const auto ground = scene.query.ground(state().feet);
    ASSERT_TRUE(ground);
    ASSERT_LT(ground->normal.y, 0.6F) << "too steep to stand on";
    EXPECT_TRUE(state().on_ground);
    const double rest_m = state().feet.local.y;
    ASSERT_TRUE(scene.physics.tell(*id, {.jump = true}));
    double highest_m = rest_m;
    for (int i = 0; i < 40; ++i) {
      scene.steps(1);
      highest_m = std::max(highest_m, state().feet.local.y);
    }
    EXPECT_GT(highest_m, rest_m + 0.5);
    scene.steps(60);
    EXPECT_TRUE(state().on_ground) << "it is back, and stands again";
  }
}

TEST(Character, SlidesDownEvenGroundThatIsTooSteepForIt) {
  Scene scene = Scene::shipped("paper");
  std::size_t found = 0;
  for (int i = 0; i < 63 * 63 && found < 20; ++i) {
    const core::WorldPosition at = scene.above({256, 256}, i % 63 + 0.4, i / 63 + 0.3, 0);
    const auto up_of = [&](double x, double z) {
      core::WorldPosition beside = at;
      beside.local += glm::dvec3(x, 0, z);
      return double{scene.query.ground(beside)->normal.y};
    };
    const double up = up_of(0, 0), slope_deg = std::acos(up) * 180 / 3.14159265;
    bool even = slope_deg > 15;
    for (const double m : {-0.35, 0.35})
      even = even && std::abs(up_of(m, 0) - up) < 0.01 && std::abs(up_of(0, m) - up) < 0.01;
    if (!even) continue;
    ++found;
    const auto id =
        scene.physics.add(CharacterSettings{.feet = at, .max_slope_deg = slope_deg - 2});
    ASSERT_TRUE(id);
    scene.steps(1);
    EXPECT_FALSE(scene.physics.state(*id)->on_ground) << slope_deg;
    ASSERT_TRUE(scene.physics.remove(*id));
  }
  EXPECT_EQ(found, 20U);
}

TEST(Character, IsNeverBelowGroundThatWasJustRaised) {
  Scene scene(Loaded::shipped("five_species"));
  const core::WorldPosition place = scene.above({3, 4}, 20, 20, 0);
  const auto before = scene.physics.add(CharacterSettings{.feet = place});
  ASSERT_TRUE(before);
  scene.steps(1);
  world::Edits edits;
  ASSERT_TRUE(edits.raise(scene.loaded.world, place, 10, 4));
  world::set_edits(scene.loaded.world, edits.layer());
  const double height_m = scene.ground_m(place);
  ASSERT_GT(height_m, place.local.y + 3);
  ASSERT_TRUE(scene.physics.set_feet(*before, place));
  EXPECT_GE(scene.physics.state(*before)->feet.local.y, height_m - 1e-6);
  const auto fresh = scene.physics.add(CharacterSettings{.feet = place});
  ASSERT_TRUE(fresh);
  EXPECT_GE(scene.physics.state(*fresh)->feet.local.y, height_m - 1e-6);
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
        const auto under = scene.query.ground(s.feet);
        // Skips steep ground and models.
        if (under->normal.y < 0.65F || s.feet.local.y > under->height_m + 1e-3) continue;
        ASSERT_TRUE(s.on_ground) << name << " " << i << " " << k;
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

TEST(Character, RejectsIllegalValues) {
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
  EXPECT_TRUE(refused([](CharacterSettings& s) { s.max_slope_deg = 90; }));
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
