// Effects of frame time and of memory on the allowed error.
#include <cmath>
#include <numeric>

#include "engine/core/geometry_memory.hpp"
#include "engine/scene/state.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

constexpr double kError = 2, kFactor = 3, kTarget_ms = 16;

std::unique_ptr<Scene> steered_scene() {
  SceneSettings settings = small_settings();
  settings.max_error_pixels = kError;
  settings.max_error_factor = kFactor;
  settings.min_resolution = 1;
  settings.target_frame_ms = kTarget_ms;
  return make_scene(settings);
}

// Ticks after frames of this length. Returns the error of the last tick; in each tick the error
// lies within its bounds and follows `falls`.
double after_frames(Scene& scene, double frame_ms, double triangles, int ticks, bool falls) {
  State& s = state_of(scene);
  double error = falls ? kError * kFactor : 0;
  for (int i = 0; i < ticks; ++i) {
    s.input.frame_ms = frame_ms;
    s.input.frame_triangles = triangles;
    tick_at(scene, pose_at(256, 256));
    const double now = s.quality.error_pixels;
    EXPECT_TRUE(falls ? now <= error : now >= error) << "tick " << i;
    EXPECT_GE(now, kError);
    EXPECT_LE(now, kError * kFactor);
    EXPECT_DOUBLE_EQ(s.quality.model_error_pixels, kError * std::sqrt(now / kError));
    error = now;
  }
  return error;
}

// Indices of the drawn models and ground once everything is ready.
std::size_t drawn_indices(Scene& scene) {
  scene.settle(pose_at(256, 256));
  tick_at(scene, pose_at(256, 256));
  const State& s = state_of(scene);
  std::size_t sum = 0;
  for (const render::MeshDraw& draw : s.draws.models)
    sum += draw.part.count > 0 ? draw.part.count : draw.range.index_count;
  for (const render::TerrainDraw& draw : s.draws.terrain)
    sum += draw.part.count;
  return sum;
}

TEST(QualityOfTime, SlowFramesGetCoarserAndFastOnesFinerWithinBounds) {
  const auto scene = steered_scene();
  EXPECT_EQ(after_frames(*scene, 5, 0, 200, true), kError);
  state_of(*scene).input.frame_ms = 0;  // unknown: settling changes nothing
  const std::size_t fine = drawn_indices(*scene);
  const double soon = after_frames(*scene, 40, 0, 12, false);
  EXPECT_GT(soon, kError * 1.05);
  EXPECT_LT(soon, kError * kFactor);
  EXPECT_EQ(after_frames(*scene, 40, 0, 200, false), kError * kFactor);
  state_of(*scene).input.frame_ms = 0;
  const std::size_t coarse = drawn_indices(*scene);
  EXPECT_LT(static_cast<double>(coarse), 0.8 * static_cast<double>(fine));
  EXPECT_LT(after_frames(*scene, 5, 0, 100, true), kError * kFactor);
  EXPECT_EQ(after_frames(*scene, 5, 0, 500, true), kError);
  state_of(*scene).input.frame_ms = 0;
  EXPECT_EQ(drawn_indices(*scene), fine);
}

// When a wide view opens, the error rises before frames become slow.
TEST(QualityOfTime, TheTrianglesOfFramesCountAsWell) {
  const auto error_behind_a_hilltop = [](bool knows_triangles) {
    const auto scene = steered_scene();
    for (int i = 0; i < 100; ++i) {
      const double triangles = 40'000 + 1000 * (i % 7);
      after_frames(*scene, 5 + triangles * 1.5e-4, knows_triangles ? triangles : 0, 2, true);
    }
    return after_frames(*scene, 5 + 120'000 * 1.5e-4, knows_triangles ? 120'000 : 0, 4, false);
  };
  EXPECT_GT(error_behind_a_hilltop(true), 1.2 * error_behind_a_hilltop(false));
}

