#include "engine/scene/scene.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include "engine/scene/draws/mesh_parts.hpp"
#include "engine/synthesis/content_hash.hpp"
#include "tests/engine/scene/fixture.hpp"
#include "tests/faults.hpp"

namespace psygen::scene {
namespace {

// What the draw lists say, without where it lies in memory.
using DrawKey = std::tuple<std::uint32_t, std::uint32_t, float, float, float>;
std::multiset<DrawKey> draw_keys(const Scene& scene) {
  std::multiset<DrawKey> keys;
  for (const auto& d : scene.state().draws.models) {
    keys.insert({d.range.vertex_count, d.range.index_count, d.origin.x, d.origin.y, d.origin.z});
  }
  for (const auto& d : scene.state().draws.terrain) {
    keys.insert({d.range.vertex_count, 0u, d.origin.x, d.origin.y, d.origin.z});
  }
  return keys;
}

TEST(Scene, SettlingLeavesNoHoleAndNothingCoarse) {
  const auto scene = make_scene(small_settings());
  EXPECT_GT(scene->settle(pose_at(256, 256)), 100u);
  tick_at(*scene, pose_at(256, 256));
  const Counters& counters = scene->state().counters;
  EXPECT_GT(counters.nodes_in_view, 50u);
  EXPECT_EQ(counters.holes, 0u);
  EXPECT_EQ(counters.coarse, 0u);
  EXPECT_EQ(counters.requests, 0u);
  expect_within_budget(*scene);
}

// Over everything that is in the cache.
synthesis::WorldHash cache_hash(const Scene& scene) {
  synthesis::WorldHash hash;
  const State& s = scene.state();
  for (const synthesis::MeshRecord& record : s.meshes.records()) {
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
    Settings settings = small_settings();
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
    Settings settings = small_settings();
    settings.plp_mode = mode;
    const auto scene = make_scene(settings);
    scene->settle(pose_at(100, 400, 0.7));
    tick_at(*scene, pose_at(100, 400, 0.7));
    if (first.empty()) first = draw_keys(*scene);
    EXPECT_EQ(draw_keys(*scene), first);
    const synthesis::CacheStats stats = scene->state().meshes.stats();
    EXPECT_GT(stats.triangles_drawn, 0u);
    EXPECT_LT(stats.triangles_drawn, stats.triangles);
  }
}

TEST(Scene, WhatASettledSceneDrawsDoesNotDependOnWhatWasDrawnBefore) {
  const auto direct = make_scene(small_settings());
  direct->settle(pose_at(256, 256));
  tick_at(*direct, pose_at(256, 256));
  const auto come_back = make_scene(small_settings());
  Settings& settings = come_back->state().settings;
  const double error_pixels = settings.max_error_pixels;
  settings.max_error_pixels = 0.8 * error_pixels;  // what is finer now is nearly right afterwards
  come_back->settle(pose_at(256, 256));
  settings.max_error_pixels = error_pixels;
  come_back->settle(pose_at(256, 256));
  tick_at(*come_back, pose_at(256, 256));
  EXPECT_EQ(draw_keys(*come_back), draw_keys(*direct));
}

std::set<visibility::NodeCoord> nodes_of(const Scene& scene) {
  std::set<visibility::NodeCoord> all;
  std::as_const(scene.state().entities)
      .each<const Node>([&](std::span<const ecs::Entity>, std::span<const Node> nodes) {
        for (const Node& node : nodes)
          all.insert(node.at);
      });
  return all;
}

TEST(Scene, FlyingKeepsNodesAroundTheCameraAndNothingElse) {
  const auto scene = make_scene(small_settings());
  for (int step = 0; step < 40; ++step) {
    core::CameraPose pose = pose_at(200, 200);
    pose.position.local.x += 20.0 * step;
    tick_at(*scene, pose);
    expect_within_budget(*scene);
  }
  // The same nodes as in a scene that has always been there.
  const auto fresh = make_scene(small_settings());
  tick_at(*fresh, scene->state().input.pose);
  EXPECT_EQ(nodes_of(*scene), nodes_of(*fresh));
  EXPECT_EQ(scene->state().entities.size(), fresh->state().entities.size());
}

TEST(Scene, NewGroundIsSpreadOverTicksAndAllOfItComes) {
  Settings settings = small_settings();
  settings.streaming_ticks = 4;
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  const State& state = scene->state();
  tick_at(*scene, pose_at(300, 256));
  const std::size_t per_tick = state.counters.nodes_created;
  EXPECT_GT(state.streaming.missing.size(), 2 * per_tick);
  EXPECT_LE(state.streaming.missing.size(), 3 * per_tick);
  for (int tick = 1; tick < 4; ++tick) {
    tick_at(*scene, pose_at(300, 256));
    EXPECT_LE(state.counters.nodes_created, per_tick);
  }
  EXPECT_TRUE(state.streaming.missing.empty());
}

TEST(Scene, AtTheEdgeOfTheWorldThereIsNothingBeyond) {
  const auto scene = make_scene(small_settings());
  scene->settle(pose_at(0, 0));
  tick_at(*scene, pose_at(0, 0));
  EXPECT_EQ(scene->state().counters.holes, 0u);
  std::size_t outside = 0;
  for (const visibility::NodeCoord& at : nodes_of(*scene))
    outside += at.coord.x < 0 || at.coord.z < 0;
  EXPECT_EQ(outside, 0u);
}

TEST(Scene, ACameraThatIsNotANumberKeepsTheLastValidPose) {
  const auto scene = make_scene(small_settings());
  tick_at(*scene, pose_at(256, 256));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), 1e30, -std::numeric_limits<double>::infinity()}) {
    core::CameraPose pose = pose_at(300, 300);
    pose.position.local.z = bad;
    tick_at(*scene, pose);
    EXPECT_EQ(scene->state().camera.pose.position.block, (core::BlockCoord{256, 256}));
  }
  EXPECT_EQ(scene->state().camera.rejected_poses, 3u);
}

