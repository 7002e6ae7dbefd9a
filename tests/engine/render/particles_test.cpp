// Particles: their bounds and ranges, and what is drawn of them on every path.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/render/types.hpp"
#include "tests/engine/render/on_a_path.hpp"

namespace psygen::render {
namespace {

TEST(ParticleKinds, WithNumbersOutsideOfTheirRangesAreRefused) {
  EXPECT_TRUE(is_valid(ParticleKind{}));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  int number = 0;
  for (float ParticleKind::*part : {&ParticleKind::rate,
                                    &ParticleKind::lifetime_s,
                                    &ParticleKind::lifetime_variation,
                                    &ParticleKind::spread,
                                    &ParticleKind::gravity,
                                    &ParticleKind::drag,
                                    &ParticleKind::turbulence_m,
                                    &ParticleKind::first_size_m,
                                    &ParticleKind::last_size_m,
                                    &ParticleKind::size_variation,
                                    &ParticleKind::brightness_variation,
                                    &ParticleKind::fade_in,
                                    &ParticleKind::fade_out,
                                    &ParticleKind::glow,
                                    &ParticleKind::cover,
                                    &ParticleKind::softness,
                                    &ParticleKind::aspect,
                                    &ParticleKind::streak_s,
                                    &ParticleKind::spin,
                                    &ParticleKind::tumbling}) {
    for (const float bad : {nan, inf, -inf, -1e6F, 1e30F}) {
      ParticleKind kind;
      kind.*part = bad;
      EXPECT_FALSE(is_valid(kind)) << "number " << number << " as " << bad;
    }
    ++number;
  }
  for (glm::vec3 ParticleKind::*part :
       {&ParticleKind::half_extent_m, &ParticleKind::velocity, &ParticleKind::wind}) {
    ParticleKind kind;
    kind.*part = {0, nan, 0};
    EXPECT_FALSE(is_valid(kind));
  }
  ParticleKind kind;
  kind.last_colour.y = -1;
  EXPECT_FALSE(is_valid(kind));
  kind = {};
  kind.volume = ParticleVolume::kAroundCamera;
  EXPECT_FALSE(is_valid(kind)) << "a box around the camera without a size";
}

TEST(ParticleKinds, HaveBoundedNumbersOfParticles) {
  EXPECT_EQ(particle_count({.rate = 20, .lifetime_s = 3}), 60u);
  EXPECT_EQ(particle_count({.rate = 0.01F, .lifetime_s = 3}), 1u);
  EXPECT_EQ(particle_count({.rate = 1e9F, .lifetime_s = 1000}), kMaxParticlesPerEmitter);
}

TEST(ParticleKinds, ReachAsFarAsTheFastestParticle) {
  ParticleKind kind;
  kind.velocity = {0, 2, 0};
  kind.spread = 0;
  kind.lifetime_s = 5;
  EXPECT_GE(reach_m(kind, 1, 0), 2 * 5 * 0.97F);
  EXPECT_LT(reach_m(kind, 1, 0), 12);
  kind.gravity = 9.8F;
  EXPECT_GE(reach_m(kind, 1, 0), 9.8F * 12.5F * 0.97F - 10);
  kind.drag = 2;
  EXPECT_LT(reach_m(kind, 1, 0), 30);
}

class Particles : public OnAPath {
 protected:
  void SetUp() override {
    OnAPath::SetUp();
    input_ = synthetic::look(60, 0, kSize);
    input_.light.cloud_cover = 0;
    emitter_.kind.half_extent_m = {2, 2, 0.5F};
    emitter_.kind.first_colour = emitter_.kind.last_colour = {0.02F, 0.02F, 0.02F, 1};
    emitter_.kind.fade_in = emitter_.kind.fade_out = 0;
    emitter_.kind.first_size_m = emitter_.kind.last_size_m = 0.8F;
    emitter_.kind.velocity = {0, 0, 0};
    emitter_.origin = {0, 0, -12};
    emitter_.count = 200;
    emitter_.cycle_s = 3;
    emitter_.cycle = 0.3F;
    emitter_.seed = 17;
    emitter_.next_seed = 18;
  }
  Picture with(std::span<const ParticleDraw> emitters) {
    FrameInput input = input_;
    input.particles = emitters;
    return draw(input);
  }
  Picture with_one() { return with({&emitter_, 1}); }
  static int at(const Picture& p, std::uint32_t x, std::uint32_t y) {
    return p.rgba[4 * (y * p.width + x) + 2];
  }
  static int changed(const Picture& a, const Picture& b) {
    int pixels = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4)
      pixels += std::abs(int{a.rgba[i + 2]} - int{b.rgba[i + 2]}) > 3 ? 1 : 0;
    return pixels;
  }

