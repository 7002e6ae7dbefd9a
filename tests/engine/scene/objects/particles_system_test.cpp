// Emitters of a game on the null device: their choice, and the phases of their cycles.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/scene/objects/particle_kinds.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

class Emitters : public testing::Test {
 protected:
  void SetUp() override {
    scene_ = make_scene_of(small_settings(), [](world::World& world) { world.scatter.clear(); });
    scene_->settle(pose_);
  }
  State& state() { return state_of(*scene_); }
  const std::vector<render::ParticleDraw>& drawn() { return state().particle_draws.emitters; }
  Statistics counters() { return scene_->statistics(); }
  void tick(int count = 1) {
    for (int i = 0; i < count; ++i)
      tick_at(*scene_, pose_);
  }
  ecs::Entity put(double ahead_m, const ParticleEmitter& emitter = {}) {
    Transform transform;
    transform.position = pose_.position;
    transform.position.local += glm::dvec3(0, -0.2 * ahead_m, -ahead_m);
    return spawn_emitter(state().entities, emitter, transform);
  }

  core::CameraPose pose_ = pose_at(0, 0);
  std::unique_ptr<Scene> scene_;
};

TEST_F(Emitters, OfTheEngineHaveValidKinds) {
  for (const render::ParticleKind& kind : {smoke(), fire(), sparks(), leaves(), rain(), snow()}) {
    EXPECT_TRUE(render::is_valid(kind));
    EXPECT_LT(kind.rate * kind.lifetime_s, 4000);
  }
}

TEST_F(Emitters, AreDrawnBackToFrontAtTheirPlaces) {
  put(20);
  put(60);
  put(40);
  tick();
  ASSERT_EQ(drawn().size(), 3u);
  EXPECT_NEAR(drawn()[0].origin.z, -60, 1e-3);
  EXPECT_NEAR(drawn()[1].origin.z, -40, 1e-3);
  EXPECT_NEAR(drawn()[2].origin.z, -20, 1e-3);
  EXPECT_EQ(counters().particles.emitters_drawn, 3u);
  EXPECT_EQ(counters().particles.particles_drawn, 180u);
}

TEST_F(Emitters, AreCulledOutsideTheFrustum) {
  put(-30);
  tick();
  EXPECT_TRUE(drawn().empty());
  put(30);
  tick();
  EXPECT_EQ(drawn().size(), 1u);
  pose_.yaw = 3;
  tick();
  EXPECT_EQ(drawn().size(), 1u) << "the one behind";
}

TEST_F(Emitters, FollowOnlyTheClock) {
  put(20, {.kind = {.rate = 20, .lifetime_s = 3}, .seed = 7});
  state().clock.now_s = 10;
  tick();
  ASSERT_EQ(drawn().size(), 1u);
  const render::ParticleDraw then = drawn()[0];
  EXPECT_EQ(then.count, 60u);
  EXPECT_FLOAT_EQ(then.cycle_s, 3);
  EXPECT_NEAR(then.cycle, 1.0F / 3, 1e-5F);
  tick(50);
  state().clock.now_s = 10;
  tick();
  EXPECT_EQ(drawn()[0].cycle, then.cycle);
  EXPECT_EQ(drawn()[0].seed, then.seed);
  state().clock.now_s = 13;
  tick();
  EXPECT_NEAR(drawn()[0].cycle, then.cycle, 1e-5F);
  EXPECT_EQ(drawn()[0].seed, then.next_seed) << "the next generation";
}

TEST_F(Emitters, StartAndStop) {
  const ecs::Entity entity = put(20, {.kind = {.rate = 20, .lifetime_s = 3}});
  ParticleEmitter& emitter = *state().entities.get<ParticleEmitter>(entity);
  state().clock.now_s = 10;
  emitter.start_s = 11;
  tick();
  EXPECT_TRUE(drawn().empty());
  emitter.start_s = 8;
  emitter.stop_s = 9;
  state().clock.now_s = 10;
  tick();
  ASSERT_EQ(drawn().size(), 1u);
  EXPECT_FLOAT_EQ(drawn()[0].oldest_s, 2);
  EXPECT_FLOAT_EQ(drawn()[0].youngest_s, 1);
  state().clock.now_s = 12.5;
  tick();
  EXPECT_TRUE(drawn().empty()) << "all of them have died";
}

TEST_F(Emitters, AroundTheCameraAreDrawnFromAnyPlace) {
  Transform nowhere;
  spawn_emitter(state().entities, {.kind = rain()}, nowhere);
  tick();
  ASSERT_EQ(drawn().size(), 1u);
  const glm::vec3 before = drawn()[0].origin;
  pose_.position.local.x += 0.5;
  tick();
  EXPECT_NEAR(drawn()[0].origin.x, before.x - 0.5F, 1e-3) << "the rain stays in the world";
  pose_.position.local.x += 28;  // a whole box
  tick();
  EXPECT_NEAR(drawn()[0].origin.x, before.x - 0.5F, 1e-3);
}

TEST_F(Emitters, WithInvalidValuesAreCountedAndNotDrawn) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  put(20, {.kind = {.rate = -1}});
  put(20, {.kind = {.lifetime_s = nan}});
  put(20, {.kind = {.first_size_m = 1e9F}});
  put(20, {.kind = {}, .start_s = static_cast<double>(nan)});
  const ecs::Entity lost = put(20), flat = put(20);
  state().entities.get<Transform>(lost)->position.local.x = static_cast<double>(nan);
  state().entities.get<Transform>(flat)->scale.y = 0;
  tick();
  EXPECT_TRUE(drawn().empty());
  EXPECT_EQ(counters().particles.emitters_invalid, 6u);
}

TEST_F(Emitters, OfAbsurdRatesAndNumbersAreBounded) {
  put(20, {.kind = {.rate = 1e9F, .lifetime_s = 1000}});
  tick();
  ASSERT_EQ(drawn().size(), 1u);
  EXPECT_EQ(drawn()[0].count, render::kMaxParticlesPerEmitter);
  EXPECT_GT(counters().particles.particles_left_out, std::uint64_t{1} << 39);
  const auto made = state().entities.create<Transform, ParticleEmitter>(100000);
  for (Transform& transform : made.column<Transform>()) {
    transform.position = pose_.position;
    transform.position.local.z -= 30;
  }
  tick(2);
  EXPECT_EQ(drawn().size(), render::kMaxEmitters);
  EXPECT_LE(counters().particles.particles_drawn, render::kMaxParticles);
  EXPECT_EQ(counters().particles.emitters_left_out, 100001u - render::kMaxEmitters);
}

TEST_F(Emitters, FadeOutTowardsTheViewDistance) {
  const double end_m = state().settings.view_distance_m;
  put(0.92 * end_m);
  tick();
  ASSERT_EQ(drawn().size(), 1u);
  EXPECT_GT(drawn()[0].opacity, 0.1F);
  EXPECT_LT(drawn()[0].opacity, 0.7F);
}

}  // namespace
}  // namespace psygen::scene
