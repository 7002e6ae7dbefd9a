// The three paradigms of the paper, and models that fail.
#include <stdexcept>

#include "tests/engine/scene/fixture.hpp"

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
  const auto scene = make_scene(settings);
  const auto meshes = scene->amplify(pose_at(256, 256));
  ASSERT_TRUE(meshes) << meshes.error().message;
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
  const auto scene = make_scene(settings);
  tick_at(*scene, pose_at(256, 256));
  const std::uint32_t first = scene->state().counters.models_synthesised;
  EXPECT_GT(first, 50u);
  EXPECT_EQ(scene->state().counters.holes, 0u);
  tick_at(*scene, pose_at(256, 256));
  EXPECT_EQ(scene->state().counters.models_synthesised, first);
  tick_at(*scene, pose_at(256, 256, 3.14));
  const synthesis::CacheStats stats = scene->state().synthesis.cache->stats();
  EXPECT_EQ(stats.ready, scene->state().counters.models_synthesised);
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

// A rock whose synthesis always throws.
class FailingRock final : public models::ModelType {
 public:
  explicit FailingRock(const models::ModelType& rock) : rock_(rock) {}
  std::string_view name() const override { return "failing_rock"; }
  std::string_view doc() const override { return "a rock that cannot be made"; }
  std::span<const models::ParameterSpec> parameters() const override { return rock_.parameters(); }
  int level_count() const override { return rock_.level_count(); }
  double level_error_m(const models::Parameters& p, int level) const override {
    return rock_.level_error_m(p, level);
  }
  core::Bounds bounds(const models::Parameters& p) const override { return rock_.bounds(p); }
  models::MeshSize mesh_size(const models::Parameters& p, int level) const override {
    return rock_.mesh_size(p, level);
  }
  double complexity(const models::Parameters& p, int level) const override {
    return rock_.complexity(p, level);
  }
  double log2_cost(const models::Parameters& p) const override { return rock_.log2_cost(p); }
  core::Bounds synthesize(const models::Parameters&, int, const models::MeshView&) const override {
    throw std::runtime_error("out of stone");
  }
  void write_shared_indices(std::uint32_t id, std::span<std::uint16_t> out) const override {
    rock_.write_shared_indices(id, out);
  }

 private:
  const models::ModelType& rock_;
};

TEST(Paradigms, AModelThatFailsIsAHoleAndTheOthersGoOn) {
  models::Registry registry = models::make_standard_registry();
  const auto& rock = registry[static_cast<models::ModelIndex>(registry.find("rock"))];
  const auto failing = registry.add(std::make_unique<FailingRock>(rock));
  ASSERT_TRUE(failing);
  world::World world = paper_world(registry);
  for (world::Scatter& scatter : world.scatter) {
    if (registry[scatter.model].name() == "rock") scatter.model = *failing;
  }
  auto scene = Scene::create(world, std::move(registry), small_settings(), nullptr);
  ASSERT_TRUE(scene) << scene.error().message;
  (*scene)->settle(pose_at(256, 256));
  const std::uint64_t failures = (*scene)->state().totals.failed;
  EXPECT_GT(failures, 0u);
  tick_at(**scene, pose_at(256, 256));
  EXPECT_GT((*scene)->state().counters.holes, 0u);        // the rocks
  EXPECT_GT((*scene)->state().draws.models.size(), 10u);  // the trees
  EXPECT_GT((*scene)->state().draws.terrain.size(), 1u);
  for (int i = 0; i < 20; ++i)
    tick_at(**scene, pose_at(256, 256));
  // Each level of each rock fails at most once: nothing is retried in a loop.
  EXPECT_LE((*scene)->state().totals.failed, failures + 200);
}

}  // namespace
}  // namespace psygen::scene
