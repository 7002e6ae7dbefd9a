#include "engine/scene/fading.hpp"

#include <map>

#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

constexpr float kQuarter = 0.25F;

Mesh mesh_of(std::uint32_t slot) {
  Mesh mesh;
  mesh.handle = {slot, 1};
  mesh.range.id = slot;
  return mesh;
}

TEST(Fading, WhatComesIntoViewIsThereAndWhatAppearsComesInSteps) {
  Fading entering, appearing;
  EXPECT_EQ(come(entering, {1, kQuarter}, false), 1.0F);
  for (std::uint32_t tick = 1; tick <= 6; ++tick) {
    const float expected = std::min(1.0F, static_cast<float>(tick) * kQuarter);
    EXPECT_EQ(come(appearing, {tick, kQuarter}, tick == 1), expected);
  }
  // Away for a tick: it is new again.
  EXPECT_EQ(come(appearing, {8, kQuarter}, true), kQuarter);
}

TEST(Fading, WhatTurnsRoundGoesFromWhereItWas) {
  Fading fading;
  come(fading, {1, kQuarter}, false);
  EXPECT_EQ(go(fading, {2, kQuarter}), 0.75F);
  EXPECT_EQ(go(fading, {3, kQuarter}), 0.5F);
  EXPECT_EQ(come(fading, {4, kQuarter}, true), 0.75F);
  EXPECT_EQ(go(fading, {5, kQuarter}), 0.5F);
  EXPECT_EQ(go(fading, {6, kQuarter}), 0.25F);
  EXPECT_EQ(go(fading, {7, kQuarter}), 0.0F);
  EXPECT_EQ(go(fading, {8, kQuarter}), 0.0F);
  EXPECT_EQ(go(fading, {9, kQuarter}), 0.0F) << "what was not drawn does not come back to go";
}

TEST(Fading, AMeshThatReplacesAnotherTakesItsPixelsOver) {
  Fading fading;
  come(fading, {1, kQuarter}, false);
  replace_mesh(fading, mesh_of(7));
  EXPECT_EQ(come(fading, {2, kQuarter}, false), kQuarter);
  EXPECT_EQ(fading.old_range.id, 7u);
  EXPECT_TRUE(fading.old_mesh);
  for (std::uint32_t tick = 3; tick <= 5; ++tick)
    come(fading, {tick, kQuarter}, false);
  EXPECT_EQ(fading.share, 1.0F);
  EXPECT_FALSE(fading.old_mesh) << "taken over";
}

TEST(Fading, OfThreeMeshesInTurnTheOneThatIsSeenMostGoes) {
  for (const bool late : {false, true}) {
    Fading fading;
    come(fading, {1, kQuarter}, false);
    replace_mesh(fading, mesh_of(1));
    come(fading, {2, kQuarter}, false);
    if (late) come(fading, {3, 0.5F}, false);
    replace_mesh(fading, mesh_of(2));
    EXPECT_EQ(fading.old_range.id, late ? 2u : 1u);
    EXPECT_EQ(fading.share, late ? 0.0F : kQuarter);
  }
  Fading appearing;  // nothing was there before the first mesh
  come(appearing, {1, kQuarter}, true);
  replace_mesh(appearing, mesh_of(1));
  EXPECT_FALSE(appearing.old_mesh);
  EXPECT_EQ(come(appearing, {2, kQuarter}, false), 0.5F);
}

TEST(Fading, WhatIsReplacedOutOfViewLeavesNothingBehind) {
  Fading fading;
  come(fading, {1, kQuarter}, false);
  replace_mesh(fading, mesh_of(1));
  EXPECT_EQ(come(fading, {5, kQuarter}, false), 1.0F);
  EXPECT_FALSE(fading.old_mesh);
}

using visibility::NodeCoord;

std::vector<NodeCoord> going(NodeHandover& handover, bool stay = true) {
  std::vector<NodeCoord> nodes;
  handover.for_each_going([&](const NodeCoord& node) {
    nodes.push_back(node);
    return stay;
  });
  return nodes;
}

TEST(NodeHandover, NodesThatAreSplitOrMergedTakeEachOthersPlace) {
  const NodeCoord parent{{-2, 3}, 4}, other{{5, 5}, 4};
  const NodeCoord child = child_of(parent, 2), grandchild = child_of(child, 1);
  NodeHandover handover;
  handover.update(std::array{parent, other}, true);
  EXPECT_TRUE(handover.is_fresh(parent));
  EXPECT_FALSE(handover.replaces(parent)) << "there was nothing before it";
  handover.update(std::array{other, grandchild}, true);
  EXPECT_TRUE(handover.replaces(grandchild)) << "two levels below";
  EXPECT_FALSE(handover.is_fresh(other));
  EXPECT_EQ(going(handover), std::vector{parent});
  handover.update(std::array{parent, other}, true);
  EXPECT_TRUE(handover.replaces(parent)) << "back again";
  EXPECT_EQ(going(handover), std::vector{grandchild});
  handover.update(std::array{parent, other}, true);
  EXPECT_FALSE(handover.is_fresh(parent));
  EXPECT_EQ(going(handover, false), std::vector{grandchild}) << "it was kept until it is gone";
  EXPECT_TRUE(going(handover).empty());
}

