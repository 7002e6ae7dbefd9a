// The order of requests: meshes in view, then those that the camera is expected to see, then those
// around it. Meshes behind ridges come late.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>
#include <unordered_map>

#include "engine/models/terrain/terrain.hpp"
#include "tests/engine/scene/gate.hpp"

namespace psygen::scene {
namespace {

using synthesis::Rank;
using synthesis::RankGroup;
using synthesis::Want;

TEST(Requests, TurningAroundShowsNoHoleWithoutFurtherSynthesis) {
  GatedScene gated(gated_settings());
  Scene& scene = *gated.scene;
  for (const double yaw : {0.3, 2.0}) {
    gated.gate.set_open(true);
    scene.settle(pose_at(256, 256, yaw));
    gated.gate.set_open(false);
    for (int i = 0; i < 5; ++i) {
      tick_at(scene, pose_at(256, 256, yaw + std::numbers::pi));
      const DrawCounts& counters = state_of(scene).draws.counts;
      EXPECT_EQ(counters.holes, 0u) << "tick " << i;
      // Coarser nodes replace most nodes that were not expected there.
      EXPECT_GT(counters.nodes_in_view, 50u);
      EXPECT_GT(state_of(scene).draws.terrain.size(), 10u);
    }
    expect_consistent(scene);
  }
}

// Meshes made by the main thread itself.
std::uint64_t made_here(const Scene& scene) {
  for (const synthesis::ModelerStats& made : state_of(scene).supply.modeler_stats().modelers)
    if (made.modeler == synthesis::kMainThreadModeler) return made.models;
  return 0;
}

TEST(Requests, TheMainThreadHelpsWithVisibleMeshesIfModelersGetNoProcessor) {
  for (const double budget_ms : {0.0, 1000.0}) {
    SceneSettings settings = gated_settings();
    settings.main_thread_budget_ms = budget_ms;
    settings.plan_seconds_ahead = 1e6;  // nothing that depends on what the machine takes
    GatedScene gated(settings);
    Scene& scene = *gated.scene;
    const DrawCounts& counters = state_of(scene).draws.counts;
    scene.settle(pose_at(256, 256, 0.3));
    gated.gate.set_open(false);
    const std::uint64_t before = made_here(scene);
    tick_at(scene, pose_at(256, 248, 0.3));
    ASSERT_EQ(counters.holes, 0u) << "coarser nodes stand for what is missing";
    ASSERT_GT(counters.coarse, 0u);
    EXPECT_EQ(made_here(scene), before) << "no hole, and it has only just become too coarse";
    const double missing_percent = counters.missing_pixels_percent;
    state_of(scene).clock.now_s += 0.12;
    for (int i = 0; i < 5; ++i)
      tick_at(scene, pose_at(256, 248, 0.3));
    if (budget_ms > 0) {
      EXPECT_GT(made_here(scene), before + 100);
      EXPECT_LT(counters.missing_pixels_percent, 0.5 * missing_percent);
    } else {
      EXPECT_EQ(made_here(scene), before);
      EXPECT_EQ(counters.missing_pixels_percent, missing_percent);
    }
  }
}

// Drawn meshes that were made twice.
std::vector<ecs::Entity> drawn_spares(const State& s) {
  std::vector<ecs::Entity> found;
  s.entities.each<const MeshDemand, const Mesh>([&](std::span<const ecs::Entity> rows,
                                                    std::span<const MeshDemand> demands,
                                                    std::span<const Mesh> meshes) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (demands[i].drawn_level == kNoLevel) continue;
      EXPECT_FALSE(demands[i].stale);
      if (s.supply.get(meshes[i].handle)->key.spare) found.push_back(rows[i]);
    }
  });
  return found;
}

