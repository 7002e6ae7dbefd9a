// A place that is asked for becomes ready while the camera is elsewhere.
#include "engine/scene/readiness.hpp"

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

// Ticks until the place is ready, at most so many.
int ticks_until_ready(Scene& scene, PlaceId id, int most) {
  int ticks = 0;
  while (!readiness(scene.state(), id).ready() && ticks++ < most) {
    tick_at(scene, kHere);
    scene.state().meshes.wait();
  }
  return ticks;
}

TEST(Readiness, APlaceNobodyAskedForIsNotReadyAndSaysHowLongItTakes) {
  auto scene = make_scene(small_settings());
  scene->settle(kHere);
  tick_at(*scene, kHere);
  const auto here = readiness(scene->state(), kHere.position, 60);
  const auto there = readiness(scene->state(), kThere.position, 60);
  ASSERT_TRUE(here);
  ASSERT_TRUE(there);
  EXPECT_GT(there->meshes, 63U);
  EXPECT_EQ(there->missing, there->meshes);
  EXPECT_GT(there->expected_s, 0.0);
  EXPECT_LT(here->missing, here->meshes);
}

TEST(Readiness, AnAskedForPlaceBecomesReadyAndAJumpThereFindsItAll) {
  auto scene = make_scene(small_settings());
  State& state = scene->state();
  ecs::EventReader<PlaceReady> ready = state.events.places_ready.reader();
  scene->settle(kHere);
  tick_at(*scene, kHere);
  const auto id = ask_ready(state, kThere.position, 60);
  ASSERT_TRUE(id) << id.error().message;
  EXPECT_FALSE(readiness(state, *id).ready());
  EXPECT_TRUE(drain(ready).empty());
  EXPECT_LT(ticks_until_ready(*scene, *id, 500), 500);
  EXPECT_EQ(drain(ready), std::vector{*id});
  EXPECT_EQ(readiness(state, *id).expected_s, 0.0);
  const auto again = readiness(state, kThere.position, 60);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->missing, 0U);
  tick_at(*scene, kHere);
  EXPECT_EQ(state.counters.requests, 0U) << "nothing is asked for any more";
  EXPECT_TRUE(drain(ready).empty()) << "told once";
  // What is near is drawn as it should be at once, from the cache.
  tick_at(*scene, kThere);
  tick_at(*scene, kThere);
  EXPECT_EQ(state.counters.holes, 0U);
  std::size_t near = 0;
  state.entities.each<const Placed, const Demand, const Source>(
      [&](auto, std::span<const Placed> placed, std::span<const Demand> demands,
          std::span<const Source> sources) {
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

// Far trees are drawn as pictures there, so their quads are what is asked for.
void expect_place_asks_for_what_is_drawn(bool near_detail) {
  Settings settings = small_settings();
  settings.view_distance_m = 400;
  settings.max_error_pixels = 13;
  auto scene = make_scene(settings);
  State& state = scene->state();
  state.facts.near_detail = near_detail;
  scene->settle(kHere);
  tick_at(*scene, kHere);
  ASSERT_TRUE(ask_ready(state, kThere.position, 400));
  std::vector<synthesis::MeshKey> asked;
  for (const Foresight::Mesh& mesh : state.foresight.places[0].meshes)
    asked.push_back(mesh.key);
  scene->settle(kThere);
  tick_at(*scene, kThere);
  std::size_t pictures = 0, others = 0;
  state.entities.each<const Placed, const Demand, const Detail, const Source>(
      [&](auto, std::span<const Placed> placed, std::span<const Demand> demands,
          std::span<const Detail> details, std::span<const Source> sources) {
        for (std::size_t i = 0; i < demands.size(); ++i) {
          const Demand& demand = demands[i];
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

TEST(Readiness, APlaceAsksForTheMeshesThatACameraThereDraws) {
  expect_place_asks_for_what_is_drawn(false);
}
TEST(Readiness, APlaceAsksForTheCoarserTreesWhereNearOnesHaveGaps) {
  expect_place_asks_for_what_is_drawn(true);
}

TEST(Readiness, WhatIsAskedForIsKeptAndOtherwiseItMayGo) {
  Settings settings = small_settings();
  settings.budget_bytes = 10ull << 20;
  auto scene = make_scene(settings);
  State& state = scene->state();
  scene->settle(kHere);
  tick_at(*scene, kHere);
  const auto id = ask_ready(state, kThere.position, 40);
  ASSERT_TRUE(id) << id.error().message;
  EXPECT_LT(ticks_until_ready(*scene, *id, 500), 500);
  // The camera turns and walks: what it wants next would take the room of what nobody wants.
  const auto walk = [&](int from_block) {
    const std::uint64_t before = state.meshes.stats().evictions;
    for (int i = 0; i < 60; ++i) {
      tick_at(*scene, pose_at(from_block - i / 10, 256, 0.1 * i));
      state.meshes.wait();
    }
    EXPECT_GT(state.meshes.stats().evictions, before);
  };
  walk(256);
  EXPECT_TRUE(readiness(state, *id).ready());
  expect_within_budget(*scene);
  stop_asking(state, *id);
  stop_asking(state, *id);  // is ignored
  EXPECT_TRUE(state.foresight.places.empty());
  walk(250);
  EXPECT_GT(readiness(state, kThere.position, 40)->missing, 0U);
}

// Nothing that a camera there would ask for is missing.
void expect_there(const State& state, PlaceId id, double radius_m) {
  ASSERT_TRUE(readiness(state, id).ready());
  const auto afresh = readiness(state, kThere.position, radius_m);
  ASSERT_TRUE(afresh);
  EXPECT_EQ(afresh->missing, 0U);
  EXPECT_EQ(afresh->meshes, readiness(state, id).meshes);
}

TEST(Readiness, APlaceAskedForBeforeTheFirstTickHasWhatTheCameraWillNeed) {
  auto scene = make_scene(small_settings());
  State& state = scene->state();
  const PlaceId id = ask_ready(state, kThere.position, 60).value();
  const std::uint32_t meshes = readiness(state, id).meshes;
  tick_at(*scene, kHere);
  EXPECT_EQ(readiness(state, kThere.position, 60)->meshes, meshes);
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  expect_there(state, id, 60);
}

TEST(Readiness, AnAskedForPlaceFollowsTheSizeOfThePicture) {
  auto scene = make_scene(small_settings());
  State& state = scene->state();
  const PlaceId id = ask_ready(state, kThere.position, 60).value();
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  state.input.size = {state.input.size.width * 4, state.input.size.height * 4};
  tick_at(*scene, kHere);
  EXPECT_FALSE(readiness(state, id).ready()) << "finer levels are needed now";
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  expect_there(state, id, 60);
}

TEST(Readiness, AnAskedForPlaceFollowsTheSun) {
  auto scene =
      make_scene_of(small_settings(), [](world::World& world) { world.sky.day_length_s = 60; });
  State& state = scene->state();
  scene->settle(kHere);
  tick_at(*scene, kHere);
  const PlaceId id = ask_ready(state, kThere.position, 60).value();
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  const Daylight before = state.daylight;
  state.clock.now_s += 10;
  tick_at(*scene, kHere);
  ASSERT_NE(state.daylight.elevation_deg, before.elevation_deg);
  EXPECT_FALSE(readiness(state, id).ready()) << "the ground is lit otherwise now";
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  expect_there(state, id, 60);
}

TEST(Readiness, AnAskedForPlaceHasTheModelsThatEditsPlaceThere) {
  auto scene = make_scene(small_settings());
  State& state = scene->state();
  scene->settle(kHere);
  tick_at(*scene, kHere);
  const PlaceId id = ask_ready(state, kThere.position, 60).value();
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  const std::uint32_t meshes = readiness(state, id).meshes;
  const world::Scatter& rocks = state.facts.world.scatter[1];
  const models::Parameters rock = world::scatter_parameters(state.facts.registry, rocks);
  world::Edits edits;
  ASSERT_TRUE(edits.place(state.facts.world, state.facts.registry,
                          {rocks.model, rock, kThere.position, 0}));
  scene->edit(std::move(edits));
  tick_at(*scene, kHere);
  EXPECT_EQ(readiness(state, id).meshes, meshes + 1);
  EXPECT_LT(ticks_until_ready(*scene, id, 500), 500);
  expect_there(state, id, 60);
}

TEST(Readiness, APlaceThatIsNoneOrTooLargeIsRefused) {
  Settings settings = small_settings();
  settings.budget_bytes = 8ull << 20;
  auto scene = make_scene(settings);
  State& state = scene->state();
  tick_at(*scene, kHere);
  core::WorldPosition nowhere = kThere.position;
  nowhere.local.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ask_ready(state, nowhere, 10).error().message, "the position of a place is not finite");
  for (const double radius_m : {0.0, -1.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(readiness(state, kThere.position, radius_m).error().message,
              "the radius of a place must be above 0 and at most 1000 m");
  }
  const auto large = ask_ready(state, kThere.position, 1000);
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, core::ErrorCode::kOverBudget);
  EXPECT_TRUE(state.foresight.places.empty());
}

TEST(Readiness, OutsideOfTheWorldThereIsNothingToWaitFor) {
  auto scene = make_scene(small_settings());
  tick_at(*scene, kHere);
  const auto outside = readiness(scene->state(), pose_at(-100, -100).position, 60);
  ASSERT_TRUE(outside);
  EXPECT_EQ(outside->meshes, 0U);
  EXPECT_TRUE(outside->ready());
}

}  // namespace
}  // namespace psygen::scene
