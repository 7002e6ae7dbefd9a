#include "engine/scene/meshes/fading.hpp"

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

TEST(Fading, AModelEnteringTheViewAppearsAtOnceAndANewOneFadesIn) {
  Fading entering, appearing;
  EXPECT_EQ(advance_fade_in(entering, {1, kQuarter}, false), 1.0F);
  for (std::uint32_t tick = 1; tick <= 6; ++tick) {
    const float expected = std::min(1.0F, static_cast<float>(tick) * kQuarter);
    EXPECT_EQ(advance_fade_in(appearing, {tick, kQuarter}, tick == 1), expected);
  }
  // Away for a tick: it is new again.
  EXPECT_EQ(advance_fade_in(appearing, {8, kQuarter}, true), kQuarter);
}

TEST(Fading, AFadeCanReverseAtAnyPoint) {
  Fading fading;
  advance_fade_in(fading, {1, kQuarter}, false);
  EXPECT_EQ(advance_fade_out(fading, {2, kQuarter}), 0.75F);
  EXPECT_EQ(advance_fade_out(fading, {3, kQuarter}), 0.5F);
  EXPECT_EQ(advance_fade_in(fading, {4, kQuarter}, true), 0.75F);
  EXPECT_EQ(advance_fade_out(fading, {5, kQuarter}), 0.5F);
  EXPECT_EQ(advance_fade_out(fading, {6, kQuarter}), 0.25F);
  EXPECT_EQ(advance_fade_out(fading, {7, kQuarter}), 0.0F);
  EXPECT_EQ(advance_fade_out(fading, {8, kQuarter}), 0.0F);
  EXPECT_EQ(advance_fade_out(fading, {9, kQuarter}), 0.0F)
      << "what was not drawn does not come back to go";
}

TEST(Fading, AReplacementTakesOverThePixels) {
  Fading fading;
  advance_fade_in(fading, {1, kQuarter}, false);
  replace_mesh(fading, mesh_of(7), 3, false);
  EXPECT_EQ(advance_fade_in(fading, {2, kQuarter}, false), kQuarter);
  EXPECT_EQ(fading.old_range.id, 7u);
  EXPECT_EQ(fading.old_level, 3);
  EXPECT_TRUE(fading.old_mesh);
  for (std::uint32_t tick = 3; tick <= 5; ++tick)
    advance_fade_in(fading, {tick, kQuarter}, false);
  EXPECT_EQ(fading.share, 1.0F);
  EXPECT_FALSE(fading.old_mesh) << "taken over";
}

TEST(Fading, OfThreeSuccessiveMeshesTheMostVisibleOneFadesOut) {
  for (const bool late : {false, true}) {
    Fading fading;
    advance_fade_in(fading, {1, kQuarter}, false);
    replace_mesh(fading, mesh_of(1), 3, false);
    advance_fade_in(fading, {2, kQuarter}, false);
    if (late) advance_fade_in(fading, {3, 0.5F}, false);
    replace_mesh(fading, mesh_of(2), 3, false);
    EXPECT_EQ(fading.old_range.id, late ? 2u : 1u);
    EXPECT_EQ(fading.share, late ? 0.0F : kQuarter);
  }
  Fading appearing;  // nothing was there before the first mesh
  advance_fade_in(appearing, {1, kQuarter}, true);
  replace_mesh(appearing, mesh_of(1), 3, false);
  EXPECT_FALSE(appearing.old_mesh);
  EXPECT_EQ(advance_fade_in(appearing, {2, kQuarter}, false), 0.5F);
}

TEST(Fading, AModelThatFadesOutDuringAReplacementFadesAsAWhole) {
  Fading fading;
  advance_fade_in(fading, {1, kQuarter}, false);
  replace_mesh(fading, mesh_of(1), 3, false);
  EXPECT_EQ(advance_fade_in(fading, {2, kQuarter}, false), kQuarter);
  EXPECT_EQ(advance_fade_out(fading, {3, kQuarter}), 0.75F) << "the old mesh had the other pixels";
  EXPECT_FALSE(fading.old_mesh);
}

TEST(Fading, AReplacementOutOfViewNeedsNoFade) {
  Fading fading;
  advance_fade_in(fading, {1, kQuarter}, false);
  replace_mesh(fading, mesh_of(1), 3, false);
  EXPECT_EQ(advance_fade_in(fading, {5, kQuarter}, false), 1.0F);
  EXPECT_FALSE(fading.old_mesh);
}