  ParticleDraw emitter_;
  FrameInput input_;
};

TEST_P(Particles, AreTheSameEveryTimeAndOthersWithAnotherSeed) {
  const Picture first = with_one();
  EXPECT_GT(changed(first, with({})), 1000);
  EXPECT_EQ(with_one().rgba, first.rgba);
  emitter_.seed = emitter_.next_seed = 5;
  EXPECT_GT(changed(with_one(), first), 100);
}

TEST_P(Particles, LieWhereTheirBoxIsAndNowhereElse) {
  const Picture without = with({}), some = with_one();
  EXPECT_LT(at(some, 80, 60), at(without, 80, 60) - 30) << "they are dark";
  for (const std::uint32_t x : {8U, 152U})
    EXPECT_EQ(at(some, x, 60), at(without, x, 60));
  emitter_.origin.z = 12;
  EXPECT_EQ(with_one().rgba, without.rgba) << "behind the camera";
}

TEST_P(Particles, ThatCoverNothingOnlyAddLight) {
  emitter_.kind.cover = 0;
  emitter_.kind.glow = 1;
  emitter_.kind.first_colour = emitter_.kind.last_colour = {0.5F, 0.3F, 0.1F, 0.5F};
  const Picture without = with({}), fire = with_one();
  int darker = 0;
  for (std::size_t i = 0; i < fire.rgba.size(); ++i)
    darker += fire.rgba[i] + 1 < without.rgba[i] ? 1 : 0;
  EXPECT_EQ(darker, 0);
  EXPECT_GT(changed(fire, without), 1000);
}

TEST_P(Particles, AreHiddenByMeshesInFront) {
  const auto box = synthetic::make_box(renderer_->geometry(), glm::vec3(0.3F));
  ASSERT_TRUE(box);
  MeshDraw wall;
  wall.range = *box;
  wall.origin = {0, 0, -8};
  wall.box_half_extent = {9, 9, 0.5F};
  input_.models = {&wall, 1};
  EXPECT_EQ(with_one().rgba, with({}).rgba);
}

TEST_P(Particles, ThatAreTooYoungOrTooOldAreNotThere) {
  const Picture without = with({});
  emitter_.youngest_s = 4;
  EXPECT_EQ(with_one().rgba, without.rgba);
  emitter_.youngest_s = 0;
  emitter_.oldest_s = 0;
  EXPECT_LT(changed(with_one(), without), 60) << "at most the one born now";
}

TEST_P(Particles, AroundTheCameraFillThePictureAndStayInTheWorld) {
  emitter_.kind.volume = ParticleVolume::kAroundCamera;
  emitter_.kind.half_extent_m = {8, 8, 8};
  emitter_.count = 3000;
  emitter_.origin = {8, 8, 8};
  const Picture here = with_one(), without = with({});
  const auto part = [&](std::uint32_t x0, std::uint32_t y0) {
    int pixels = 0;
    for (std::uint32_t y = y0; y < y0 + 60; ++y) {
      for (std::uint32_t x = x0; x < x0 + 80; ++x)
        pixels += at(here, x, y) != at(without, x, y) ? 1 : 0;
    }
    return pixels;
  };
  for (const std::uint32_t x : {0U, 80U}) {
    for (const std::uint32_t y : {0U, 60U})
      EXPECT_GT(part(x, y), 400);
  }
  emitter_.origin = {24, 8, 8};  // a whole box further
  EXPECT_LT(changed(with_one(), here), 20);
}

TEST_P(Particles, ShowTheTextureOfTheirMaterial) {
  const std::vector<std::uint8_t> clear(4 * 4 * 4, 0);
  const auto texture = renderer_->add_texture({4, 4, clear, true});
  ASSERT_TRUE(texture);
  const auto material = renderer_->add_material({.base_texture = *texture});
  ASSERT_TRUE(material);
  emitter_.kind.material = *material;
  EXPECT_EQ(with_one().rgba, with({}).rgba) << "nothing is left of a clear texture";
}

TEST_P(Particles, OfManyEmittersAreBoundedAndSurviveViewsAndPresets) {
  std::vector<ParticleDraw> many(kMaxEmitters + 50, emitter_);
  for (ParticleDraw& one : many)
    one.count = 3;
  EXPECT_GT(changed(with(many), with({})), 100);
  for (View view : {View::kLevels, View::kWireframe, View::kBounds}) {
    input_.view = view;
    with_one();
  }
  input_.view = View::kNormal;
  ASSERT_TRUE(renderer_->set_preset(next_preset(renderer_->preset())));
  EXPECT_GT(changed(with_one(), with({})), 1000);
}

INSTANTIATE_TEST_SUITE_P(OnEveryPath, Particles,
                         testing::ValuesIn(std::vector<How>{
                             {RenderPath::kCpu, Submission::kPushed, Preset::kLow},
                             {RenderPath::kGpu, Submission::kMultiDraw, Preset::kLow},
                             {RenderPath::kGpu, Submission::kMultiDraw, Preset::kHigh}}));

}  // namespace
}  // namespace psygen::render