TEST(Scene, TeleportsAndSpinsKeepTheQueueBoundedAndRecover) {
  const auto scene = make_scene(small_settings());
  const std::size_t entities_of_window = [&] {
    tick_at(*scene, pose_at(256, 256));
    return scene->state().entities.size();
  }();
  for (int i = 0; i < 12; ++i) {
    tick_at(*scene, pose_at(40 + 37 * i, 500 - 31 * i, 2.0 * i));
    EXPECT_LE(scene->state().meshes.outstanding(), scene->state().settings.plan_max_requests + 64u);
    EXPECT_EQ(scene->state().entities.size(), entities_of_window);
    expect_within_budget(*scene);
  }
  scene->settle(pose_at(60, 60, 1.0));
  tick_at(*scene, pose_at(60, 60, 1.0));
  EXPECT_EQ(scene->state().counters.holes, 0u);
}

TEST(Scene, ABudgetThatIsTooSmallGivesCoarserLevelsWithoutThrashing) {
  Settings settings = small_settings();
  settings.budget_bytes = 5ull << 20;
  settings.max_error_pixels = 0.5;  // wants far more than fits
  const auto scene = make_scene(settings);
  for (int i = 0; i < 300; ++i) {
    tick_at(*scene, pose_at(256, 256));
    scene->state().meshes.wait();
    expect_within_budget(*scene);
  }
  EXPECT_GT(scene->state().quality.coarsening, 1.0F);
  EXPECT_TRUE(scene->state().quality.warned_budget);
  EXPECT_EQ(scene->state().counters.holes, 0u);
  const std::uint64_t evictions = scene->state().meshes.stats().evictions;
  for (int i = 0; i < 50; ++i) {
    tick_at(*scene, pose_at(256, 256));
    scene->state().meshes.wait();
  }
  EXPECT_LT(scene->state().meshes.stats().evictions - evictions, 500u);
}

