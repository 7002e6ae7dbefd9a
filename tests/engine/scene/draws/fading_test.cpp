#include "engine/scene/draws/fading.hpp"

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
  replace_mesh(fading, mesh_of(7), 3, false);
  EXPECT_EQ(come(fading, {2, kQuarter}, false), kQuarter);
  EXPECT_EQ(fading.old_range.id, 7u);
  EXPECT_EQ(fading.old_level, 3);
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
    replace_mesh(fading, mesh_of(1), 3, false);
    come(fading, {2, kQuarter}, false);
    if (late) come(fading, {3, 0.5F}, false);
    replace_mesh(fading, mesh_of(2), 3, false);
    EXPECT_EQ(fading.old_range.id, late ? 2u : 1u);
    EXPECT_EQ(fading.share, late ? 0.0F : kQuarter);
  }
  Fading appearing;  // nothing was there before the first mesh
  come(appearing, {1, kQuarter}, true);
  replace_mesh(appearing, mesh_of(1), 3, false);
  EXPECT_FALSE(appearing.old_mesh);
  EXPECT_EQ(come(appearing, {2, kQuarter}, false), 0.5F);
}

TEST(Fading, WhatGoesWhileItIsReplacedGoesAsAWhole) {
  Fading fading;
  come(fading, {1, kQuarter}, false);
  replace_mesh(fading, mesh_of(1), 3, false);
  EXPECT_EQ(come(fading, {2, kQuarter}, false), kQuarter);
  EXPECT_EQ(go(fading, {3, kQuarter}), 0.75F) << "the old mesh had the other pixels";
  EXPECT_FALSE(fading.old_mesh);
}

TEST(Fading, WhatIsReplacedOutOfViewLeavesNothingBehind) {
  Fading fading;
  come(fading, {1, kQuarter}, false);
  replace_mesh(fading, mesh_of(1), 3, false);
  EXPECT_EQ(come(fading, {5, kQuarter}, false), 1.0F);
  EXPECT_FALSE(fading.old_mesh);
}

// A pattern that moved as far as a fade would give pixels back.
TEST(Fading, ThePatternMovesByHalfOfAFadeAndBeginsAgain) {
  float phase = 0.7F;
  for (const float expected : {0.825F, 0.95F, 0.075F}) {
    phase = next_phase(phase, {1, kQuarter});
    EXPECT_NEAR(phase, expected, 1e-6F);
  }
  EXPECT_LT(next_phase(0.5F, {1, 1.0F}), 1.0F);
}

using visibility::NodeCoord;

// A tick in which these nodes are drawn; returns the ones that were and are no more.
std::vector<NodeCoord> draw(NodeHandover& handover, const std::vector<NodeCoord>& nodes,
                            bool something_left = true, bool continues = true) {
  std::vector<NodeCoord> going;
  handover.update(nodes, continues);
  handover.for_each_going([&](const NodeCoord& node) {
    going.push_back(node);
    return something_left;
  });
  return going;
}

using NodeCoords = std::vector<NodeCoord>;

TEST(NodeHandover, NodesThatAreSplitOrMergedTakeEachOthersPlace) {
  const NodeCoord parent{{-2, 3}, 4}, other{{5, 5}, 4};
  const NodeCoord child = child_of(parent, 2), grandchild = child_of(child, 1);
  NodeHandover handover;
  EXPECT_EQ(draw(handover, {parent, other}), NodeCoords{});
  EXPECT_TRUE(handover.is_fresh(parent));
  EXPECT_FALSE(handover.replaces(parent)) << "there was nothing before it";
  EXPECT_EQ(draw(handover, {other, grandchild}), NodeCoords{parent});
  EXPECT_TRUE(handover.replaces(grandchild)) << "two levels below";
  EXPECT_FALSE(handover.is_fresh(other));
  EXPECT_EQ(draw(handover, {parent, other}), NodeCoords{grandchild});
  EXPECT_TRUE(handover.replaces(parent)) << "back again";
  EXPECT_EQ(draw(handover, {parent, other}, false), NodeCoords{grandchild})
      << "kept until it is gone";
  EXPECT_FALSE(handover.is_fresh(parent));
  EXPECT_EQ(draw(handover, {parent, other}), NodeCoords{});
}

TEST(NodeHandover, WhatEntersTheViewReplacesNothing) {
  const NodeCoord left{{1, 1}, 2}, right{{2, 1}, 2};
  NodeHandover handover;
  draw(handover, {left});
  draw(handover, {right});
  EXPECT_TRUE(handover.is_fresh(right));
  EXPECT_FALSE(handover.replaces(right));
}

TEST(NodeHandover, NothingIsReplacedOfWhichNothingIsLeft) {
  const NodeCoord parent{{1, 1}, 2}, child = child_of(parent, 0);
  NodeHandover handover;
  draw(handover, {parent});
  EXPECT_EQ(draw(handover, {child}, false), NodeCoords{parent});
  EXPECT_FALSE(handover.replaces(child));
}

