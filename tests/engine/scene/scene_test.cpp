#include "engine/scene/scene.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include "engine/scene/meshes/mesh_annotations.hpp"
#include "engine/scene/systems.hpp"
#include "engine/synthesis/content_hash.hpp"
#include "tests/engine/scene/fixture.hpp"
#include "tests/faults.hpp"

namespace psygen::scene {
namespace {

// The content of the draw lists without memory addresses.
using DrawKey = std::tuple<std::uint32_t, std::uint32_t, float, float, float>;
std::multiset<DrawKey> draw_keys(const Scene& scene) {
  std::multiset<DrawKey> keys;
  for (const auto& d : state_of(scene).draws.models) {
    keys.insert({d.range.vertex_count, d.range.index_count, d.origin.x, d.origin.y, d.origin.z});
  }
  for (const auto& d : state_of(scene).draws.terrain) {
    keys.insert({d.range.vertex_count, 0u, d.origin.x, d.origin.y, d.origin.z});
  }
  return keys;
}

TEST(Scene, SettlingLeavesNoHoleAndNothingCoarse) {
  const auto scene = make_scene(small_settings());
  EXPECT_GT(scene->settle(pose_at(256, 256)), 100u);
  tick_at(*scene, pose_at(256, 256));
  const DrawCounts& counters = state_of(*scene).draws.counts;
  EXPECT_GT(counters.nodes_in_view, 50u);
  EXPECT_EQ(counters.holes, 0u);
  EXPECT_EQ(counters.coarse, 0u);
  EXPECT_EQ(scene->statistics().meshes.requests, 0u);
  expect_within_budget(*scene);
}

// A hash of everything in the cache.
synthesis::WorldHash cache_hash(const Scene& scene) {
  synthesis::WorldHash hash;
  const State& s = state_of(scene);
  for (const synthesis::MeshRecord& record : s.supply.records()) {
    if (record.state != synthesis::MeshState::kReady) continue;
    const auto vertices = core::hash_bytes(s.memory->vertex_bytes(record.range));
    const auto indices = core::hash_bytes(std::as_bytes(s.memory->indices(record.range)));
    hash.add(core::combine(core::combine(synthesis::hash_of(record.key), vertices), indices));
  }
  return hash;
}

TEST(Scene, DrawListsAndEveryByteOfGeometryAreTheSameForAnyNumberOfModelers) {
  std::multiset<DrawKey> first;
  synthesis::WorldHash first_hash;
  for (const std::uint32_t modelers : {1u, 2u, 4u}) {
    SceneSettings settings = small_settings();
    settings.modelers = modelers;
    const auto scene = make_scene(settings);
    scene->settle(pose_at(100, 400, 0.7));
    tick_at(*scene, pose_at(100, 400, 0.7));
    if (modelers == 1) {
      first = draw_keys(*scene);
      first_hash = cache_hash(*scene);
      EXPECT_GT(first.size(), 50u);
      EXPECT_GT(first_hash.count(), 1000u);
    } else {
      EXPECT_EQ(draw_keys(*scene), first) << modelers << " modelers";
      EXPECT_EQ(cache_hash(*scene).count(), first_hash.count());
      EXPECT_EQ(cache_hash(*scene).value(), first_hash.value()) << modelers << " modelers";
    }
  }
}

TEST(Scene, BothModesOfPlpAreDeterministicAndSettleToTheSamePicture) {
  std::multiset<DrawKey> first;
  for (const auto mode : {visibility::PlpMode::kLayers, visibility::PlpMode::kSolidity,
                          visibility::PlpMode::kSolidity}) {
    SceneSettings settings = small_settings();
    settings.plp_mode = mode;
    const auto scene = make_scene(settings);
    scene->settle(pose_at(100, 400, 0.7));
    tick_at(*scene, pose_at(100, 400, 0.7));
    if (first.empty()) first = draw_keys(*scene);
    EXPECT_EQ(draw_keys(*scene), first);
    const synthesis::CacheStats stats = state_of(*scene).supply.stats();
    EXPECT_GT(stats.triangles_drawn, 0u);
    EXPECT_LT(stats.triangles_drawn, stats.triangles);
  }
}

TEST(Scene, ASettledSceneDoesNotDependOnEarlierFrames) {
  const auto direct = make_scene(small_settings());
  direct->settle(pose_at(256, 256));
  tick_at(*direct, pose_at(256, 256));
  const auto come_back = make_scene(small_settings());
  SceneSettings& settings = state_of(*come_back).settings;
  const double error_pixels = settings.max_error_pixels;
  settings.max_error_pixels = 0.8 * error_pixels;  // finer now, and nearly right afterwards
  come_back->settle(pose_at(256, 256));
  settings.max_error_pixels = error_pixels;
  come_back->settle(pose_at(256, 256));
  tick_at(*come_back, pose_at(256, 256));
  EXPECT_EQ(draw_keys(*come_back), draw_keys(*direct));
}

std::set<visibility::NodeCoord> nodes_of(const Scene& scene) {
  std::set<visibility::NodeCoord> all;
  std::as_const(state_of(scene).entities)
      .each<const QuadtreeNode>(
          [&](std::span<const ecs::Entity>, std::span<const QuadtreeNode> nodes) {
            for (const QuadtreeNode& node : nodes)
              all.insert(node.at);
          });
  return all;
}

TEST(Scene, FlyingKeepsOnlyNodesAroundTheCamera) {
  const auto scene = make_scene(small_settings());
  for (int step = 0; step < 40; ++step) {
    core::CameraPose pose = pose_at(200, 200);
    pose.position.local.x += 20.0 * step;
    tick_at(*scene, pose);
    expect_within_budget(*scene);
  }
  // The same nodes as in a scene that was always at this place.
  const auto fresh = make_scene(small_settings());
  tick_at(*fresh, state_of(*scene).input.pose);
  EXPECT_EQ(nodes_of(*scene), nodes_of(*fresh));
  EXPECT_EQ(state_of(*scene).entities.size(), state_of(*fresh).entities.size());
}

TEST(Scene, NewGroundIsSpreadOverTicksAndBecomesComplete) {
  SceneSettings settings = small_settings();
  settings.streaming_ticks = 4;
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  const State& state = state_of(*scene);
  tick_at(*scene, pose_at(300, 256));
  const std::size_t per_tick = state.streaming.counts.created;
  EXPECT_GT(state.streaming.missing.size(), 2 * per_tick);
  EXPECT_LE(state.streaming.missing.size(), 3 * per_tick);
  for (int tick = 1; tick < 4; ++tick) {
    tick_at(*scene, pose_at(300, 256));
    EXPECT_LE(state.streaming.counts.created, per_tick);
  }
  EXPECT_TRUE(state.streaming.missing.empty());
}

TEST(Scene, NoNodesExistBeyondTheEdgeOfTheWorld) {
  const auto scene = make_scene(small_settings());
  scene->settle(pose_at(0, 0));
  tick_at(*scene, pose_at(0, 0));
  EXPECT_EQ(scene->statistics().drawn.holes, 0u);
  std::size_t outside = 0;
  for (const visibility::NodeCoord& at : nodes_of(*scene))
    outside += at.coord.x < 0 || at.coord.z < 0;
  EXPECT_EQ(outside, 0u);
}

TEST(Scene, AnInvalidCameraKeepsTheLastValidPose) {
  const auto scene = make_scene(small_settings());
  tick_at(*scene, pose_at(256, 256));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), 1e30, -std::numeric_limits<double>::infinity()}) {
    core::CameraPose pose = pose_at(300, 300);
    pose.position.local.z = bad;
    tick_at(*scene, pose);
    EXPECT_EQ(state_of(*scene).camera.pose.position.block, (core::BlockCoord{256, 256}));
  }
  EXPECT_EQ(state_of(*scene).camera.rejected_poses, 3u);
}

