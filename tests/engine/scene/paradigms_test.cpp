// The three paradigms of the paper, and models that fail.
#include <atomic>
#include <stdexcept>
#include <thread>

#include "tests/engine/scene/fixture.hpp"
#include "tests/engine/scene/forwarding_type.hpp"

namespace psygen::scene {
namespace {

TEST(Paradigms, AmplifyingReportsTheBudgetThatItNeeds) {
  SceneSettings settings = small_settings();
  settings.paradigm = Paradigm::kDataAmplification;
  settings.budget_bytes = 8ull << 20;
  const auto scene = make_scene(settings);
  const auto result = scene->amplify(pose_at(256, 256));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, core::ErrorCode::kOverBudget);
  EXPECT_NE(result.error().message.find("more than the budget of 8 MiB"), std::string::npos)
      << result.error().message;
}

TEST(Paradigms, AnAmplifiedRegionNeedsNoSynthesisAfterwards) {
  SceneSettings settings = small_settings();
  settings.paradigm = Paradigm::kDataAmplification;
  settings.view_distance_m = 64;
  settings.budget_bytes = 512ull << 20;
  settings.streaming_budget_ms = 0;  // all nodes must exist, whatever time a tick has
  const auto scene = make_scene(settings);
  const auto meshes = scene->amplify(pose_at(256, 256));
  ASSERT_TRUE(meshes) << meshes.error().message;
  EXPECT_TRUE(state_of(*scene).streaming.missing.empty());
  EXPECT_GT(*meshes, 1000u);
  for (int i = 0; i < 4; ++i) {
    tick_at(*scene, pose_at(256, 256, 1.6 * i));
    tick_at(*scene, pose_at(256, 256, 1.6 * i));
    EXPECT_EQ(scene->statistics().meshes.completed, 0u);
    EXPECT_EQ(scene->statistics().drawn.holes, 0u);
    EXPECT_EQ(scene->statistics().drawn.coarse, 0u);
  }
  expect_within_budget(*scene);
}

TEST(Paradigms, LazyEvaluationDrawsEverythingAndKeepsNothing) {
  SceneSettings settings = small_settings();
  settings.paradigm = Paradigm::kLazyEvaluation;
  settings.upload_budget_bytes = 1000;  // lazy evaluation ignores budgets per tick
  settings.streaming_budget_ms = 0;
  const auto scene = make_scene(settings);
  tick_at(*scene, pose_at(256, 256));
  const std::uint32_t first = scene->statistics().meshes.models_synthesised;
  EXPECT_GT(first, 50u);
  EXPECT_EQ(scene->statistics().drawn.holes, 0u);
  tick_at(*scene, pose_at(256, 256));  // the heights of the ground are known after it
  const std::uint32_t second = scene->statistics().meshes.models_synthesised;
  EXPECT_GT(second, 50u);
  EXPECT_LE(second, first);
  tick_at(*scene, pose_at(256, 256));
  EXPECT_EQ(scene->statistics().meshes.models_synthesised, second);
  tick_at(*scene, pose_at(256, 256, 3.14));
  const synthesis::CacheStats stats = state_of(*scene).supply.stats();
  EXPECT_EQ(stats.ready, scene->statistics().meshes.models_synthesised);
}

// Although each frame would fit, and no frame is in flight here.
// Frames that wait for everything request nothing early: it would never be drawn.
TEST(Paradigms, LazyEvaluationDrawsModelsAtTheMinimumSize) {
  SceneSettings settings = small_settings();
  settings.min_size_pixels = 12;
  const auto usual = make_scene(settings);
  for (int i = 0; i < 60; ++i)
    tick_at(*usual, pose_at(256, 256));
  settings.paradigm = Paradigm::kLazyEvaluation;
  const auto lazy = make_scene(settings);
  for (int i = 0; i < 3; ++i)
    tick_at(*lazy, pose_at(256, 256));
  EXPECT_GT(state_of(*lazy).draws.models.size(), 20U);
  EXPECT_EQ(state_of(*lazy).draws.models.size(), state_of(*usual).draws.models.size());
}

TEST(Paradigms, LazyEvaluationReservesMemoryForTwoFramesInFlight) {
  SceneSettings settings = small_settings();
  settings.paradigm = Paradigm::kLazyEvaluation;
  settings.view_distance_m = 600;
  settings.max_error_pixels = 1;
  const auto visible = [](const Scene& scene) {
    return state_of(scene).supply.stats().visible_bytes;
  };
  const auto ample = make_scene(settings);
  for (int i = 0; i < 3; ++i)
    tick_at(*ample, pose_at(256, 256));
  EXPECT_EQ(state_of(*ample).quality.coarsening, 1.0F);
  settings.budget_bytes = visible(*ample) * 2;
  const auto scene = make_scene(settings);
  for (int i = 0; i < 25; ++i)
    tick_at(*scene, pose_at(256, 256));
  EXPECT_GT(state_of(*scene).quality.coarsening, 1.0F);
  EXPECT_LE(3 * visible(*scene), settings.budget_bytes);
  EXPECT_GT(8 * visible(*scene), settings.budget_bytes) << "but no coarser than that";
  EXPECT_EQ(scene->statistics().drawn.holes, 0u);
}

TEST(Paradigms, FullDetailEverywhereDrawsLevelZeroOnly) {
  SceneSettings settings = small_settings();
  settings.levels_of_detail = false;
  settings.view_distance_m = 64;
  settings.budget_bytes = 256ull << 20;
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  tick_at(*scene, pose_at(256, 256));
  EXPECT_EQ(scene->statistics().drawn.holes, 0u);
  std::size_t other_levels = 0, drawn = 0;
  std::as_const(state_of(*scene).entities)
      .each<const MeshDemand>(
          [&](std::span<const ecs::Entity>, std::span<const MeshDemand> demands) {
            for (const MeshDemand& demand : demands) {
              drawn += demand.drawn_level == 0;
              other_levels += demand.drawn_level != 0 && demand.drawn_level != kNoLevel;
            }
          });
  EXPECT_GT(drawn, 50u);
  EXPECT_EQ(other_levels, 0u);
}

// The standard rock with another synthesis.
class TestRock : public ForwardingType {
 public:
  explicit TestRock(const models::ModelType& rock) : ForwardingType("test_rock", rock) {}
};

// A model type whose synthesis always throws.
class FailingRock final : public TestRock {
 public:
  using TestRock::TestRock;
  core::Bounds synthesise(const models::Parameters&, int, const models::MeshView&) const override {
    throw std::runtime_error("out of stone");
  }
};

// The first synthesis in a modeler does not end before `release` is set.
class HangingRock final : public TestRock {
 public:
  HangingRock(const models::ModelType& rock, const std::atomic<bool>& release)
      : TestRock(rock), release_(release) {}
  core::Bounds synthesise(const models::Parameters& p, int level,
                          const models::MeshView& out) const override {
    if (std::this_thread::get_id() != main_thread_ && !hung_.exchange(true)) release_.wait(false);
    return of().synthesise(p, level, out);
  }

