// A small scene on the null device: the paper's world with a short view.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <set>

#include "engine/core/clock.hpp"
#include "engine/scene/nodes/mesh_entity.hpp"
#include "engine/scene/scene.hpp"
#include "engine/world/files/world_file.hpp"
#include "tests/source_file.hpp"

namespace psygen::scene {

inline Settings small_settings() {
  Settings settings;
  settings.view_distance_m = 130;
  settings.budget_bytes = 64ull << 20;
  settings.modelers = 1;
  settings.virtual_time = true;  // tests do not depend on what the machine has left over
  settings.streaming_budget_ms = 1e9;
  settings.streaming_ticks = 1;
  return settings;
}

inline world::World paper_world(const models::Registry& registry) {
  auto world = world::load_world(source_file("game/worlds/paper.toml"), registry);
  EXPECT_TRUE(world) << world.error().message;
  return *world;
}

inline std::unique_ptr<Scene> make_scene(const world::World& world, const Settings& settings,
                                         models::Registry registry) {
  auto scene = Scene::create(world, std::move(registry), settings, nullptr);
  EXPECT_TRUE(scene) << scene.error().message;
  return std::move(*scene);
}

// The paper's world with some things changed.
template <class Change>
std::unique_ptr<Scene> make_scene_of(const Settings& settings, const Change& change) {
  models::Registry registry = models::make_standard_registry();
  world::World world = paper_world(registry);
  change(world);
  return make_scene(world, settings, std::move(registry));
}

inline std::unique_ptr<Scene> make_scene(
    const Settings& settings, models::Registry registry = models::make_standard_registry()) {
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

// One tick; what it asks for may arrive in a later one.
inline void tick_at(Scene& scene, const core::CameraPose& pose) {
  State& state = scene.state();
  state.input.pose = pose;
  tick(state);
  state.clock.now_s += 1.0 / 60.0;
}

inline void expect_within_budget(const Scene& scene) {
  const synthesis::CacheStats stats = scene.state().meshes.stats();
  EXPECT_LE(stats.peak_bytes, stats.budget_bytes);
  EXPECT_LE(scene.state().memory->used_bytes(), stats.budget_bytes);
}

// What the last tick drew is alive in the cache.
inline void expect_drawn_alive(const Scene& scene) {
  const State& s = scene.state();
  if (s.draws.tick + 1 != s.clock.tick) return;  // the last tick drew nothing
  std::set<std::uint32_t> alive;
  std::size_t wrong = 0;
  for (const synthesis::MeshHandle handle : s.draws.meshes) {
    const synthesis::MeshRecord* record = s.meshes.get(handle);
    if (record != nullptr && record->state == synthesis::MeshState::kReady)
      alive.insert(record->range.id);
    else
      ++wrong;
  }
  for (const render::MeshDraw& draw : s.draws.models)
    wrong += alive.contains(draw.range.id) ? 0 : 1;
  EXPECT_EQ(wrong, 0u);
}

// Whatever an entity draws is alive in the cache, and is what the entity thinks it is.
inline void expect_consistent(Scene& scene) {
  const synthesis::MeshSupply& supply = scene.state().meshes;
  std::size_t wrong = 0;
  std::as_const(scene.state().entities)
      .each<const Demand, const Mesh, const Detail, const Source>(
          [&](std::span<const ecs::Entity>, std::span<const Demand> demands,
              std::span<const Mesh> meshes, std::span<const Detail> details,
              std::span<const Source> sources) {
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