TEST(Scene, TeleportsAndSpinsKeepTheQueueBoundedAndRecover) {
  const auto scene = make_scene(small_settings());
  const std::size_t entities_of_window = [&] {
    tick_at(*scene, pose_at(256, 256));
    return state_of(*scene).entities.size();
  }();
  for (int i = 0; i < 12; ++i) {
    tick_at(*scene, pose_at(40 + 37 * i, 500 - 31 * i, 2.0 * i));
    EXPECT_LE(state_of(*scene).supply.outstanding(),
              state_of(*scene).settings.plan_max_requests + 64u);
    EXPECT_EQ(state_of(*scene).entities.size(), entities_of_window);
    expect_within_budget(*scene);
  }
  scene->settle(pose_at(60, 60, 1.0));
  tick_at(*scene, pose_at(60, 60, 1.0));
  EXPECT_EQ(scene->statistics().drawn.holes, 0u);
}

TEST(Scene, ATooSmallBudgetGivesCoarserLevelsWithoutThrashing) {
  SceneSettings settings = small_settings();
  settings.budget_bytes = 5ull << 20;
  settings.max_error_pixels = 0.5;  // wants far more than fits
  const auto scene = make_scene(settings);
  for (int i = 0; i < 300; ++i) {
    tick_at(*scene, pose_at(256, 256));
    state_of(*scene).supply.wait();
    expect_within_budget(*scene);
  }
  EXPECT_GT(state_of(*scene).quality.coarsening, 1.0F);
  EXPECT_TRUE(state_of(*scene).quality.warned_budget);
  EXPECT_EQ(scene->statistics().drawn.holes, 0u);
  const std::uint64_t evictions = state_of(*scene).supply.stats().evictions;
  for (int i = 0; i < 50; ++i) {
    tick_at(*scene, pose_at(256, 256));
    state_of(*scene).supply.wait();
  }
  EXPECT_LT(state_of(*scene).supply.stats().evictions - evictions, 500u);
}