TEST(Requests, TheMainThreadFillsAHoleThatAModelerHoldsAndTheLateMeshIsDropped) {
  GatedScene gated(gated_settings());
  gated.gate.set_open(false);
  Scene& scene = *gated.scene;
  State& s = state_of(scene);
  const core::CameraPose pose = pose_at(256, 256, 0.3);
  tick_at(scene, pose);
  gated.make(0);
  s.settings.main_thread_budget_ms = 1000;
  s.settings.plan_seconds_ahead = 1e6;
  for (int i = 0; i < 3; ++i)
    tick_at(scene, pose);
  EXPECT_EQ(s.draws.counts.holes, 0u);
  const std::vector<ecs::Entity> spares = drawn_spares(s);
  ASSERT_EQ(spares.size(), 1u) << "one modeler holds one mesh";
  const synthesis::MeshHandle drawn = s.entities.get<Mesh>(spares[0])->handle;
  synthesis::MeshKey held = s.supply.get(drawn)->key;
  held.spare = false;
  const auto record_of_held = [&] { return s.supply.get(s.supply.find(held)); };
  ASSERT_EQ(record_of_held()->state, synthesis::MeshState::kRequested);

  gated.make(1);
  tick_at(scene, pose);
  EXPECT_EQ(s.entities.get<Mesh>(spares[0])->handle, drawn) << "nothing takes its place";
  const synthesis::MeshRecord* dropped = record_of_held();
  EXPECT_TRUE(dropped == nullptr || dropped->rank == Rank::unwanted());
  for (const Want& want : s.supply.wants())
    EXPECT_FALSE(want.key == held) << "it is there";
  expect_consistent(scene);
}

// Nodes in view that are drawn although an ancestor could be.
std::vector<ecs::Entity> drawn_below_complete_ones(const State& s) {
  std::vector<ecs::Entity> found;
  for (const std::uint32_t drawn : s.draws.nodes) {
    const std::vector<visibility::CutNode>& cut = s.view.cut.nodes;
    const auto entity_of_cut = [&](std::uint32_t at) {
      return s.streaming.grids[cut[at].node.level].entity_of(cut[at].node.coord);
    };
    bool complete_above = false;
    for (std::uint32_t at = cut[drawn].parent; at != visibility::kNoNode; at = cut[at].parent) {
      const MissingMeshes* lacking = s.entities.get<MissingMeshes>(entity_of_cut(at));
      complete_above = complete_above || (lacking != nullptr && lacking->meshes == 0);
    }
    if (complete_above && s.view.in_view[drawn] != 0) found.push_back(entity_of_cut(drawn));
  }
  return found;
}

// A model that has just become large enough to be visible: its node stays drawn in this tick, and
// nothing replaces the model.
TEST(Requests, AMeshMissingInADrawnNodeIsAHoleEvenUnderACompleteAncestor) {
  GatedScene gated(gated_settings());
  Scene& scene = *gated.scene;
  State& s = state_of(scene);
  scene.settle(pose_at(256, 262, 0));
  for (const int block : {261, 260, 259, 258})
    scene.settle(pose_at(256, block, 0));
  tick_at(scene, pose_at(256, 258, 0));
  gated.gate.set_open(false);
  std::set<std::uint64_t> taken;
  for (const ecs::Entity node : drawn_below_complete_ones(s)) {
    for (const ecs::Entity model : s.entities.children(node)) {
      MeshDemand& demand = *s.entities.get<MeshDemand>(model);
      if (demand.drawn_level == kNoLevel || demand.in_view_tick + 1 != s.clock.tick) continue;
      demand.drawn_level = kNoLevel;
      s.supply.forget(s.entities.get<Mesh>(model)->handle);
      taken.insert(owner_of(model));
    }
  }
  tick_at(scene, pose_at(256, 258, 0));
  std::size_t holes = 0;
  for (const Want& want : s.supply.wants()) {
    if (!taken.contains(want.owner)) continue;
    EXPECT_EQ(want.rank.group(), RankGroup::kVisibleHole);
    ++holes;
  }
  EXPECT_GT(holes, 10u);
}

// With two levels of nodes no node can be more than one level too coarse, and no models are on the
// ground.
std::unique_ptr<Scene> bare_scene(Gate& gate) {
  SceneSettings settings = gated_settings();
  settings.view_distance_m = 130;
  settings.max_error_pixels = 4;
  settings.plan_seconds_ahead = 1e6;  // nothing that depends on what the machine takes
  models::Registry registry = models::make_standard_registry();
  world::World world = paper_world(registry);
  world.scatter.clear();
  const auto slow =
      registry.add(std::make_unique<SlowType>("slow", registry[world.terrain_model], gate));
  EXPECT_TRUE(slow);
  world.terrain_model = *slow;
  std::unique_ptr<Scene> scene = make_scene(world, settings, std::move(registry));
  tell_time_of_flight(*scene);
  return scene;
}

