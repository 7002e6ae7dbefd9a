// Point lights of a game on the null device: their choice and their fades.
#include <gtest/gtest.h>

#include <limits>

#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class Lights : public testing::Test {
 protected:
  void SetUp() override {
    scene_ = make_scene_of(small_settings(), [](world::World& world) { world.scatter.clear(); });
    scene_->settle(pose_);
  }
  State& state() { return state_of(*scene_); }
  const std::vector<render::PointLight>& lit() { return state().light_draws.lights; }
  Statistics counters() { return scene_->statistics(); }
  void tick(int count = 1) {
    for (int i = 0; i < count; ++i)
      tick_at(*scene_, pose_);
  }
  // `ahead_m` of the camera, which is high above the ground, and `aside_m`.
  ecs::Entity put(double ahead_m, double aside_m = 0, const PointLight& light = {}) {
    Transform transform;
    transform.position = pose_.position;
    transform.position.local += glm::dvec3(aside_m, -0.2 * ahead_m, -ahead_m);
    return spawn_light(state().entities, light, transform);
  }
  PointLight& light(ecs::Entity entity) { return *state().entities.get<PointLight>(entity); }

  core::CameraPose pose_ = pose_at(0, 0);
  std::unique_ptr<Scene> scene_;
};

TEST_F(Lights, AreAtTheirTransformWithTheirLight) {
  const ecs::Entity entity = put(20, 1, {.colour = {1, 0.5F, 0.25F}, .intensity = 4, .range_m = 9});
  tick(20);
  ASSERT_EQ(lit().size(), 1u);
  EXPECT_NEAR(lit()[0].position.z, -20, 1e-3);
  EXPECT_NEAR(lit()[0].position.x, 1, 1e-3);
  EXPECT_EQ(lit()[0].range_m, 9);
  EXPECT_EQ(lit()[0].light, glm::vec3(4, 2, 1));
  EXPECT_EQ(counters().lights.lit, 1u);
  state().entities.destroy(std::span(&entity, 1));
  tick();
  EXPECT_TRUE(lit().empty());
}

TEST_F(Lights, FadeInWhenTheyAppearAndOutWhenTheyAreSwitchedOff) {
  tick(2);
  const ecs::Entity entity = put(20);
  float before = 0;
  for (int i = 0; i < 20; ++i) {
    tick();
    ASSERT_EQ(lit().size(), 1u);
    EXPECT_GE(lit()[0].light.x, before);
    if (i == 0) {
      EXPECT_LT(lit()[0].light.x, 0.5F);
    }
    before = lit()[0].light.x;
  }
  EXPECT_EQ(before, 2.0F);
  light(entity).visible = false;
  tick();
  ASSERT_EQ(lit().size(), 1u);
  EXPECT_LT(lit()[0].light.x, 2.0F);
  tick(20);
  EXPECT_TRUE(lit().empty());
}

TEST_F(Lights, EnteringFromTheSideAppearAtOnce) {
  put(20, 0, {.range_m = 5});
  tick(20);
  pose_.yaw = 3;
  tick(5);
  EXPECT_TRUE(lit().empty());
  pose_.yaw = 0;
  tick();
  ASSERT_EQ(lit().size(), 1u);
  EXPECT_EQ(lit()[0].light.x, 2.0F);
}

TEST_F(Lights, OutOfViewLightTheirRangeInView) {
  put(10, 14, {.range_m = 1});
  tick(20);
  EXPECT_TRUE(lit().empty());
  put(10, 14, {.range_m = 14});
  tick(20);
  EXPECT_EQ(lit().size(), 1u);
}

TEST_F(Lights, BeyondThirtyTwoTheLeastImportantStayDark) {
  for (int i = 0; i < 100; ++i)
    put(10 + i);
  tick(20);
  ASSERT_EQ(lit().size(), 32u);
  EXPECT_EQ(counters().lights.left_out, 68u);
  for (const render::PointLight& one : lit())
    EXPECT_GT(one.position.z, -42.5F);
}

TEST_F(Lights, ReplaceEachOtherWithoutAJumpOfLight) {
  for (int i = 0; i < 100; ++i)
    put(5 + i, 0, {.intensity = 1, .range_m = 6});
  tick(20);
  const auto sum = [&] {
    float all = 0;
    for (const render::PointLight& one : lit())
      all += one.light.x;
    return all;
  };
  for (int i = 0; i < 60; ++i) {
    const float before = sum();
    pose_.position.local.z -= 0.4;
    pose_.position.local.y -= 0.08;
    tick();
    EXPECT_LE(lit().size(), render::kMaxPointLights);
    EXPECT_NEAR(sum(), before, 1.01F)
        << "no light comes or goes within a frame, but leaves the view";
  }
}

TEST_F(Lights, WithInvalidValuesStayDarkAndAreCounted) {
  const std::array bad{PointLight{.colour = {kNan, 0, 0}}, PointLight{.colour = {0, -1, 0}},
                       PointLight{.intensity = kNan},      PointLight{.intensity = -1},
                       PointLight{.intensity = 1e30F},     PointLight{.range_m = 0},
                       PointLight{.range_m = kNan},        PointLight{.range_m = -5},
                       PointLight{.range_m = 1e9F}};
  for (const PointLight& one : bad)
    put(20, 0, one);
  const ecs::Entity lost = put(20);
  state().entities.get<Transform>(lost)->position.local.y = static_cast<double>(kNan);
  put(20);
  tick(20);
  EXPECT_EQ(lit().size(), 1u);
  EXPECT_EQ(counters().lights.invalid, bad.size() + 1);
}

TEST_F(Lights, ByTheHundredThousandAreBounded) {
  const auto made = state().entities.create<Transform, PointLight>(100000);
  for (Transform& transform : made.column<Transform>()) {
    transform.position = pose_.position;
    transform.position.local.z -= 20;
  }
  tick(3);
  EXPECT_EQ(lit().size(), 32u);
  EXPECT_EQ(counters().lights.left_out, 100000u - 32u);
}

}  // namespace
}  // namespace psygen::scene