TEST(QualityOfTime, ResolutionFallsBeforeDetailAndReturnsAfterIt) {
  SceneSettings settings = small_settings();
  settings.max_error_pixels = kError;
  settings.target_frame_ms = kTarget_ms;
  settings.min_resolution = 0.6;
  const auto scene = make_scene(settings);
  Quality& quality = state_of(*scene).quality;
  EXPECT_EQ(quality.resolution, 0.6) << "at the start, without a device of its own";
  EXPECT_DOUBLE_EQ(quality.error_pixels, kError);
  const auto ticks = [&](double frame_ms, int count) {
    double least = 1;
    for (int i = 0; i < count; ++i) {
      state_of(*scene).input.frame_ms = frame_ms;
      tick_at(*scene, pose_at(256, 256));
      const double r = quality.resolution;
      EXPECT_TRUE(r >= 0.6 && r <= 1) << r;
      EXPECT_NEAR(20 * r, std::round(20 * r), 1e-9) << "in steps of 5 %";
      EXPECT_TRUE(r == 0.6 || quality.error_pixels == kError) << r;
      least = std::min(least, r);
    }
    return least;
  };
  ticks(5, 1000);
  EXPECT_EQ(quality.resolution, 1);
  EXPECT_EQ(ticks(30, 40), quality.resolution) << "it falls";
  EXPECT_LT(quality.resolution, 1);
  EXPECT_EQ(quality.error_pixels, kError);
  ticks(40, 200);
  EXPECT_EQ(quality.resolution, 0.6);
  EXPECT_DOUBLE_EQ(quality.error_pixels, kError * settings.max_error_factor);
}

TEST(QualityOfTime, WithoutATargetTheErrorIsFixed) {
  SceneSettings settings = small_settings();
  settings.max_error_pixels = kError;
  const auto scene = make_scene(settings);
  for (int i = 0; i < 50; ++i) {
    state_of(*scene).input.frame_ms = 1000;
    tick_at(*scene, pose_at(256, 256));
    EXPECT_EQ(state_of(*scene).quality.error_pixels, kError);
  }
}

// The system alone, with an empty cache.
struct MemoryLoop {
  MemoryLoop() { meshes.open(registry, heap, 1 << 20); }
  float after(const MemoryPressure& pressure, Paradigm paradigm = SceneSettings{}.paradigm) {
    settings.paradigm = paradigm;
    const Rules rules = rules_of(settings, false);
    quality_system({settings, rules, clock}, {}, pressure, meshes, quality);
    return quality.coarsening;
  }
  models::Registry registry = models::make_standard_registry();
  core::HeapGeometryMemory heap{1 << 20};
  Clock clock;
  synthesis::MeshSupply meshes;
  SceneSettings settings;
  Quality quality;
};

TEST(QualityOfMemory, GetsCoarserWhileVisibleMeshesFindNoMemoryAndFinerOtherwise) {
  MemoryLoop loop;
  float before = 1;
  for (int i = 0; i < 60; ++i) {
    const float now = loop.after({.refused_visible = 1, .seen_share = 0.9});
    EXPECT_TRUE(now > before || now == 64) << "tick " << i;
    before = now;
    EXPECT_DOUBLE_EQ(loop.quality.error_pixels, loop.settings.max_error_pixels * double{now});
  }
  EXPECT_EQ(before, 64) << "and no coarser";
  EXPECT_EQ(loop.after({.seen_share = 0.6}), before) << "no room to spare";
  for (int i = 0; i < 600; ++i)
    loop.after({.seen_share = 0.4});
  EXPECT_EQ(loop.quality.coarsening, 1);
}

TEST(QualityOfMemory, LazyEvaluationReservesMemoryForThreeFrames) {
  MemoryLoop loop;
  const MemoryPressure third{.seen_share = 0.34}, waiting{.waiting = 1};
  EXPECT_EQ(loop.after(third), 1);
  EXPECT_EQ(loop.after(waiting), 1) << "it comes in the next tick";
  const float coarser = loop.after(third, Paradigm::kLazyEvaluation);
  EXPECT_GT(coarser, 1);
  EXPECT_GT(loop.after(waiting, Paradigm::kLazyEvaluation), coarser);
}

TEST(QualityOfMemory, KnowsSinceWhenFramesHaveAwaitedMeshes) {
  MemoryLoop loop;
  loop.after({.awaited = 2, .at_s = 5});
  EXPECT_EQ(loop.quality.awaiting_since_s, 5);
  loop.after({.awaited = 1, .at_s = 6});
  EXPECT_EQ(loop.quality.awaiting_since_s, 5);
  loop.after({.at_s = 7});
  EXPECT_GT(loop.quality.awaiting_since_s, 1e300);
}

}  // namespace
}  // namespace psygen::scene