// After a long flight the cache is full of meshes behind the camera. They must not make meshes in
// view coarser.
TEST(Scene, ACacheFullOfUnwantedMeshesMakesNothingCoarser) {
  SceneSettings settings = small_settings();
  settings.budget_bytes = 24ull << 20;
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(100, 256, 1.57);
  pose.position.local.y = 140;
  for (int i = 0; i < 600; ++i) {
    pose.position.local.x += 25;
    pose.position = core::normalised(pose.position, state_of(*scene).facts.world.block_size_m());
    tick_at(*scene, pose);
    state_of(*scene).supply.wait();
    expect_within_budget(*scene);
    EXPECT_EQ(state_of(*scene).quality.coarsening, 1.0F) << i;
  }
  const synthesis::CacheStats stats = state_of(*scene).supply.stats();
  EXPECT_GT(stats.evictions, 1000u);
  EXPECT_GT(stats.bytes, settings.budget_bytes * 9 / 10);
  EXPECT_LT(stats.visible_bytes, settings.budget_bytes / 4);
  EXPECT_FALSE(state_of(*scene).quality.warned_budget);
}

// Bytes of drawn meshes in view.
std::uint64_t visible_bytes(const Scene& scene) {
  std::uint64_t bytes = 0;
  for (const synthesis::MeshRecord& record : state_of(scene).supply.records()) {
    const bool ready = record.state == synthesis::MeshState::kReady;
    if (ready && synthesis::is_visible(record.rank.group())) bytes += record.range.bytes;
  }
  return bytes;
}

// Meshes in view that are drawn finer than wanted.
std::size_t too_fine(const Scene& scene) {
  const State& s = state_of(scene);
  std::size_t count = 0;
  s.entities.each<const MeshDemand>([&](std::span<const ecs::Entity>,
                                        std::span<const MeshDemand> demands) {
    for (const MeshDemand& demand : demands) {
      const bool drawn = demand.drawn_level != kNoLevel && demand.in_view_tick + 1 == s.clock.tick;
      count += drawn && demand.drawn_level < demand.wanted_level ? 1 : 0;
    }
  });
  return count;
}

TEST(Scene, UnwantedDetailIsEvictedForWantedMeshes) {
  SceneSettings settings = small_settings();
  settings.max_error_pixels = 0.5;
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  tick_at(*scene, pose_at(256, 256));
  // Memory for the nearest drawn meshes only; then much less detail is wanted.
  state_of(*scene).supply.set_budget(visible_bytes(*scene) / 4);
  const std::uint64_t room = visible_bytes(*scene);
  EXPECT_GT(room, 1ull << 20);
  state_of(*scene).supply.set_budget(room);
  state_of(*scene).quality.coarsening = 64;
  for (int i = 0; i < 60; ++i) {
    tick_at(*scene, pose_at(256, 256));
    state_of(*scene).supply.wait();
    EXPECT_LE(state_of(*scene).memory->used_bytes(), room);
  }
  EXPECT_EQ(scene->statistics().drawn.holes, 0u);
  EXPECT_EQ(scene->statistics().meshes.refused, 0u);
  EXPECT_EQ(too_fine(*scene), 0u);
}