// After a long flight a cache is full of what lies behind: that must not make what is seen coarser.
TEST(Scene, ACacheThatIsFullOfWhatNobodyWantsMakesNothingCoarser) {
  Settings settings = small_settings();
  settings.budget_bytes = 24ull << 20;
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(100, 256, 1.57);
  pose.position.local.y = 140;
  for (int i = 0; i < 600; ++i) {
    pose.position.local.x += 25;
    pose.position = core::normalised(pose.position, scene->state().facts.world.block_size_m());
    tick_at(*scene, pose);
    scene->state().meshes.wait();
    expect_within_budget(*scene);
    EXPECT_EQ(scene->state().quality.coarsening, 1.0F) << i;
  }
  const synthesis::CacheStats stats = scene->state().meshes.stats();
  EXPECT_GT(stats.evictions, 1000u);
  EXPECT_GT(stats.bytes, settings.budget_bytes * 9 / 10);
  EXPECT_LT(stats.visible_bytes, settings.budget_bytes / 4);
  EXPECT_FALSE(scene->state().quality.warned_budget);
}

// Of what is drawn in view.
std::uint64_t visible_bytes(const Scene& scene) {
  std::uint64_t bytes = 0;
  for (const synthesis::MeshRecord& record : scene.state().meshes.records()) {
    const bool ready = record.state == synthesis::MeshState::kReady;
    if (ready && synthesis::is_visible(record.rank.group())) bytes += record.range.bytes;
  }
  return bytes;
}

// Meshes in view that are drawn finer than wanted.
std::size_t too_fine(const Scene& scene) {
  const State& s = scene.state();
  std::size_t count = 0;
  s.entities.each<const Demand>([&](std::span<const ecs::Entity>, std::span<const Demand> demands) {
    for (const Demand& demand : demands) {
      const bool drawn = demand.drawn_level != kNoLevel && demand.in_view_tick + 1 == s.clock.tick;
      count += drawn && demand.drawn_level < demand.wanted_level ? 1 : 0;
    }
  });
  return count;
}

TEST(Scene, DetailThatIsNotWantedAnyMoreDoesNotHoldTheRoomOfWhatIs) {
  Settings settings = small_settings();
  settings.max_error_pixels = 0.5;
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  tick_at(*scene, pose_at(256, 256));
  // Room for the nearest of what is drawn and for nothing else, and then much less detail is
  // wanted.
  scene->state().meshes.set_budget(visible_bytes(*scene) / 4);
  const std::uint64_t room = visible_bytes(*scene);
  EXPECT_GT(room, 1ull << 20);
  scene->state().meshes.set_budget(room);
  scene->state().quality.coarsening = 64;
  for (int i = 0; i < 60; ++i) {
    tick_at(*scene, pose_at(256, 256));
    scene->state().meshes.wait();
    EXPECT_LE(scene->state().memory->used_bytes(), room);
  }
  EXPECT_EQ(scene->state().counters.holes, 0u);
  EXPECT_EQ(scene->state().counters.refused, 0u);
  EXPECT_EQ(too_fine(*scene), 0u);
}

TEST(Scene, ComingBackUnderPressureNeverDrawsWhatWasEvicted) {
  Settings settings = small_settings();
  settings.budget_bytes = 6ull << 20;
  const auto scene = make_scene(settings);
  for (int round = 0; round < 4; ++round) {
    for (int step = -8; step <= 8; ++step) {
      core::CameraPose pose = pose_at(200, 200, 0.4 * step);
      pose.position.local.x += 45.0 * (round % 2 == 0 ? step : -step);
      tick_at(*scene, pose);
      scene->state().meshes.wait();
      expect_consistent(*scene);
    }
  }
  EXPECT_GT(scene->state().meshes.stats().evictions, 100u);
  EXPECT_GT(scene->state().meshes.stats().hits, 100u);
}

