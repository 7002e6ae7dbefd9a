// The three paradigms of the paper, and models that fail.
#include <atomic>
#include <stdexcept>
#include <thread>

#include "tests/engine/scene/fixture.hpp"
#include "tests/engine/scene/forwarding_type.hpp"

namespace psygen::scene {
namespace {

TEST(Paradigms, AmplifyingSaysWhatItNeedsWhenItDoesNotFit) {
  Settings settings = small_settings();
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
  Settings settings = small_settings();
  settings.paradigm = Paradigm::kDataAmplification;
  settings.view_distance_m = 64;
  settings.budget_bytes = 512ull << 20;
  settings.streaming_budget_ms = 0;  // all nodes come, however little time a tick has for them
  const auto scene = make_scene(settings);
  const auto meshes = scene->amplify(pose_at(256, 256));
  ASSERT_TRUE(meshes) << meshes.error().message;
  EXPECT_TRUE(scene->state().streaming.missing.empty());
  EXPECT_GT(*meshes, 1000u);
  for (int i = 0; i < 4; ++i) {
    tick_at(*scene, pose_at(256, 256, 1.6 * i));
    tick_at(*scene, pose_at(256, 256, 1.6 * i));
    EXPECT_EQ(scene->state().counters.completed, 0u);
    EXPECT_EQ(scene->state().counters.holes, 0u);
    EXPECT_EQ(scene->state().counters.coarse, 0u);
  }
  expect_within_budget(*scene);
}

TEST(Paradigms, LazyEvaluationDrawsEverythingAndKeepsNothing) {
  Settings settings = small_settings();
  settings.paradigm = Paradigm::kLazyEvaluation;
  settings.upload_budget_bytes = 1000;  // budgets per tick are not for lazy evaluation
  settings.streaming_budget_ms = 0;
  const auto scene = make_scene(settings);
  tick_at(*scene, pose_at(256, 256));
  const std::uint32_t first = scene->state().counters.models_synthesised;
  EXPECT_GT(first, 50u);
  EXPECT_EQ(scene->state().counters.holes, 0u);
  tick_at(*scene, pose_at(256, 256));  // from now on it is known how high the ground is
  const std::uint32_t second = scene->state().counters.models_synthesised;
  EXPECT_GT(second, 50u);
  EXPECT_LE(second, first);
  tick_at(*scene, pose_at(256, 256));
  EXPECT_EQ(scene->state().counters.models_synthesised, second);
  tick_at(*scene, pose_at(256, 256, 3.14));
  const synthesis::CacheStats stats = scene->state().meshes.stats();
  EXPECT_EQ(stats.ready, scene->state().counters.models_synthesised);
}

// Though each picture would fit, and here nothing is in flight.
// Nothing is asked for early where frames wait for everything: it would never be drawn.
TEST(Paradigms, LazyEvaluationDrawsModelsThatAreJustLargeEnough) {
  Settings settings = small_settings();
  settings.min_size_pixels = 12;
  const auto usual = make_scene(settings);
  for (int i = 0; i < 60; ++i)
    tick_at(*usual, pose_at(256, 256));
  settings.paradigm = Paradigm::kLazyEvaluation;
  const auto lazy = make_scene(settings);
  for (int i = 0; i < 3; ++i)
    tick_at(*lazy, pose_at(256, 256));
  EXPECT_GT(lazy->state().draws.models.size(), 20U);
  EXPECT_EQ(lazy->state().draws.models.size(), usual->state().draws.models.size());
}

TEST(Paradigms, LazyEvaluationLeavesRoomForTwoPicturesThatMayBeInFlight) {
  Settings settings = small_settings();
  settings.paradigm = Paradigm::kLazyEvaluation;
  settings.view_distance_m = 600;
  settings.max_error_pixels = 1;
  const auto visible = [](const Scene& scene) {
    return scene.state().meshes.stats().visible_bytes;
  };
  const auto ample = make_scene(settings);
  for (int i = 0; i < 3; ++i)
    tick_at(*ample, pose_at(256, 256));
  EXPECT_EQ(ample->state().quality.coarsening, 1.0F);
  settings.budget_bytes = visible(*ample) * 2;
  const auto scene = make_scene(settings);
  for (int i = 0; i < 25; ++i)
    tick_at(*scene, pose_at(256, 256));
  EXPECT_GT(scene->state().quality.coarsening, 1.0F);
  EXPECT_LE(3 * visible(*scene), settings.budget_bytes);
  EXPECT_GT(8 * visible(*scene), settings.budget_bytes) << "but no coarser than that";
  EXPECT_EQ(scene->state().counters.holes, 0u);
}

TEST(Paradigms, FullDetailEverywhereDrawsLevelZeroOnly) {
  Settings settings = small_settings();
  settings.levels_of_detail = false;
  settings.view_distance_m = 64;
  settings.budget_bytes = 256ull << 20;
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  tick_at(*scene, pose_at(256, 256));
  EXPECT_EQ(scene->state().counters.holes, 0u);
  std::size_t other_levels = 0, drawn = 0;
  std::as_const(scene->state().entities)
      .each<const Demand>([&](std::span<const ecs::Entity>, std::span<const Demand> demands) {
        for (const Demand& demand : demands) {
          drawn += demand.drawn_level == 0;
          other_levels += demand.drawn_level != 0 && demand.drawn_level != kNoLevel;
        }
      });
  EXPECT_GT(drawn, 50u);
  EXPECT_EQ(other_levels, 0u);
}

// The standard rock with a synthesis of its own.
class TestRock : public ForwardingType {
 public:
  explicit TestRock(const models::ModelType& rock) : ForwardingType("test_rock", rock) {}
};

// Its synthesis always throws.
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
    const std::atomic<bool>& release, const Settings& settings) {
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

TEST(Paradigms, AModelThatFailsIsAHoleAndTheOthersGoOn) {
  const std::atomic<bool> unused{true};
  const auto scene = scene_with(
      [](const models::ModelType& rock, const std::atomic<bool>&) {
        return std::unique_ptr<models::ModelType>(std::make_unique<FailingRock>(rock));
      },
      unused, small_settings());
  scene->settle(pose_at(256, 256));
  const std::uint64_t failures = scene->state().totals.failed;
  EXPECT_GT(failures, 0u);
  tick_at(*scene, pose_at(256, 256));
  EXPECT_GT(scene->state().counters.holes, 0u);        // the rocks
  EXPECT_GT(scene->state().draws.models.size(), 10u);  // the trees
  EXPECT_GT(scene->state().draws.terrain.size(), 1u);
  EXPECT_EQ(scene->state().counters.requests, 0u);  // nothing is retried in a loop
  for (int i = 0; i < 20; ++i) {
    tick_at(*scene, pose_at(256, 256));
  }
  EXPECT_EQ(scene->state().totals.failed, failures);
}

TEST(Paradigms, AModelThatHangsIsReplacedByAnotherLevelAndTheOthersGoOn) {
  std::atomic<bool> release{false};
  Settings settings = small_settings();
  settings.watchdog_seconds = 0.5;
  auto scene = scene_with(
      [](const models::ModelType& rock, const std::atomic<bool>& gate) {
        return std::unique_ptr<models::ModelType>(std::make_unique<HangingRock>(rock, gate));
      },
      release, settings);
  scene->settle(pose_at(256, 256));
  EXPECT_EQ(scene->state().meshes.hung().size(), 1u);
  EXPECT_EQ(scene->state().totals.failed, 1u);
  tick_at(*scene, pose_at(256, 256));
  EXPECT_EQ(scene->state().counters.holes, 0u);
  release = true;
  release.notify_all();
  while (!scene->state().meshes.hung().empty()) {
    tick_at(*scene, pose_at(256, 256));  // collects what the modeler left
  }
  EXPECT_EQ(scene->state().totals.failed, 1u);
}

}  // namespace
}  // namespace psygen::scene