TEST(Requests, TheMainThreadAlsoHelpsWithNearGroundOneLevelTooCoarse) {
  Gate gate;
  const auto scene = bare_scene(gate);
  State& s = state_of(*scene);
  ASSERT_EQ(s.facts.levels.size(), 2u);
  scene->settle(pose_at(256, 256, 0.3));
  tick_at(*scene, pose_at(256, 256, 0.3));
  EXPECT_EQ(s.telemetry.record.too_coarse_percent, 0.0);
  gate.set_open(false);
  const core::CameraPose pose = pose_at(256, 254, 0.3);
  tick_at(*scene, pose);
  EXPECT_EQ(s.telemetry.record.holes + s.telemetry.record.coarse_nodes, 0u);
  EXPECT_EQ(s.telemetry.record.missing_pixels_percent, 0.0);
  const double before_percent = s.telemetry.record.too_coarse_percent;
  EXPECT_GT(before_percent, 10.0);
  s.clock.now_s += 0.12;
  s.settings.main_thread_budget_ms = 1000;
  const std::uint64_t before = made_here(*scene);
  for (int i = 0; i < 5; ++i)
    tick_at(*scene, pose);
  EXPECT_GT(made_here(*scene), before);
  EXPECT_LT(s.telemetry.record.too_coarse_percent, 0.5 * before_percent);
  gate.set_open(true);
}

// By Want::owner: the wanted node, or the node under the wanted model.
std::unordered_map<std::uint64_t, ecs::Entity> nodes_of_owners(const State& s) {
  std::unordered_map<std::uint64_t, ecs::Entity> nodes;
  s.entities.each<const QuadtreeNode>(
      [&](std::span<const ecs::Entity> rows, std::span<const QuadtreeNode>) {
        for (const ecs::Entity node : rows) {
          nodes[owner_of(node)] = node;
          for (const ecs::Entity child : s.entities.children(node))
            nodes[owner_of(child)] = node;
        }
      });
  return nodes;
}

// A want for a node out of view that is expected in view.
struct Expected {
  Rank rank;
  float deadline_s = 0;
  int level = 0;
  glm::dvec3 corner{
      0.0};  // of the node, metres from the camera, to the camera's right and behind it
  double side_m = 0;

  // The angle by which the camera must turn right until it looks at the nearest corner.
  double angle() const {
    double least = std::numbers::pi;
    for (const double x : {corner.x, corner.x + side_m}) {
      for (const double z : {corner.z, corner.z + side_m})
        least = std::min(least, std::atan2(x, -z));
    }
    return least;
  }
};

// For cameras that look along −z.
std::vector<Expected> expected_wants(const State& s) {
  const auto nodes = nodes_of_owners(s);
  std::vector<Expected> found;
  for (const Want& want : s.supply.wants()) {
    const ecs::Entity entity = nodes.at(want.owner);
    if (want.rank.group() != RankGroup::kPredicted ||
        s.entities.get<Visibility>(entity)->in_view != 0)
      continue;
    const visibility::NodeCoord& at = s.entities.get<QuadtreeNode>(entity)->at;
    found.push_back({want.rank, want.deadline_s, at.level,
                     core::offset_m(visibility::corner_block(at), s.camera.pose.position,
                                    s.facts.world.block_size_m()),
                     s.facts.levels[at.level].size_m});
  }
  return found;
}

void expect_sooner_first(const std::vector<Expected>& wants) {
  std::set<float> deadlines;
  for (const Expected& want : wants) {
    EXPECT_TRUE(std::isfinite(want.deadline_s));
    EXPECT_GT(want.deadline_s, 0);
    deadlines.insert(want.deadline_s);
  }
  EXPECT_GE(deadlines.size(), 3u);
  std::size_t wrong = 0;
  for (const Expected& a : wants) {
    for (const Expected& b : wants)
      wrong += a.deadline_s < b.deadline_s && a.rank > b.rank ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0u) << "ranked in another order than by when they are needed";
}

// A second of a flight without any synthesis.
template <class Pose>
std::vector<Expected> wants_after(const Pose& pose_of) {
  SceneSettings settings = gated_settings();
  settings.view_distance_m = 3000;
  GatedScene gated(settings);
  gated.gate.set_open(false);
  for (int i = -60; i <= 0; ++i)
    tick_at(*gated.scene, pose_of(i / 60.0));
  return expected_wants(state_of(*gated.scene));
}

