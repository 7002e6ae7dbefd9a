// Model types, queries, amplification and a scene's own synthesis need little stack.
#include <pthread.h>

#include "engine/amplify/amplify.hpp"
#include "engine/amplify/block_synthesiser.hpp"
#include "engine/core/headroom.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/query/world.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "engine/world/far/merged_models.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

constexpr std::size_t kStackBytes = 256 << 10;

// Runs `work` on a thread with this stack, and ends the program if that is too little.
void on_small_stack(std::function<void()> work) {
  pthread_attr_t attributes;
  pthread_t thread;
  ASSERT_EQ(pthread_attr_init(&attributes), 0);
  ASSERT_EQ(pthread_attr_setstacksize(&attributes, kStackBytes), 0);
  const auto run = [](void* data) -> void* {
    (*static_cast<std::function<void()>*>(data))();
    return nullptr;
  };
  ASSERT_EQ(pthread_create(&thread, &attributes, run, &work), 0);
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
}

void make_all_levels(const models::ModelType& type, const models::Parameters& p) {
  for (int level = 0; level < type.level_count(); ++level) {
    auto mesh = synthesis::HeapDestination::make(type, p, level);
    ASSERT_TRUE(mesh) << mesh.error().message;
    const auto made = synthesis::synthesise_guarded(type, p, level, mesh->view());
    EXPECT_TRUE(made.ok) << made.error;
  }
  (void)type.collider(p);
}

TEST(SmallStack, IsEnoughForEveryModelTypeQueryAndAmplification) {
  for (const char* name : {"paper", "five_species", "silver_combe", "ember_pass", "lakes"}) {
    on_small_stack([name] {
      models::Registry registry = models::make_standard_registry();
      const auto file = source_file("game/worlds/") + name + ".toml";
      const auto loaded = world::load_world(file, registry);
      ASSERT_TRUE(loaded) << loaded.error().message;
      world::World world = *loaded;
      if (world.name == "silver combe") {
        world.shaped.erosion.strength = 0.6;
        ASSERT_TRUE(world::shape_ground(world));
      }
      for (models::ModelIndex i = 0; i < registry.size(); ++i)
        make_all_levels(registry[i], models::default_parameters(registry[i]));
      std::vector<world::Placement> placements;
      const core::BlockCoord block{3, 2};
      world::place_models(world, registry, block, placements);
      for (const world::Placement& placement : placements)
        make_all_levels(registry[placement.model], placement.parameters);
      const auto merged = world::make_merged_type(std::make_shared<world::World>(world), registry);
      for (int level = 1; level <= 4; ++level)
        make_all_levels(*merged, world::merged_parameters({1, 1}, level));
      make_all_levels(registry[world.terrain_model], world::terrain_parameters(world, {0, 0}, 5));

      query::World query(world, registry);
      const core::WorldPosition at{block, {10, 50, 10}};
      EXPECT_TRUE(query.ground(at));
      EXPECT_TRUE(query.cast({at, {0.3, -1, 0.2}, 500}));
      EXPECT_TRUE(query.nearest(at, 100));
      (void)query.solids(block);
      EXPECT_GT(models::ground_height_m(world.terrain, block, 1, 1), 0);

      amplify::Totals totals;
      amplify::BlockSynthesiser(world, registry, amplify::kAllLevels).synthesise(block, totals);
      EXPECT_EQ(totals.failed, 0U);
    });
  }
}

TEST(SmallStack, IsEnoughForASceneThatSynthesisesByItself) {
  on_small_stack([] {
    for (const Paradigm paradigm :
         {Paradigm::kLazyEvaluation, Paradigm::kParallelLazyAmplification}) {
      SceneSettings settings = small_settings();
      settings.paradigm = paradigm;
      settings.virtual_time = false;
      const auto scene = make_scene(settings);
      if (paradigm == Paradigm::kParallelLazyAmplification) {
        EXPECT_GT(scene->settle(pose_at(5, 5), {}), 0U);
      }
      tick_at(*scene, pose_at(5, 5));
    }
  });
}

TEST(SmallStack, ThreadsOfTheEngineHaveTheUsualStack) {
  std::size_t bytes = 0;
  on_small_stack([&bytes] {
    pthread_attr_t usual, before;
    ASSERT_EQ(pthread_getattr_default_np(&before), 0);
    usual = before;
    ASSERT_EQ(pthread_attr_setstacksize(&usual, kStackBytes), 0);
    ASSERT_EQ(pthread_setattr_default_np(&usual), 0);  // as `ulimit -s 256`
    auto thread = core::start_thread([&bytes] {
      pthread_attr_t own;
      if (pthread_getattr_np(pthread_self(), &own) != 0) return;
      pthread_attr_getstacksize(&own, &bytes);
      pthread_attr_destroy(&own);
    });
    ASSERT_TRUE(thread) << thread.error().message;
    thread->join();
    std::size_t after = 0;
    ASSERT_EQ(pthread_getattr_default_np(&usual), 0);
    pthread_attr_getstacksize(&usual, &after);
    EXPECT_EQ(after, kStackBytes) << "other threads keep theirs";
    pthread_setattr_default_np(&before);
  });
  EXPECT_GE(bytes, core::kThreadStackBytes);
}

}  // namespace
}  // namespace psygen::scene
