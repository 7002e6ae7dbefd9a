// A requested place becomes ready while the camera is elsewhere.
#include "engine/scene/meshes/requested_places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

const core::CameraPose kHere = pose_at(256, 256), kThere = pose_at(290, 240);

std::vector<PlaceId> drain(ecs::EventReader<PlaceReady>& ready) {
  std::vector<PlaceId> ids;
  ready.drain([&ids](std::span<const PlaceReady> events) {
    for (const PlaceReady& event : events)
      ids.push_back(event.id);
  });
  return ids;
}

// Ticks until the place is ready, at most `most`.
int ticks_until_ready(Scene& scene, PlaceId id, int most) {
  int ticks = 0;
  while (!scene.readiness(id).ready() && ticks++ < most) {
    tick_at(scene, kHere);
    state_of(scene).supply.wait();
  }
  return ticks;
}

TEST(RequestedPlaces, APlaceThatIsNotRequestedReportsItsMissingMeshes) {
  auto scene = make_scene(small_settings());
  scene->settle(kHere);
  tick_at(*scene, kHere);
  const auto here = scene->readiness(kHere.position, 60);
  const auto there = scene->readiness(kThere.position, 60);
  ASSERT_TRUE(here);
  ASSERT_TRUE(there);
  EXPECT_GT(there->meshes, 63U);
  EXPECT_EQ(there->missing, there->meshes);
  EXPECT_GT(there->expected_s, 0.0);
  EXPECT_LT(here->missing, here->meshes);
}

TEST(RequestedPlaces, ARequestedPlaceBecomesReadyAndAJumpThereIsComplete) {
  auto scene = make_scene(small_settings());
  State& state = state_of(*scene);
  ecs::EventReader<PlaceReady> ready = state.events.places_ready.reader();
  scene->settle(kHere);
  tick_at(*scene, kHere);
  const auto id = scene->request_place(kThere.position, 60);
  ASSERT_TRUE(id) << id.error().message;
  EXPECT_FALSE(scene->readiness(*id).ready());
  EXPECT_TRUE(drain(ready).empty());
  EXPECT_LT(ticks_until_ready(*scene, *id, 500), 500);
  EXPECT_EQ(drain(ready), std::vector{*id});
  EXPECT_EQ(scene->readiness(*id).expected_s, 0.0);
  const auto again = scene->readiness(kThere.position, 60);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->missing, 0U);
  tick_at(*scene, kHere);
  EXPECT_EQ(state.meshes.counts.requests, 0U) << "nothing is asked for any more";
  EXPECT_TRUE(drain(ready).empty()) << "told once";
  // Near meshes are drawn as wanted at once, from the cache.
  tick_at(*scene, kThere);
  tick_at(*scene, kThere);
  EXPECT_EQ(state.draws.counts.holes, 0U);
  std::size_t near = 0;
  state.entities.each<const MeshPlacement, const MeshDemand, const MeshSource>(
      [&](auto, std::span<const MeshPlacement> placed, std::span<const MeshDemand> demands,
          std::span<const MeshSource> sources) {
        for (std::size_t i = 0; i < placed.size(); ++i) {
          const bool model = sources[i].index < kMergedIndex;
          if (!model || placed[i].block != kThere.position.block) continue;
          ++near;
          EXPECT_EQ(demands[i].drawn_level, demands[i].wanted_level);
        }
      });
  EXPECT_EQ(near, 63U);
  expect_within_budget(*scene);
}

// Far trees are drawn as impostors there, so their quads are requested.
void expect_place_asks_for_what_is_drawn(bool near_detail) {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 400;
  settings.max_error_pixels = 13;
  auto scene = make_scene(settings);
  State& state = state_of(*scene);
  state.facts.near_detail = near_detail;
  scene->settle(kHere);
  tick_at(*scene, kHere);
  ASSERT_TRUE(scene->request_place(kThere.position, 400));
  std::vector<synthesis::MeshKey> asked;
  for (const RequestedMesh& mesh : state.meshes.places.places[0].meshes)
    asked.push_back(mesh.key);
  scene->settle(kThere);
  tick_at(*scene, kThere);
  std::size_t pictures = 0, others = 0;
  state.entities.each<const MeshPlacement, const MeshDemand, const LodErrors, const MeshSource>(
      [&](auto, std::span<const MeshPlacement> placed, std::span<const MeshDemand> demands,
          std::span<const LodErrors> details, std::span<const MeshSource> sources) {
        for (std::size_t i = 0; i < demands.size(); ++i) {
          const MeshDemand& demand = demands[i];
          if (demand.in_view_tick + 1 != state.clock.tick || demand.drawn_level == kNoLevel)
            continue;
          if (sources[i].index >= kMergedIndex) continue;
          const auto key = key_of(placed[i], details[i], sources[i], demand.drawn_level);
          EXPECT_TRUE(std::ranges::find(asked, key) != asked.end());
          ++(demand.pictured ? pictures : others);
        }
      });
  EXPECT_GT(pictures, 5U);
  EXPECT_GT(others, 5U);
}