TEST(Scene, SettlingEndsAlsoWhenTheBudgetCannotHoldTheView) {
  Settings settings = small_settings();
  settings.levels_of_detail = false;
  settings.budget_bytes = 5ull << 20;
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  tick_at(*scene, pose_at(256, 256));
  EXPECT_GT(scene->state().counters.holes, 0u);
  expect_consistent(*scene);
}

TEST(Scene, SettlingEndsUnderAnyBudget) {
  for (const bool levels : {true, false}) {
    for (const std::uint64_t mib : {4u, 5u, 6u, 9u, 12u, 24u}) {
      Settings settings = small_settings();
      settings.levels_of_detail = levels;
      settings.max_error_pixels = 0.5;
      settings.budget_bytes = mib << 20;
      const auto scene = make_scene(settings);
      constexpr std::uint32_t kMaxTicks = 1500;
      scene->settle(pose_at(256, 256), [&](std::string_view, double) {
        return scene->state().clock.tick < kMaxTicks;
      });
      EXPECT_LT(scene->state().clock.tick, kMaxTicks) << mib << " MiB, levels " << levels;
      const std::uint64_t evicted = scene->state().meshes.stats().evictions;
      for (int i = 0; i < 60; ++i) {
        tick_at(*scene, pose_at(256, 256));
        scene->state().meshes.wait();
      }
      // Meshes that evict each other in turn would do so in every tick.
      EXPECT_LT(scene->state().meshes.stats().evictions, evicted + 10);
      expect_consistent(*scene);
      expect_within_budget(*scene);
    }
  }
}

// What each entity knows of its mesh in parts is that of the mesh it draws; returns the levels that
// these entities draw.
std::map<std::uint64_t, int> check_parts(Scene& scene) {
  std::map<std::uint64_t, int> drawn;
  const State& s = scene.state();
  s.entities.each<const MeshParts, const Demand, const Mesh, const Placed>(
      [&](std::span<const ecs::Entity> entities, std::span<const MeshParts> parts,
          std::span<const Demand> demands, std::span<const Mesh> meshes,
          std::span<const Placed> placed) {
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

TEST(Scene, MergedMeshesKnowThePartsOfTheLevelThatIsDrawn) {
  Settings settings = small_settings();
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
  Settings settings = small_settings();
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  const std::uint64_t half = scene->state().memory->used_bytes() / 2;
  scene->state().meshes.set_budget(half);
  for (int i = 0; i < 60; ++i) {
    tick_at(*scene, pose_at(256, 256));
    scene->state().meshes.wait();
  }
  EXPECT_LE(scene->state().memory->used_bytes(), half);
}

TEST(Scene, HasTheModelersThatThereAreThreadsForAndIsRefusedWithoutAny) {
  Settings settings = small_settings();
  settings.virtual_time = false;  // modelers are threads
  settings.modelers = 8;
  {
    const FewThreads few(2);
    const auto scene = make_scene(settings);
    EXPECT_EQ(scene->state().settings.modelers, 2u);
    scene->settle(pose_at(100, 100));
    EXPECT_EQ(scene->state().counters.holes, 0u);
  }
  const FewThreads none(0);
  models::Registry registry = models::make_standard_registry();
  const world::World world = paper_world(registry);
  const auto scene = Scene::create(world, std::move(registry), settings, nullptr);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().message.find("no modeler can be started: "), 0u) << scene.error().message;
}

TEST(Scene, SettingsThatMakeNoSenseAreRefused) {
  const auto refused = [](const Settings& settings) {
    models::Registry registry = models::make_standard_registry();
    const world::World world = paper_world(registry);
    return !Scene::create(world, std::move(registry), settings, nullptr).has_value();
  };
  Settings settings = small_settings();
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
  settings.modelers = 100000;
  EXPECT_TRUE(refused(settings));
  settings = small_settings();
  settings.levels_of_detail = false;
  settings.view_distance_m = 8192;  // four million trees and rocks
  EXPECT_TRUE(refused(settings));
}

}  // namespace
}  // namespace psygen::scene