TEST(Requests, ATurningCameraRequestsItsFutureViewSoonestFirst) {
  constexpr double kTurnRate = 0.5;  // radians a second, to the right
  const std::vector<Expected> wants = wants_after([](double time_s) {
    core::CameraPose pose = pose_at(256, 256, kTurnRate * time_s);
    pose.pitch = 0;
    return pose;
  });
  expect_sooner_first(wants);
  // Boxes are wider than nodes, so they may be visible this much sooner. Cameras are predicted at
  // some times only, each at most three times as late as the one before.
  constexpr double kWiderRad = 0.1, kFirst_s = 0.25, kTimesLater = 3;
  const core::Projection projection;
  const double half_fov = std::atan(1280.0 / 720 * std::tan(projection.vertical_fov / 2));
  std::size_t ordered = 0;
  for (const Expected& a : wants) {
    EXPECT_LT(a.angle(), half_fov + kTurnRate * a.deadline_s + kWiderRad) << "is not seen by then";
    const double seen_s = std::max(0.0, a.angle() + kWiderRad - half_fov) / kTurnRate;
    EXPECT_LE(a.deadline_s, kFirst_s + kTimesLater * seen_s) << "is seen much sooner";
    for (const Expected& b : wants) {
      if (a.angle() + kWiderRad >= b.angle()) continue;
      EXPECT_LE(a.deadline_s, b.deadline_s) << "at " << a.angle() << " and " << b.angle();
      ordered += a.deadline_s < b.deadline_s ? 1 : 0;
    }
  }
  EXPECT_GT(ordered, 100u);
}

TEST(Requests, AMovingCameraRequestsItsFutureViewSoonestFirst) {
  const std::vector<Expected> wants = wants_after([](double time_s) {
    core::CameraPose pose = pose_at(256, 256, 0);
    pose.pitch = 0;
    pose.position.local.x += 100 * time_s;
    return pose;
  });
  expect_sooner_first(wants);
  std::size_t neighbours = 0;
  for (const Expected& a : wants) {
    for (const Expected& b : wants) {
      if (a.level != b.level || a.corner.z != b.corner.z || a.corner.x < 0 ||
          b.corner.x <= a.corner.x)
        continue;
      EXPECT_LE(a.deadline_s, b.deadline_s) << a.corner.x << " and " << b.corner.x << " m aside";
      neighbours += a.deadline_s < b.deadline_s ? 1 : 0;
    }
  }
  EXPECT_GT(neighbours, 100u);
}

// True if a node and its parent are hidden behind drawn ground. (A hidden node is needed if its
// siblings are visible.)
bool hides(const State& s, visibility::NodeCoord at) {
  const auto hidden = [&](const visibility::NodeCoord& node) {
    const std::size_t cell = s.streaming.grids[node.level].window_index(node.coord);
    return s.view.horizon.hides(s.view.levels[node.level].bounds[cell]);
  };
  return hidden(at) &&
         (at.level + 1U == s.facts.levels.size() || hidden(visibility::parent_of(at)));
}

// Near the ground in four valleys, with an empty cache and a few meshes at a time.
TEST(Requests, MeshesBehindARidgeComeAfterVisibleOnes) {
  SceneSettings settings = gated_settings();
  settings.view_distance_m = 3000;
  settings.plan_max_new = settings.plan_max_requests = 16;
  std::size_t hidden = 0;
  for (const auto& [x, z, yaw] : {std::tuple(256, 256, 0.3), std::tuple(100, 300, 2.0),
                                  std::tuple(200, 200, 1.0), std::tuple(340, 222, 5.0)}) {
    const auto scene = make_scene(settings);
    const State& s = state_of(*scene);
    core::CameraPose pose = pose_at(x, z, yaw);
    pose.pitch = 0;
    pose.position.local.y = models::ground_height_m(s.facts.world.terrain, {x, z}, 31.5, 31.5) + 5;
    for (int i = 0; i < 150; ++i) {
      tick_at(*scene, pose);
      const auto nodes = nodes_of_owners(s);
      Rank first_hidden = Rank::unwanted(), last_seen = Rank::from_bits(0);
      for (const Want& want : s.supply.wants()) {
        if (hides(s, s.entities.get<QuadtreeNode>(nodes.at(want.owner))->at)) {
          first_hidden = std::min(first_hidden, want.rank);
          ++hidden;
        } else if (synthesis::is_visible(want.rank.group())) {
          last_seen = std::max(last_seen, want.rank);
        }
      }
      EXPECT_FALSE(synthesis::is_visible(first_hidden.group())) << "tick " << i;
      EXPECT_LT(last_seen, first_hidden) << "tick " << i;
      state_of(*scene).supply.wait();
    }
  }
  EXPECT_GT(hidden, 500u);
}

}  // namespace
}  // namespace psygen::scene