TEST(RequestedPlaces, APlaceRequestsTheMeshesThatACameraThereDraws) {
  expect_place_asks_for_what_is_drawn(false);
}
TEST(RequestedPlaces, APlaceRequestsCoarserTreesIfNearOnesHaveGaps) {
  expect_place_asks_for_what_is_drawn(true);
}

TEST(RequestedPlaces, RequestedMeshesAreKeptAndReleasedOnesMayBeEvicted) {
  SceneSettings settings = small_settings();
  settings.budget_bytes = 10ull << 20;
  auto scene = make_scene(settings);
  State& state = state_of(*scene);
  scene->settle(kHere);
  tick_at(*scene, kHere);
  const auto id = scene->request_place(kThere.position, 40);
  ASSERT_TRUE(id) << id.error().message;
  EXPECT_LT(ticks_until_ready(*scene, *id, 500), 500);
  // The camera turns and walks: its new meshes would evict unwanted ones.
  const auto walk = [&](int from_block) {
    const std::uint64_t before = state.supply.stats().evictions;
    for (int i = 0; i < 60; ++i) {
      tick_at(*scene, pose_at(from_block - i / 10, 256, 0.1 * i));
      state.supply.wait();
    }
    EXPECT_GT(state.supply.stats().evictions, before);
  };
  walk(256);
  EXPECT_TRUE(scene->readiness(*id).ready());
  expect_within_budget(*scene);
  scene->release_place(*id);
  scene->release_place(*id);  // is ignored
  EXPECT_TRUE(state.meshes.places.places.empty());
  walk(250);
  EXPECT_GT(scene->readiness(kThere.position, 40)->missing, 0U);
}

// Expects that no mesh of a camera there is missing.
void expect_there(const Scene& scene, PlaceId id, double radius_m) {
  ASSERT_TRUE(scene.readiness(id).ready());
  const auto afresh = scene.readiness(kThere.position, radius_m);
  ASSERT_TRUE(afresh);
  EXPECT_EQ(afresh->missing, 0U);
  EXPECT_EQ(afresh->meshes, scene.readiness(id).meshes);
}

TEST(RequestedPlaces, APlaceRequestedBeforeTheFirstTickHasTheRightMeshes) {
  auto scene = make_scene(small_settings());
  const PlaceId id = scene->request_place(kThere.position, 60).value();
  const std::uint32_t meshes = scene->readiness(id).meshes;
  tick_at(*scene, kHere);
  EXPECT_EQ(scene->readiness(kThere.position, 60)->meshes, meshes);
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  expect_there(*scene, id, 60);
}

TEST(RequestedPlaces, ARequestedPlaceFollowsTheSizeOfTheFrame) {
  auto scene = make_scene(small_settings());
  State& state = state_of(*scene);
  const PlaceId id = scene->request_place(kThere.position, 60).value();
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  state.input.size = {state.input.size.width * 4, state.input.size.height * 4};
  tick_at(*scene, kHere);
  EXPECT_FALSE(scene->readiness(id).ready()) << "finer levels are needed now";
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  expect_there(*scene, id, 60);
}

TEST(RequestedPlaces, ARequestedPlaceFollowsTheSun) {
  auto scene =
      make_scene_of(small_settings(), [](world::World& world) { world.sky.day_length_s = 60; });
  State& state = state_of(*scene);
  scene->settle(kHere);
  tick_at(*scene, kHere);
  const PlaceId id = scene->request_place(kThere.position, 60).value();
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  const Daylight before = state.daylight;
  state.clock.now_s += 10;
  tick_at(*scene, kHere);
  ASSERT_NE(state.daylight.elevation_deg, before.elevation_deg);
  EXPECT_FALSE(scene->readiness(id).ready()) << "the ground is lit otherwise now";
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  expect_there(*scene, id, 60);
}