// A pattern that moved as far as a fade would give pixels back.
TEST(Fading, ThePatternMovesByHalfOfAFadeAndWraps) {
  float phase = 0.7F;
  for (const float expected : {0.825F, 0.95F, 0.075F}) {
    phase = next_phase(phase, {1, kQuarter});
    EXPECT_NEAR(phase, expected, 1e-6F);
  }
  EXPECT_LT(next_phase(0.5F, {1, 1.0F}), 1.0F);
}

using visibility::NodeCoord;

// A tick that draws these nodes; returns those that are no longer drawn.
std::vector<NodeCoord> draw(NodeCrossFade& cross_fade, const std::vector<NodeCoord>& nodes,
                            bool something_left = true, bool continues = true) {
  std::vector<NodeCoord> going;
  cross_fade.update(nodes, continues);
  cross_fade.for_each_going([&](const NodeCoord& node) {
    going.push_back(node);
    return something_left;
  });
  return going;
}

using NodeCoords = std::vector<NodeCoord>;

TEST(NodeCrossFade, SplitAndMergedNodesReplaceEachOther) {
  const NodeCoord parent{{-2, 3}, 4}, other{{5, 5}, 4};
  const NodeCoord child = child_of(parent, 2), grandchild = child_of(child, 1);
  NodeCrossFade cross_fade;
  EXPECT_EQ(draw(cross_fade, {parent, other}), NodeCoords{});
  EXPECT_TRUE(cross_fade.is_new_node(parent));
  EXPECT_FALSE(cross_fade.replaces(parent)) << "there was nothing before it";
  EXPECT_EQ(draw(cross_fade, {other, grandchild}), NodeCoords{parent});
  EXPECT_TRUE(cross_fade.replaces(grandchild)) << "two levels below";
  EXPECT_FALSE(cross_fade.is_new_node(other));
  EXPECT_EQ(draw(cross_fade, {parent, other}), NodeCoords{grandchild});
  EXPECT_TRUE(cross_fade.replaces(parent)) << "back again";
  EXPECT_EQ(draw(cross_fade, {parent, other}, false), NodeCoords{grandchild})
      << "kept until it is gone";
  EXPECT_FALSE(cross_fade.is_new_node(parent));
  EXPECT_EQ(draw(cross_fade, {parent, other}), NodeCoords{});
}

TEST(NodeCrossFade, NodesEnteringTheViewReplaceNothing) {
  const NodeCoord left{{1, 1}, 2}, right{{2, 1}, 2};
  NodeCrossFade cross_fade;
  draw(cross_fade, {left});
  draw(cross_fade, {right});
  EXPECT_TRUE(cross_fade.is_new_node(right));
  EXPECT_FALSE(cross_fade.replaces(right));
}

TEST(NodeCrossFade, ANodeThatHasFadedOutIsNotReplaced) {
  const NodeCoord parent{{1, 1}, 2}, child = child_of(parent, 0);
  NodeCrossFade cross_fade;
  draw(cross_fade, {parent});
  EXPECT_EQ(draw(cross_fade, {child}, false), NodeCoords{parent});
  EXPECT_FALSE(cross_fade.replaces(child));
}

TEST(NodeCrossFade, ATickWithoutDrawingEndsAllFades) {
  const NodeCoord parent{{1, 1}, 2}, child = child_of(parent, 0);
  NodeCrossFade cross_fade;
  draw(cross_fade, {parent});
  EXPECT_EQ(draw(cross_fade, {child}, true, false), NodeCoords{});
  EXPECT_TRUE(cross_fade.is_new_node(child));
  EXPECT_FALSE(cross_fade.replaces(child));
}

// ---- In a scene --------------------------------------------------------------------------------

struct Seen {
  std::size_t coming = 0, going = 0;
};