TEST(NodeHandover, WhatEntersTheViewReplacesNothing) {
  const NodeCoord left{{1, 1}, 2}, right{{2, 1}, 2};
  NodeHandover handover;
  handover.update(std::array{left}, true);
  handover.update(std::array{right}, true);
  EXPECT_TRUE(handover.is_fresh(right));
  EXPECT_FALSE(handover.replaces(right));
}

TEST(NodeHandover, ALeapOfTheCameraEndsAllThatWasGoing) {
  const NodeCoord parent{{1, 1}, 2}, child = child_of(parent, 0);
  NodeHandover handover;
  handover.update(std::array{parent}, true);
  handover.update(std::array{child}, false);
  EXPECT_TRUE(handover.is_fresh(child));
  EXPECT_FALSE(handover.replaces(child));
  EXPECT_TRUE(going(handover).empty());
}

// ---- In a scene --------------------------------------------------------------------------------

struct Seen {
  std::size_t coming = 0, going = 0;
};

// Of all draws: what goes at a place goes there at the pace of what comes.
Seen count_fading(const Scene& scene) {
  Seen seen;
  std::map<std::pair<float, float>, std::vector<float>> at;
  for (const render::MeshDraw& draw : scene.state().draws.models) {
    EXPECT_GT(draw.fade, -1.0F);
    EXPECT_LE(draw.fade, 1.0F);
    if (draw.fade < 1 && draw.fade > 0) ++seen.coming;
    if (draw.fade <= 0) ++seen.going;
    if (draw.fade < 1) at[{draw.origin.x, draw.origin.z}].push_back(draw.fade);
  }
  for (const auto& [place, fades] : at) {
    if (fades.size() == 2 && (fades[0] > 0) != (fades[1] > 0)) {
      EXPECT_EQ(fades[0], -fades[1]);
    }
  }
  return seen;
}

TEST(FadingScene, OnAFlightModelsFadeAndWhenItEndsAllAreThere) {
  Settings settings = small_settings();
  settings.view_distance_m = 600;
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(256, 256);
  scene->settle(pose);
  tick_at(*scene, pose);
  Seen seen = count_fading(*scene);
  EXPECT_EQ(seen.coming + seen.going, 0u) << "after settling everything is there";
  std::size_t coming = 0, going = 0;
  for (int i = 0; i < 90; ++i) {
    pose.position.local.z -= 0.8;
    tick_at(*scene, pose);
    scene->state().synthesis.manager->wait_all();
    seen = count_fading(*scene);
    coming += seen.coming;
    going += seen.going;
    expect_consistent(*scene);
  }
  EXPECT_GT(coming, 500u);
  EXPECT_GT(going, 200u);
  for (int i = 0; i < 60; ++i) {
    tick_at(*scene, pose);
    scene->state().synthesis.manager->wait_all();
  }
  seen = count_fading(*scene);
  EXPECT_EQ(seen.coming + seen.going, 0u);
}

TEST(FadingScene, AClockThatStandsStillDoesNotKeepModelsAway) {
  Settings settings = small_settings();
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(256, 256);
  scene->settle(pose);
  std::size_t fading = 0, most = 0;
  for (int i = 0; i < 200; ++i) {
    if (i < 60) pose.position.local.z -= 0.8;
    tick_at(*scene, pose);
    scene->state().clock.now_s = 0;
    scene->state().synthesis.manager->wait_all();
    const Seen seen = count_fading(*scene);
    fading = seen.coming + seen.going;
    most = std::max(most, fading);
  }
  EXPECT_GT(most, 5u);
  EXPECT_EQ(fading, 0u);
}

TEST(FadingScene, WithoutTimeToFadeEverythingComesAndGoesAtOnce) {
  Settings settings = small_settings();
  settings.fade_seconds = 0;
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(256, 256);
  scene->settle(pose);
  for (int i = 0; i < 60; ++i) {
    pose.position.local.z -= 0.8;
    tick_at(*scene, pose);
    scene->state().synthesis.manager->wait_all();
    const Seen seen = count_fading(*scene);
    EXPECT_EQ(seen.coming + seen.going, 0u);
  }
}

// What goes may be evicted at any time; it is not drawn any more then.
TEST(FadingScene, WhatGoesIsNotDrawnWhenItsRoomIsTaken) {
  Settings settings = small_settings();
  settings.view_distance_m = 600;
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(256, 256);
  scene->settle(pose);
  State& s = scene->state();
  s.synthesis.cache->set_budget(s.memory->used_bytes());
  const std::uint64_t evicted = s.synthesis.cache->stats().evictions;
  for (int i = 0; i < 120; ++i) {
    pose.position.local.z -= 0.8;
    tick_at(*scene, pose);
    s.synthesis.manager->wait_all();
    expect_consistent(*scene);
  }
  EXPECT_GT(s.synthesis.cache->stats().evictions, evicted + 100);
}

TEST(FadingScene, TurningTheCameraFadesNothing) {
  Settings settings = small_settings();
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  for (int i = 0; i < 60; ++i) {
    tick_at(*scene, pose_at(256, 256, 0.05 * i));
    scene->state().synthesis.manager->wait_all();
    const Seen seen = count_fading(*scene);
    EXPECT_EQ(seen.coming + seen.going, 0u) << i;
  }
}

}  // namespace
}  // namespace psygen::scene