TEST(NodeHandover, ATickThatDrewNothingEndsAllThatWasGoing) {
  const NodeCoord parent{{1, 1}, 2}, child = child_of(parent, 0);
  NodeHandover handover;
  draw(handover, {parent});
  EXPECT_EQ(draw(handover, {child}, true, false), NodeCoords{});
  EXPECT_TRUE(handover.is_fresh(child));
  EXPECT_FALSE(handover.replaces(child));
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

// Flies forward, so far in each tick, and waits for what each asks for; visit() after each.
template <class Visit>
void fly(Scene& scene, core::CameraPose& pose, int ticks, double step_m, const Visit& visit) {
  for (int i = 0; i < ticks; ++i) {
    pose.position.local.z -= step_m;
    tick_at(scene, pose);
    scene.state().meshes.wait();
    visit(count_fading(scene));
  }
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
  fly(*scene, pose, 90, 0.8, [&](const Seen& now) {
    coming += now.coming;
    going += now.going;
    expect_consistent(*scene);
  });
  EXPECT_GT(coming, 500u);
  EXPECT_GT(going, 200u);
  fly(*scene, pose, 60, 0, [&](const Seen& now) { seen = now; });
  EXPECT_EQ(seen.coming + seen.going, 0u);
}

TEST(FadingScene, ThePatternIsAnotherInEachFrameAndTheSameInTwoScenes) {
  const auto first = make_scene(small_settings()), second = make_scene(small_settings());
  float last = -1;
  for (int i = 0; i < 10; ++i) {
    tick_at(*first, pose_at(256, 256));
    tick_at(*second, pose_at(256, 256));
    const float phase = first->state().draws.fade_phase;
    EXPECT_NE(phase, last);
    EXPECT_EQ(phase, second->state().draws.fade_phase);
    last = phase;
  }
}

TEST(FadingScene, AClockThatStandsStillDoesNotKeepModelsAway) {
  Settings settings = small_settings();
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(256, 256);
  scene->settle(pose);
  std::size_t fading = 0, most = 0;
  const auto stop_clock = [&](const Seen& seen) {
    scene->state().clock.now_s = 0;
    fading = seen.coming + seen.going;
    most = std::max(most, fading);
  };
  fly(*scene, pose, 60, 0.8, stop_clock);
  fly(*scene, pose, 140, 0, stop_clock);
  EXPECT_GT(most, 5u);
  EXPECT_EQ(fading, 0u);
}

TEST(FadingScene, WithoutTimeToFadeEverythingComesAndGoesAtOnce) {
  Settings settings = small_settings();
  settings.fade_seconds = 0;
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(256, 256);
  scene->settle(pose);
  fly(*scene, pose, 60, 0.8, [](const Seen& seen) { EXPECT_EQ(seen.coming + seen.going, 0u); });
}

// What goes may be evicted at any time; it is not drawn any more then.
TEST(FadingScene, WhatGoesIsNotDrawnWhenItsRoomIsTaken) {
  Settings settings = small_settings();
  settings.view_distance_m = 600;
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(256, 256);
  scene->settle(pose);
  State& s = scene->state();
  s.meshes.set_budget(s.memory->used_bytes());
  const std::uint64_t evicted = s.meshes.stats().evictions;
  fly(*scene, pose, 120, 0.8, [&](const Seen&) { expect_consistent(*scene); });
  EXPECT_GT(s.meshes.stats().evictions, evicted + 100);
}

// A model that is drawn as a whole and for which another level is requested; and a third level.
std::pair<ecs::Entity, int> changing_model(const State& s) {
  std::pair<ecs::Entity, int> found{{}, -1};
  s.entities.each<const Demand, const Detail, const Fading>(
      [&](std::span<const ecs::Entity> entities, std::span<const Demand> demands,
          std::span<const Detail> details, std::span<const Fading> fading) {
        for (std::size_t i = 0; i < entities.size(); ++i) {
          const Demand& d = demands[i];
          if (fading[i].tick + 1 != s.clock.tick || fading[i].share < 1) continue;
          if (d.requested_level == kNoLevel || d.requested_level == d.drawn_level) continue;
          for (int level = 0; level < static_cast<int>(details[i].level_count); ++level) {
            if (level != d.drawn_level && level != d.requested_level) found = {entities[i], level};
          }
        }
      });
  return found;
}

// The first of two meshes that land in one tick lands where there is nothing any more: what the
// second replaces is the first, not what was evicted.
TEST(FadingScene, WhatWasEvictedIsNotReplacedByWhatLands) {
  const auto scene = make_scene(small_settings());
  State& s = scene->state();
  const core::CameraPose pose = pose_at(256, 256);
  scene->settle(pose);
  tick_at(*scene, pose);
  s.settings.max_error_pixels /= 3;
  tick_at(*scene, pose);
  const auto [model, level] = changing_model(s);
  ASSERT_GE(level, 0);
  const Source& source = *s.entities.get<Source>(model);
  const synthesis::MeshKey key =
      key_of(*s.entities.get<Placed>(model), *s.entities.get<Detail>(model), source,
             static_cast<std::uint8_t>(level));
  const auto rank = synthesis::Rank::by_layer(synthesis::RankGroup::kVisibleCoarse, 0, 1);
  const synthesis::Want want{key, &source.parameters, owner_of(model), rank, 0};
  ASSERT_EQ(s.meshes.plan(std::span(&want, 1), {}, s.settings.policy).published, 1u);
  s.meshes.wait();
  const synthesis::MeshHandle drawn = s.entities.get<Mesh>(model)->handle;
  s.meshes.rank(drawn, synthesis::Rank::unwanted());
  const std::uint64_t budget = s.meshes.stats().budget_bytes;
  while (s.meshes.get(drawn) != nullptr)
    s.meshes.set_budget(s.memory->used_bytes() - 1);
  s.meshes.set_budget(budget);
  for (int i = 0; i < 5; ++i) {
    tick_at(*scene, pose);
    expect_drawn_alive(*scene);
  }
  EXPECT_NE(s.entities.get<Fading>(model)->old_mesh, drawn);
}

TEST(FadingScene, TurningTheCameraFadesNothing) {
  Settings settings = small_settings();
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  for (int i = 0; i < 60; ++i) {
    tick_at(*scene, pose_at(256, 256, 0.05 * i));
    scene->state().meshes.wait();
    const Seen seen = count_fading(*scene);
    EXPECT_EQ(seen.coming + seen.going, 0u) << i;
  }
}

// The fades with which the models of a node are drawn.
std::vector<float> fades_of(const Scene& scene, const NodeCoord& node) {
  const State& s = scene.state();
  const NodeGrid& grid = s.streaming.grids[node.level];
  std::vector<float> fades;
  if (!grid.contains(node.coord) || !s.entities.alive(grid.entity_of(node.coord))) return fades;
  const auto& children = *s.entities.get<ecs::Children>(grid.entity_of(node.coord));
  for (const ecs::Entity model : s.entities.children(children)) {
    if (s.entities.get<Demand>(model)->drawn_level == kNoLevel) continue;
    const std::uint32_t id = s.entities.get<Mesh>(model)->range.id;
    for (const render::MeshDraw& draw : s.draws.models) {
      if (draw.range.id == id) fades.push_back(draw.fade);
    }
  }
  return fades;
}

bool lies_in(NodeCoord node, const NodeCoord& ancestor) {
  while (node.level < ancestor.level)
    node = parent_of(node);
  return node == ancestor;
}

// Flies until a node with a mesh of all models is split, or, `back`, one comes in place of others.
void expect_handover(bool back) {
  Settings settings = small_settings();
  settings.view_distance_m = 600;
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(256, 256);
  pose.position.local.y += 60;
  scene->settle(pose);
  tick_at(*scene, pose);
  const auto& shown = scene->state().draws.shown_nodes;
  const float step = static_cast<float>(1.0 / 60.0 / settings.fade_seconds);
  int handovers = 0;
  for (int i = 0; i < 200 && handovers == 0; ++i) {
    const std::vector<NodeCoord> before = shown;
    pose.position.local.z += back ? 0.5 : -0.5;
    tick_at(*scene, pose);
    scene->state().meshes.wait();
    for (const NodeCoord& gone : before) {
      if (std::ranges::find(shown, gone) != shown.end()) continue;
      for (const NodeCoord& come : shown) {
        if (back ? !lies_in(gone, come) : !lies_in(come, gone)) continue;
        const std::vector<float> going = fades_of(*scene, gone), coming = fades_of(*scene, come);
        if (going.empty() || coming.empty()) continue;
        for (const float fade : going)
          EXPECT_NEAR(fade, -step, 1e-6F);
        for (const float fade : coming)
          EXPECT_NEAR(fade, step, 1e-6F);
        ++handovers;
      }
    }
  }
  EXPECT_GT(handovers, 0);
  for (int i = 0; i < 60; ++i)
    tick_at(*scene, pose);
  const Seen seen = count_fading(*scene);
  EXPECT_EQ(seen.coming + seen.going, 0u);
}

TEST(FadingScene, TheModelsOfANodeThatIsSplitGoAsThoseBelowItCome) {
  expect_handover(false);
}

TEST(FadingScene, TheModelsOfNodesThatAreMergedGoAsTheOneMeshComes) {
  expect_handover(true);
}

TEST(FadingScene, AfterSettlingEverythingIsThereAlsoInMidFlight) {
  Settings settings = small_settings();
  settings.view_distance_m = 600;
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  tick_at(*scene, pose_at(256, 256));
  scene->state().settings.max_error_pixels *= 2;  // other nodes and levels at the same place
  scene->settle(pose_at(256, 256));
  tick_at(*scene, pose_at(256, 256));
  const Seen seen = count_fading(*scene);
  EXPECT_EQ(seen.coming + seen.going, 0u);
}

// Nothing is kept there that could go while something else comes.
TEST(FadingScene, LazyEvaluationFadesNothing) {
  Settings settings = small_settings();
  settings.paradigm = Paradigm::kLazyEvaluation;
  settings.view_distance_m = 400;
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(256, 256);
  fly(*scene, pose, 80, 0.8, [](const Seen& seen) { EXPECT_EQ(seen.coming + seen.going, 0u); });
}

}  // namespace
}  // namespace psygen::scene