TEST(Scene, ReturningUnderMemoryPressureNeverDrawsEvictedMeshes) {
  SceneSettings settings = small_settings();
  settings.budget_bytes = 6ull << 20;
  const auto scene = make_scene(settings);
  for (int round = 0; round < 4; ++round) {
    for (int step = -8; step <= 8; ++step) {
      core::CameraPose pose = pose_at(200, 200, 0.4 * step);
      pose.position.local.x += 45.0 * (round % 2 == 0 ? step : -step);
      tick_at(*scene, pose);
      state_of(*scene).supply.wait();
      expect_consistent(*scene);
    }
  }
  EXPECT_GT(state_of(*scene).supply.stats().evictions, 100u);
  EXPECT_GT(state_of(*scene).supply.stats().hits, 100u);
}

TEST(Scene, SettlingEndsEvenIfTheBudgetCannotHoldTheView) {
  SceneSettings settings = small_settings();
  settings.levels_of_detail = false;
  settings.budget_bytes = 5ull << 20;
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  tick_at(*scene, pose_at(256, 256));
  EXPECT_GT(scene->statistics().drawn.holes, 0u);
  expect_consistent(*scene);
}

TEST(Scene, SettlingEndsUnderAnyBudget) {
  for (const bool levels : {true, false}) {
    for (const std::uint64_t mib : {4u, 5u, 6u, 9u, 12u, 24u}) {
      SceneSettings settings = small_settings();
      settings.levels_of_detail = levels;
      settings.max_error_pixels = 0.5;
      settings.budget_bytes = mib << 20;
      const auto scene = make_scene(settings);
      constexpr std::uint32_t kMaxTicks = 1500;
      scene->settle(pose_at(256, 256), [&](std::string_view, double) {
        return state_of(*scene).clock.tick < kMaxTicks;
      });
      EXPECT_LT(state_of(*scene).clock.tick, kMaxTicks) << mib << " MiB, levels " << levels;
      const std::uint64_t evicted = state_of(*scene).supply.stats().evictions;
      for (int i = 0; i < 60; ++i) {
        tick_at(*scene, pose_at(256, 256));
        state_of(*scene).supply.wait();
      }
      // Meshes that evict each other would do so in every tick.
      EXPECT_LT(state_of(*scene).supply.stats().evictions, evicted + 10);
      expect_consistent(*scene);
      expect_within_budget(*scene);
    }
  }
}

// Checks the parts of each entity against its drawn mesh; returns the drawn levels of these
// entities.
std::map<std::uint64_t, int> check_parts(Scene& scene) {
  std::map<std::uint64_t, int> drawn;
  const State& s = state_of(scene);
  s.entities.each<const MeshParts, const MeshDemand, const Mesh, const MeshPlacement>(
      [&](std::span<const ecs::Entity> entities, std::span<const MeshParts> parts,
          std::span<const MeshDemand> demands, std::span<const Mesh> meshes,
          std::span<const MeshPlacement> placed) {
        for (std::size_t i = 0; i < parts.size(); ++i) {
          if (demands[i].drawn_level == kNoLevel) continue;
          drawn[owner_of(entities[i])] = demands[i].drawn_level;
          const MeshParts now = mesh_parts(
              core::vertices_of<core::ModelVertex>(s.memory->vertex_bytes(meshes[i].range)),
              s.memory->indices(meshes[i].range),
              core::Bounds::around(placed[i].box_centre, placed[i].box_half_extent));
          EXPECT_GT(parts[i].count, 0u);
          EXPECT_EQ(parts[i].count, now.count);
          EXPECT_EQ(parts[i].indices_each, now.indices_each);
          EXPECT_EQ(parts[i].index_count, now.index_count);
          EXPECT_LE(now.index_count, meshes[i].range.index_count);
          EXPECT_EQ(parts[i].boxes, now.boxes);
        }
      });
  return drawn;
}

