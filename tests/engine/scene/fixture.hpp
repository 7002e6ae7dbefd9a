// A small scene on the null device: the paper's world with a short view.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <set>

#include "engine/core/clock.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/nodes/mesh_entity.hpp"
#include "engine/scene/state.hpp"
#include "engine/scene/systems.hpp"
#include "engine/world/files/world_file.hpp"
#include "tests/source_file.hpp"

namespace psygen::scene {

inline SceneSettings small_settings() {
  SceneSettings settings;
  settings.view_distance_m = 130;
  settings.budget_bytes = 64ull << 20;
  settings.modelers = 1;
  settings.virtual_time = true;  // tests do not depend on what the machine has left over
  settings.watchdog_seconds = 1e6;
  settings.streaming_budget_ms = 1e9;
  settings.streaming_ticks = 1;
  return settings;
}

inline world::World paper_world(const models::Registry& registry) {
  auto world = world::load_world(source_file("game/worlds/paper.toml"), registry);
  EXPECT_TRUE(world) << world.error().message;
  return *world;
}

inline std::unique_ptr<Scene> make_scene(const world::World& world, const SceneSettings& settings,
                                         models::Registry registry) {
  auto scene = Scene::create(world, std::move(registry), settings, nullptr);
  EXPECT_TRUE(scene) << scene.error().message;
  return std::move(*scene);
}

// The paper's world with some things changed.
template <class Change>
std::unique_ptr<Scene> make_scene_of(const SceneSettings& settings, const Change& change) {
  models::Registry registry = models::make_standard_registry();
  world::World world = paper_world(registry);
  change(world);
  return make_scene(world, settings, std::move(registry));
}

inline std::unique_ptr<Scene> make_scene(
    const SceneSettings& settings, models::Registry registry = models::make_standard_registry()) {
  const world::World world = paper_world(registry);
  return make_scene(world, settings, std::move(registry));
}

inline core::CameraPose pose_at(std::int32_t block_x, std::int32_t block_z, double yaw = 0) {
  core::CameraPose pose;
  pose.position = {{block_x, block_z}, {31.5, 60.0, 31.5}};
  pose.pitch = -0.2;
  pose.yaw = yaw;
  return pose;
}

// Runs one tick; its requests may be ready in a later one.
inline void tick_at(Scene& scene, const core::CameraPose& pose) {
  State& state = state_of(scene);
  state.input.pose = pose;
  tick(state);
  state.clock.now_s += 1.0 / 60.0;
}

inline void expect_within_budget(const Scene& scene) {
  const synthesis::CacheStats stats = state_of(scene).supply.stats();
  EXPECT_LE(stats.peak_bytes, stats.budget_bytes);
  EXPECT_LE(state_of(scene).memory->used_bytes(), stats.budget_bytes);
}

// Expects that the cache holds everything that the last tick drew.
inline void expect_drawn_alive(const Scene& scene) {
  const State& s = state_of(scene);
  if (s.draws.last.tick + 1 != s.clock.tick) return;  // the last tick drew nothing
  std::set<std::uint32_t> alive;
  std::size_t wrong = 0;
  for (const synthesis::MeshHandle handle : s.draws.meshes) {
    const synthesis::MeshRecord* record = s.supply.get(handle);
    if (record != nullptr && record->state == synthesis::MeshState::kReady)
      alive.insert(record->range.id);
    else
      ++wrong;
  }
  for (const render::MeshDraw& draw : s.draws.models)
    wrong += alive.contains(draw.range.id) ? 0 : 1;
  EXPECT_EQ(wrong, 0u);
}

// Expects that the cache holds the drawn mesh of each entity, at the level that the entity records.
inline void expect_consistent(Scene& scene) {
  const synthesis::MeshSupply& supply = state_of(scene).supply;
  std::size_t wrong = 0;
  std::as_const(state_of(scene).entities)
      .each<const MeshDemand, const Mesh, const LodErrors, const MeshSource>(
          [&](std::span<const ecs::Entity>, std::span<const MeshDemand> demands,
              std::span<const Mesh> meshes, std::span<const LodErrors> details,
              std::span<const MeshSource> sources) {
            for (std::size_t i = 0; i < demands.size(); ++i) {
              if (demands[i].drawn_level == kNoLevel) continue;
              const synthesis::MeshRecord* record = supply.get(meshes[i].handle);
              wrong += record == nullptr || record->state != synthesis::MeshState::kReady ||
                       record->range != meshes[i].range ||
                       level_of(details[i], sources[i], record->key) != demands[i].drawn_level;
            }
          });
  EXPECT_EQ(wrong, 0u);
  expect_drawn_alive(scene);
  expect_within_budget(scene);
}

}  // namespace psygen::scene