TEST(RequestedPlaces, ARequestedPlaceHasTheModelsThatEditsPlaceThere) {
  auto scene = make_scene(small_settings());
  State& state = state_of(*scene);
  scene->settle(kHere);
  tick_at(*scene, kHere);
  const PlaceId id = scene->request_place(kThere.position, 60).value();
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  const std::uint32_t meshes = scene->readiness(id).meshes;
  const world::Scatter& rocks = state.facts.world.scatter[1];
  const models::Parameters rock = world::scatter_parameters(state.facts.registry, rocks);
  world::Edits edits;
  ASSERT_TRUE(edits.place(state.facts.world, state.facts.registry,
                          {rocks.model, rock, kThere.position, 0}));
  scene->edit(std::move(edits));
  tick_at(*scene, kHere);
  EXPECT_EQ(scene->readiness(id).meshes, meshes + 1);
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  expect_there(*scene, id, 60);
}

// Raises the ground at the place by some metres.
world::Edits raised(const State& state) {
  world::Edits edits;
  EXPECT_TRUE(edits.raise(state.facts.world, kThere.position, 8, 3));
  return edits;
}

std::vector<synthesis::MeshKey> keys_of(const State& state) {
  std::vector<synthesis::MeshKey> keys;
  for (const RequestedMesh& mesh : state.meshes.places.places.at(0).meshes)
    keys.push_back(mesh.key);
  return keys;
}

TEST(RequestedPlaces, EditsThatCancelOutLeaveTheMeshesOfARequestedPlace) {
  auto scene = make_scene(small_settings());
  State& state = state_of(*scene);
  scene->settle(kHere);
  tick_at(*scene, kHere);
  const PlaceId id = scene->request_place(kThere.position, 60).value();
  const std::vector<synthesis::MeshKey> before = keys_of(state);
  scene->edit(raised(state));
  tick_at(*scene, kHere);
  EXPECT_NE(keys_of(state), before);
  scene->edit({});
  tick_at(*scene, kHere);
  EXPECT_EQ(keys_of(state), before);
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  expect_there(*scene, id, 60);
}

TEST(RequestedPlaces, AnEditDuringSettlingReachesARequestedPlaceInTheNextTick) {
  auto scene = make_scene(small_settings());
  State& state = state_of(*scene);
  tick_at(*scene, kHere);
  const PlaceId id = scene->request_place(kThere.position, 60).value();
  const std::vector<synthesis::MeshKey> before = keys_of(state);
  scene->edit(raised(state));
  scene->settle(kHere);
  EXPECT_EQ(keys_of(state), before) << "settling updates no places";
  tick_at(*scene, kHere);
  EXPECT_NE(keys_of(state), before);
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  expect_there(*scene, id, 60);
}

TEST(RequestedPlaces, AnInvalidOrTooLargePlaceIsRejected) {
  SceneSettings settings = small_settings();
  settings.budget_bytes = 8ull << 20;
  auto scene = make_scene(settings);
  State& state = state_of(*scene);
  tick_at(*scene, kHere);
  core::WorldPosition nowhere = kThere.position;
  nowhere.local.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(scene->request_place(nowhere, 10).error().message,
            "the position of a place is not finite");
  for (const double radius_m : {0.0, -1.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(scene->readiness(kThere.position, radius_m).error().message,
              "the radius of a place must be above 0 and at most 1000 m");
  }
  const auto large = scene->request_place(kThere.position, 1000);
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, core::ErrorCode::kOverBudget);
  EXPECT_TRUE(state.meshes.places.places.empty());
}

TEST(RequestedPlaces, APlaceOutsideTheWorldNeedsNoMeshes) {
  auto scene = make_scene(small_settings());
  tick_at(*scene, kHere);
  const auto outside = scene->readiness(pose_at(-100, -100).position, 60);
  ASSERT_TRUE(outside);
  EXPECT_EQ(outside->meshes, 0U);
  EXPECT_TRUE(outside->ready());
}

}  // namespace
}  // namespace psygen::scene