TEST(Scene, MergedMeshesHaveThePartsOfTheirDrawnLevel) {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 2000;
  settings.max_error_pixels = 2;
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  const auto before = check_parts(*scene);
  EXPECT_GT(std::ranges::count(before, 0, &std::pair<const std::uint64_t, int>::second), 20);
  // Out of view a coarser level replaces the finer one.
  scene->settle(pose_at(256, 256, std::numbers::pi));
  const auto after = check_parts(*scene);
  EXPECT_GT(std::ranges::count_if(after,
                                  [&](const auto& now) {
                                    const auto then = before.find(now.first);
                                    return now.second == 1 && then != before.end() &&
                                           then->second == 0;
                                  }),
            5);
}

TEST(Scene, HalvingTheBudgetWhileFlyingIsMet) {
  SceneSettings settings = small_settings();
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  const std::uint64_t half = state_of(*scene).memory->used_bytes() / 2;
  state_of(*scene).supply.set_budget(half);
  for (int i = 0; i < 60; ++i) {
    tick_at(*scene, pose_at(256, 256));
    state_of(*scene).supply.wait();
  }
  EXPECT_LE(state_of(*scene).memory->used_bytes(), half);
}

TEST(Scene, StartsAsManyModelersAsThereAreThreadsAndFailsWithoutAny) {
  SceneSettings settings = small_settings();
  settings.virtual_time = false;  // modelers are threads
  settings.modelers = 8;
  {
    const FewThreads few(2);
    const auto scene = make_scene(settings);
    EXPECT_EQ(state_of(*scene).settings.modelers, 2u);
    scene->settle(pose_at(100, 100));
    EXPECT_EQ(scene->statistics().drawn.holes, 0u);
  }
  const FewThreads none(0);
  models::Registry registry = models::make_standard_registry();
  const world::World world = paper_world(registry);
  const auto scene = Scene::create(world, std::move(registry), settings, nullptr);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().message.find("no modeler can be started: "), 0u) << scene.error().message;
}

TEST(Scene, InvalidSettingsAreRejected) {
  const auto refused = [](const SceneSettings& settings) {
    models::Registry registry = models::make_standard_registry();
    const world::World world = paper_world(registry);
    return !Scene::create(world, std::move(registry), settings, nullptr).has_value();
  };
  SceneSettings settings = small_settings();
  settings.budget_bytes = 1000;
  EXPECT_TRUE(refused(settings));
  settings = small_settings();
  settings.view_distance_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refused(settings));
  settings = small_settings();
  settings.max_error_pixels = 0;
  EXPECT_TRUE(refused(settings));
  settings = small_settings();
  settings.fade_seconds = -1;
  EXPECT_TRUE(refused(settings));
  settings.fade_seconds = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refused(settings));
  settings = small_settings();
  settings.calibration_seconds = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refused(settings));
  settings = small_settings();
  settings.modelers = 100000;
  EXPECT_TRUE(refused(settings));
  settings = small_settings();
  settings.levels_of_detail = false;
  settings.view_distance_m = 8192;  // four million trees and rocks
  EXPECT_TRUE(refused(settings));
}

TEST(Scene, SystemsOfAGameUseNoPrivateValuesOfTheEngine) {
  struct Wolves {
    int count = 0;
  };
  const auto error_of = [](auto system) {
    auto scene = make_scene(small_settings());
    Systems systems = scene->systems();
    systems.resource<Wolves>();
    systems.frame.add("greet", system);
    const auto arranged = scene->arrange();
    return arranged ? std::string() : arranged.error().message;
  };
  EXPECT_EQ(error_of([](const Clock&, const Camera&, const View&, const WorldFacts&, const Quality&,
                        const FixedStep&, Input&, Wolves&, ecs::EventReader<NodeShown>&,
                        ecs::Query<Transform>) {}),
            "");
  EXPECT_EQ(error_of([](const DrawLists&) {}),
            "the system 'greet' reads DrawLists, which is private to the engine");
  EXPECT_EQ(error_of([](synthesis::MeshSupply&) {}),
            "the system 'greet' writes MeshSupply, which is private to the engine");
  EXPECT_EQ(error_of([](Clock&) {}),
            "the system 'greet' writes Clock; systems of a game may write Input only");
}

}  // namespace
}  // namespace psygen::scene