 private:
  const std::atomic<bool>& release_;
  const std::thread::id main_thread_ = std::this_thread::get_id();
  mutable std::atomic<bool> hung_{false};
};

// The paper's world with `rock` in place of its rocks.
std::unique_ptr<Scene> scene_with(
    std::unique_ptr<models::ModelType> (*make)(const models::ModelType&, const std::atomic<bool>&),
    const std::atomic<bool>& release, const SceneSettings& settings) {
  models::Registry registry = models::make_standard_registry();
  const auto& standard = registry[static_cast<models::ModelIndex>(registry.find("rock"))];
  const auto added = registry.add(make(standard, release));
  EXPECT_TRUE(added);
  world::World world = paper_world(registry);
  for (world::Scatter& scatter : world.scatter) {
    if (registry[scatter.model].name() == "rock") scatter.model = *added;
  }
  auto scene = Scene::create(world, std::move(registry), settings, nullptr);
  EXPECT_TRUE(scene) << scene.error().message;
  return std::move(*scene);
}

TEST(Paradigms, AFailingModelIsAHoleAndOthersAreDrawn) {
  const std::atomic<bool> unused{true};
  const auto scene = scene_with(
      [](const models::ModelType& rock, const std::atomic<bool>&) {
        return std::unique_ptr<models::ModelType>(std::make_unique<FailingRock>(rock));
      },
      unused, small_settings());
  scene->settle(pose_at(256, 256));
  const std::uint64_t failures = scene->statistics().failed_in_all;
  EXPECT_GT(failures, 0u);
  tick_at(*scene, pose_at(256, 256));
  EXPECT_GT(scene->statistics().drawn.holes, 0u);        // the rocks
  EXPECT_GT(state_of(*scene).draws.models.size(), 10u);  // the trees
  EXPECT_GT(state_of(*scene).draws.terrain.size(), 1u);
  EXPECT_EQ(scene->statistics().meshes.requests, 0u);  // no request is repeated forever
  for (int i = 0; i < 20; ++i) {
    tick_at(*scene, pose_at(256, 256));
  }
  EXPECT_EQ(scene->statistics().failed_in_all, failures);
}

TEST(Paradigms, AHangingModelIsReplacedByAnotherLevel) {
  std::atomic<bool> release{false};
  SceneSettings settings = small_settings();
  settings.watchdog_seconds = 0.5;
  auto scene = scene_with(
      [](const models::ModelType& rock, const std::atomic<bool>& gate) {
        return std::unique_ptr<models::ModelType>(std::make_unique<HangingRock>(rock, gate));
      },
      release, settings);
  scene->settle(pose_at(256, 256));
  EXPECT_EQ(state_of(*scene).supply.hung().size(), 1u);
  EXPECT_EQ(scene->statistics().failed_in_all, 1u);
  tick_at(*scene, pose_at(256, 256));
  EXPECT_EQ(scene->statistics().drawn.holes, 0u);
  release = true;
  release.notify_all();
  while (!state_of(*scene).supply.hung().empty()) {
    tick_at(*scene, pose_at(256, 256));  // collects the modeler's late mesh
  }
  EXPECT_EQ(scene->statistics().failed_in_all, 1u);
}

}  // namespace
}  // namespace psygen::scene