// Checks all draws: a mesh fades out at the pace of its replacement.
Seen count_fading(const Scene& scene) {
  Seen seen;
  std::map<std::pair<float, float>, std::vector<float>> at;
  for (const render::MeshDraw& draw : state_of(scene).draws.models) {
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

// Flies forward by this distance in each tick and waits for all requests; calls visit() after each.
template <class Visit>
void fly(Scene& scene, core::CameraPose& pose, int ticks, double step_m, const Visit& visit) {
  for (int i = 0; i < ticks; ++i) {
    pose.position.local.z -= step_m;
    tick_at(scene, pose);
    state_of(scene).supply.wait();
    visit(count_fading(scene));
  }
}

TEST(FadingScene, ModelsFadeDuringAFlightAndAreCompleteAfterIt) {
  SceneSettings settings = small_settings();
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

TEST(FadingScene, ThePatternDiffersBetweenFramesButNotBetweenScenes) {
  const auto first = make_scene(small_settings()), second = make_scene(small_settings());
  float last = -1;
  for (int i = 0; i < 10; ++i) {
    tick_at(*first, pose_at(256, 256));
    tick_at(*second, pose_at(256, 256));
    const float phase = state_of(*first).draws.fade_phase;
    EXPECT_NE(phase, last);
    EXPECT_EQ(phase, state_of(*second).draws.fade_phase);
    last = phase;
  }
}

TEST(FadingScene, AStandingClockDoesNotHideModels) {
  SceneSettings settings = small_settings();
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(256, 256);
  scene->settle(pose);
  std::size_t fading = 0, most = 0;
  const auto stop_clock = [&](const Seen& seen) {
    state_of(*scene).clock.now_s = 0;
    fading = seen.coming + seen.going;
    most = std::max(most, fading);
  };
  fly(*scene, pose, 60, 0.8, stop_clock);
  fly(*scene, pose, 140, 0, stop_clock);
  EXPECT_GT(most, 5u);
  EXPECT_EQ(fading, 0u);
}

TEST(FadingScene, WithoutFadeTimeModelsAppearAndVanishAtOnce) {
  SceneSettings settings = small_settings();
  settings.fade_seconds = 0;
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(256, 256);
  scene->settle(pose);
  fly(*scene, pose, 60, 0.8, [](const Seen& seen) { EXPECT_EQ(seen.coming + seen.going, 0u); });
}

// A mesh that fades out may be evicted at any time; it is not drawn after that.
TEST(FadingScene, AnEvictedMeshStopsFadingOut) {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 600;
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(256, 256);
  scene->settle(pose);
  State& s = state_of(*scene);
  s.supply.set_budget(s.memory->used_bytes());
  const std::uint64_t evicted = s.supply.stats().evictions;
  fly(*scene, pose, 120, 0.8, [&](const Seen&) { expect_consistent(*scene); });
  EXPECT_GT(s.supply.stats().evictions, evicted + 100);
}

// A fully drawn model for which another level is requested; and a third level.
std::pair<ecs::Entity, int> changing_model(const State& s) {
  std::pair<ecs::Entity, int> found{{}, -1};
  s.entities.each<const MeshDemand, const LodErrors, const Fading>(
      [&](std::span<const ecs::Entity> entities, std::span<const MeshDemand> demands,
          std::span<const LodErrors> details, std::span<const Fading> fading) {
        for (std::size_t i = 0; i < entities.size(); ++i) {
          const MeshDemand& d = demands[i];
          if (fading[i].tick + 1 != s.clock.tick || fading[i].share < 1) continue;
          if (d.requested_level == kNoLevel || d.requested_level == d.drawn_level) continue;
          for (int level = 0; level < static_cast<int>(details[i].level_count); ++level) {
            if (level != d.drawn_level && level != d.requested_level) found = {entities[i], level};
          }
        }
      });
  return found;
}

// Of two meshes that become ready in one tick, the first replaces an evicted mesh: the second
// replaces the first, not the evicted one.
TEST(FadingScene, AnEvictedMeshIsNotCrossFaded) {
  const auto scene = make_scene(small_settings());
  State& s = state_of(*scene);
  const core::CameraPose pose = pose_at(256, 256);
  scene->settle(pose);
  tick_at(*scene, pose);
  s.settings.max_error_pixels /= 3;
  tick_at(*scene, pose);
  const auto [model, level] = changing_model(s);
  ASSERT_GE(level, 0);
  const MeshSource& source = *s.entities.get<MeshSource>(model);
  const synthesis::MeshKey key =
      key_of(*s.entities.get<MeshPlacement>(model), *s.entities.get<LodErrors>(model), source,
             static_cast<std::uint8_t>(level));
  const auto rank = synthesis::Rank::by_layer(synthesis::RankGroup::kVisibleCoarse, 0, 1);
  const synthesis::Want want{key, &source.parameters, owner_of(model), rank, 0};
  ASSERT_EQ(s.supply.plan(std::span(&want, 1), {}, s.settings.policy).published, 1u);
  s.supply.wait();
  const synthesis::MeshHandle drawn = s.entities.get<Mesh>(model)->handle;
  s.supply.rank(drawn, synthesis::Rank::unwanted());
  const std::uint64_t budget = s.supply.stats().budget_bytes;
  while (s.supply.get(drawn) != nullptr)
    s.supply.set_budget(s.memory->used_bytes() - 1);
  s.supply.set_budget(budget);
  for (int i = 0; i < 5; ++i) {
    tick_at(*scene, pose);
    expect_drawn_alive(*scene);
  }
  EXPECT_NE(s.entities.get<Fading>(model)->old_mesh, drawn);
}

TEST(FadingScene, TurningTheCameraFadesNothing) {
  SceneSettings settings = small_settings();
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  for (int i = 0; i < 60; ++i) {
    tick_at(*scene, pose_at(256, 256, 0.05 * i));
    state_of(*scene).supply.wait();
    const Seen seen = count_fading(*scene);
    EXPECT_EQ(seen.coming + seen.going, 0u) << i;
  }
}

// The fades with which the models of a node are drawn.
std::vector<float> fades_of(const Scene& scene, const NodeCoord& node) {
  const State& s = state_of(scene);
  const NodeGrid& grid = s.streaming.grids[node.level];
  std::vector<float> fades;
  if (!grid.contains(node.coord) || !s.entities.alive(grid.entity_of(node.coord))) return fades;
  const auto& children = *s.entities.get<ecs::Children>(grid.entity_of(node.coord));
  for (const ecs::Entity model : s.entities.children(children)) {
    if (s.entities.get<MeshDemand>(model)->drawn_level == kNoLevel) continue;
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

// Flies until a node with a merged mesh is split, or, if `back`, until nodes are merged.
void expect_cross_fade(bool back) {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 600;
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(256, 256);
  pose.position.local.y += 60;
  scene->settle(pose);
  tick_at(*scene, pose);
  const auto& shown = state_of(*scene).draws.shown_nodes;
  const float step = static_cast<float>(1.0 / 60.0 / settings.fade_seconds);
  int cross_fades = 0;
  for (int i = 0; i < 200 && cross_fades == 0; ++i) {
    const std::vector<NodeCoord> before = shown;
    pose.position.local.z += back ? 0.5 : -0.5;
    tick_at(*scene, pose);
    state_of(*scene).supply.wait();
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
        ++cross_fades;
      }
    }
  }
  EXPECT_GT(cross_fades, 0);
  for (int i = 0; i < 60; ++i)
    tick_at(*scene, pose);
  const Seen seen = count_fading(*scene);
  EXPECT_EQ(seen.coming + seen.going, 0u);
}

TEST(FadingScene, ModelsCrossFadeWhenANodeIsSplit) {
  expect_cross_fade(false);
}

TEST(FadingScene, ModelsCrossFadeWhenNodesAreMerged) {
  expect_cross_fade(true);
}

TEST(FadingScene, SettlingEndsAllFadesAlsoInMidFlight) {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 600;
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  tick_at(*scene, pose_at(256, 256));
  state_of(*scene).settings.max_error_pixels *= 2;  // other nodes and levels at the same place
  scene->settle(pose_at(256, 256));
  tick_at(*scene, pose_at(256, 256));
  const Seen seen = count_fading(*scene);
  EXPECT_EQ(seen.coming + seen.going, 0u);
}

// Lazy evaluation keeps no mesh that could fade out.
TEST(FadingScene, LazyEvaluationFadesNothing) {
  SceneSettings settings = small_settings();
  settings.paradigm = Paradigm::kLazyEvaluation;
  settings.view_distance_m = 400;
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(256, 256);
  fly(*scene, pose, 80, 0.8, [](const Seen& seen) { EXPECT_EQ(seen.coming + seen.going, 0u); });
}

}  // namespace
}  // namespace psygen::scene
