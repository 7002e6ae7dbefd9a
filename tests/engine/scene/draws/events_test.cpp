// Events of nodes, models and meshes reach the systems of a game, each event once.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "engine/scene/state.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

// The state that follows from events alone.
struct Watched {
  const ecs::World* entities = nullptr;
  std::set<visibility::NodeCoord> shown;
  std::set<std::uint64_t> models;                      // entities
  std::map<std::uint64_t, synthesis::MeshKey> meshes;  // by entity
  std::size_t wrong = 0, events = 0;
  std::size_t lost = 0;  // meshes that were evicted while their entity drew them
};

template <class Event, class F>
void drain(ecs::EventReader<Event>& reader, Watched& seen, const F& f) {
  reader.drain([&](std::span<const Event> events) {
    seen.events += events.size();
    for (const Event& event : events)
      seen.wrong += f(event) ? 0 : 1;
  });
}

Watched& add_watchers(Systems systems) {
  Watched& all = systems.resource<Watched>();
  all.entities = &systems.entities;
  systems.frame.add("watch nodes", [](Watched& seen, ecs::EventReader<NodeHidden>& hidden,
                                      ecs::EventReader<NodeShown>& shown) {
    drain(hidden, seen, [&](const NodeHidden& e) { return seen.shown.erase(e.at) == 1; });
    drain(shown, seen, [&](const NodeShown& e) { return seen.shown.insert(e.at).second; });
  });
  systems.frame.add("watch models", [](Watched& seen, ecs::EventReader<ModelCreated>& created,
                                       ecs::EventReader<ModelRemoved>& removed) {
    drain(created, seen,
          [&](const ModelCreated& e) { return seen.models.insert(owner_of(e.entity)).second; });
    drain(removed, seen,
          [&](const ModelRemoved& e) { return seen.models.erase(owner_of(e.entity)) == 1; });
  });
  systems.frame.add("watch meshes", [](Watched& seen, ecs::EventReader<MeshEvicted>& evicted,
                                       ecs::EventReader<MeshReady>& landed) {
    drain(evicted, seen, [&](const MeshEvicted& e) {
      const auto known = seen.meshes.find(owner_of(e.entity));
      if (known == seen.meshes.end() || known->second != e.key) return true;
      seen.meshes.erase(known);
      seen.lost += seen.entities->alive(e.entity) ? 1 : 0;
      return true;
    });
    drain(landed, seen, [&](const MeshReady& e) {
      seen.meshes.insert_or_assign(owner_of(e.entity), e.key);
      return true;
    });
  });
  return all;
}

// Flies until nodes have appeared and vanished several times; after each tick the events match the
// scene.
TEST(Events, MatchTheStateOfTheScene) {
  SceneSettings settings = small_settings();
  settings.budget_bytes = 6ull << 20;
  auto scene = make_scene(settings);
  const Watched& seen = add_watchers(scene->systems());
  State& state = state_of(*scene);
  state.input.pose = pose_at(256, 256);
  for (int i = 0; i < 120; ++i) {
    tick_at(*scene, pose_at(256 + i / 6, 256, 0.05 * i));
    const std::set<visibility::NodeCoord> shown(state.draws.shown_nodes.begin(),
                                                state.draws.shown_nodes.end());
    ASSERT_EQ(seen.shown, shown) << i;
    std::size_t models = 0;
    state.entities.each<const Fading, const MeshSource>(
        [&](std::span<const ecs::Entity> rows, auto, std::span<const MeshSource> sources) {
          for (std::size_t k = 0; k < rows.size(); ++k) {
            if (sources[k].index == kMergedIndex) continue;
            ++models;
            ASSERT_TRUE(seen.models.contains(owner_of(rows[k])));
          }
        });
    ASSERT_EQ(seen.models.size(), models) << i;
    state.entities.each<const Mesh, const MeshDemand>([&](std::span<const ecs::Entity> rows,
                                                          std::span<const Mesh> meshes,
                                                          std::span<const MeshDemand> demands) {
      for (std::size_t k = 0; k < rows.size(); ++k) {
        const auto known = seen.meshes.find(owner_of(rows[k]));
        // MeshReady is emitted only for meshes that their entities use.
        ASSERT_EQ(known == seen.meshes.end(), demands[k].drawn_level == kNoLevel) << i;
        if (demands[k].drawn_level == kNoLevel) continue;
        ASSERT_EQ(known->second, state.supply.get(meshes[k].handle)->key);
      }
    });
  }
  EXPECT_EQ(seen.wrong, 0U);
  EXPECT_GT(seen.events, 1000U);
  EXPECT_GT(seen.lost, 0U);
}

TEST(Events, WithoutReadersAreNotKept) {
  SceneSettings settings = small_settings();
  settings.budget_bytes = 12ull << 20;
  auto scene = make_scene(settings);
  const auto place = scene->request_place(pose_at(256, 256).position, 20);
  ASSERT_TRUE(place) << place.error().message;
  std::uint64_t evictions = 0;
  for (int i = 0; i < 60; ++i) {
    state_of(*scene).supply.wait();
    tick_at(*scene, pose_at(256 + i / 3, 256));
    evictions += state_of(*scene).telemetry.record.cache_evictions;
  }
  EXPECT_GT(evictions, 0U);
  EXPECT_TRUE(state_of(*scene).meshes.places.places.front().told);
  const Events& events = state_of(*scene).events;
  EXPECT_EQ(events.shown.size(), 0U);
  EXPECT_EQ(events.hidden.size(), 0U);
  EXPECT_EQ(events.created.size(), 0U);
  EXPECT_EQ(events.removed.size(), 0U);
  EXPECT_EQ(events.ready.size(), 0U);
  EXPECT_EQ(events.evicted.size(), 0U);
  EXPECT_EQ(events.places_ready.size(), 0U);
  EXPECT_TRUE(state_of(*scene).shown.nodes.empty());
}

}  // namespace
}  // namespace psygen::scene
