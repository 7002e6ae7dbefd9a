// Invariants of every frame of a flight, at any speed and with modelers of any speed.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/scene/draws/ground.hpp"
#include "tests/engine/scene/gate.hpp"

namespace psygen::scene {
namespace {

// A square of ground, metres from the corner of the block (0, 0).
struct Square {
  double x, z, side;
  bool holds(double px, double pz) const {
    return px >= x && px < x + side && pz >= z && pz < z + side;
  }
};

// True if the ground of a node of the cut is drawn, or resident without a visible tile.
bool has_ground(const State& s, std::uint32_t index) {
  const ecs::Entity entity = s.draws.entities[index];
  const MeshDemand* demand = s.entities.get<MeshDemand>(entity);
  if (demand == nullptr || demand->drawn_level == kNoLevel) return false;
  const Mesh& mesh = *s.entities.get<Mesh>(entity);
  const auto is_its = [&](const render::TerrainDraw& draw) {
    return draw.range.id == mesh.range.id;
  };
  if (std::ranges::any_of(s.draws.terrain, is_its)) return true;
  const visibility::CutNode& node = s.view.cut.nodes[index];
  const int level =
      (node.node.level > 0 ? s.facts.levels[node.node.level].mesh_level : 0) + demand->drawn_level;
  const glm::vec3 corner(core::offset_m(visibility::corner_block(node.node), s.camera.pose.position,
                                        s.facts.world.block_size_m()));
  const NodeTiles tiles{s.facts.grids[static_cast<std::size_t>(level)],
                        *s.entities.get<GroundOccluder>(entity), corner,
                        s.facts.cell_m * static_cast<float>(1U << node.node.level),
                        s.entities.get<QuadtreeNode>(entity)->low_m};
  return tiles_in_view(tiles, s.view) == 0;
}

// The ground of the drawn nodes.
std::vector<Square> drawn_ground(const State& s) {
  std::vector<Square> squares;
  const double block_m = s.facts.world.block_size_m();
  const core::WorldPosition& eye = s.camera.pose.position;
  for (const std::uint32_t index : s.draws.nodes) {
    const visibility::CutNode& node = s.view.cut.nodes[index];
    if (s.view.in_view[index] == 0 || !has_ground(s, index)) continue;
    squares.push_back({std::round(eye.block.x * block_m + eye.local.x + double{node.corner_x_m}),
                       std::round(eye.block.z * block_m + eye.local.z + double{node.corner_z_m}),
                       double{node.side_m}});
  }
  return squares;
}

// Nodes whose ground occludes others but is not drawn there; without those evicted in this tick.
std::size_t hiding_but_not_drawn(const State& s) {
  std::size_t count = 0;
  for (const std::uint32_t index : s.view.drawn) {
    const MeshDemand* demand = s.entities.get<MeshDemand>(s.draws.entities[index]);
    const bool resident = demand != nullptr && demand->drawn_level != kNoLevel;
    count += resident && s.view.in_view[index] != 0 &&
             std::ranges::find(s.draws.nodes, index) == s.draws.nodes.end();
  }
  return count;
}

std::size_t overlaps(const std::vector<Square>& squares) {
  std::size_t count = 0;
  for (const Square& a : squares) {
    for (const Square& b : squares) {
      count += &a < &b && a.x < b.x + b.side && b.x < a.x + a.side && a.z < b.z + b.side &&
               b.z < a.z + a.side;
    }
  }
  return count;
}

bool is_drawn(const std::vector<Square>& squares, double x, double z) {
  return std::ranges::any_of(squares, [&](const Square& s) { return s.holds(x, z); });
}

// Leaves in view that are drawn at no level, although they were drawn in the frame before.
std::size_t vanished(const State& s, const std::vector<Square>& before,
                     const std::vector<Square>& now) {
  std::size_t count = 0;
  const double block_m = s.facts.world.block_size_m();
  const core::WorldPosition& eye = s.camera.pose.position;
  for (std::size_t i = 0; i < s.view.cut.nodes.size(); ++i) {
    const visibility::CutNode& node = s.view.cut.nodes[i];
    if (!node.leaf || s.view.in_view[i] == 0) continue;
    const double half = double{node.side_m} / 2;
    const double x = eye.block.x * block_m + eye.local.x + double{node.corner_x_m} + half,
                 z = eye.block.z * block_m + eye.local.z + double{node.corner_z_m} + half;
    count += is_drawn(before, x, z) && !is_drawn(now, x, z);
  }
  return count;
}

SceneSettings steady_settings() {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 1000;
  settings.max_error_pixels = 12;
  settings.budget_bytes = 128ull << 20;
  return settings;
}

// 180 frames with `passes(i)` meshes in frame i.
template <class Pose, class Passes>
void fly_starved(const Pose& pose_of, const Passes& passes) {
  Gate gate;
  SceneSettings settings = steady_settings();
  settings.virtual_time = false;  // modelers are real, and wait at the gate
  settings.main_thread_budget_ms = 0;
  settings.watchdog_seconds = 1e6;
  const auto scene = slow_scene(settings, gate);
  scene->settle(pose_of(0));
  gate.set_open(false);
  State& s = state_of(*scene);
  std::vector<Square> before;
  std::size_t coarse = 0;
  for (int i = 0; i < 180; ++i) {
    gate.let_through(passes(i));
    tick_at(*scene, pose_of(i));
    const std::vector<Square> now = drawn_ground(s);
    EXPECT_EQ(overlaps(now), 0u) << "frame " << i;
    EXPECT_EQ(vanished(s, before, now), 0u) << "frame " << i;
    EXPECT_EQ(hiding_but_not_drawn(s), 0u) << "frame " << i;
    EXPECT_GT(now.size(), 2u) << "frame " << i;
    before = now;
    const auto leaf = [&](std::uint32_t node) { return s.view.cut.nodes[node].leaf; };
    coarse += !std::ranges::all_of(s.draws.nodes, leaf);
  }
  EXPECT_GT(coarse, 20u) << "ancestors have stood for what was missing";
  gate.set_open(true);
}

constexpr auto kSome = [](int i) { return i % 3; };

TEST(Steady, FlyingForwardNodesAreDrawnUntilAllTheirReplacementsAreReady) {
  const auto pose_of = [](int i) {
    core::CameraPose pose = pose_at(256, 256, 0.3 + 0.3 * std::sin(0.07 * i));
    pose.position.local += glm::dvec3(0, 40 * std::sin(0.05 * i), -3.0 * i);
    return pose;
  };
  fly_starved(pose_of, kSome);
  fly_starved(pose_of, [](int) { return 0; });
}

TEST(Steady, FlyingBackwardNodesAreDrawnUntilAllTheirReplacementsAreReady) {
  const auto pose_of = [](int i) {
    core::CameraPose pose = pose_at(256, 256, 0.3);
    // Forward first, so that there is something to merge.
    pose.position.local += glm::dvec3(0, 20 + i * 0.5, i < 60 ? -8.0 * i : 10.0 * i - 1080);
    return pose;
  };
  fly_starved(pose_of, kSome);
  fly_starved(pose_of, [](int i) { return i < 60 ? 40 : 0; });
}

TEST(Steady, LookingAroundNodesAreDrawnUntilAllTheirReplacementsAreReady) {
  const auto pose_of = [](int i) {
    core::CameraPose pose = pose_at(256, 256, 0.04 * i);
    pose.position.local.x += 4.0 * i;
    return pose;
  };
  fly_starved(pose_of, kSome);
}

// Maximum number of entities: all nodes of all windows with their models.
std::size_t max_entities(const State& s) {
  std::size_t most = 0;
  for (const NodeGrid& grid : s.streaming.grids)
    most += std::size_t{grid.side()} * grid.side() *
            (grid.level() == 0 ? 1 + s.facts.models_per_block : 2);
  return most;
}

void expect_bounded(const Scene& scene) {
  const State& s = state_of(scene);
  expect_within_budget(scene);
  EXPECT_LE(s.supply.outstanding(), s.settings.plan_max_requests + 64u);
  EXPECT_LE(s.entities.size(), max_entities(s));
}

// One second at 60 Hz with modelers that keep up; then everything in view is ready.
template <class Pose>
void fly_a_second(const SceneSettings& settings, const Pose& pose_of) {
  const auto scene = make_scene(settings);
  scene->settle(pose_of(0));
  for (int i = 1; i <= 60; ++i) {
    tick_at(*scene, pose_of(i));
    state_of(*scene).supply.wait();
    expect_bounded(*scene);
    EXPECT_EQ(overlaps(drawn_ground(state_of(*scene))), 0u) << "frame " << i;
  }
  // Modelers finish a plan within a moment; a slow machine takes several.
  const DrawCounts& counters = state_of(*scene).draws.counts;
  for (int i = 0; i < 3 || (i < 60 && counters.holes + counters.coarse > 0); ++i) {
    tick_at(*scene, pose_of(60));
    state_of(*scene).supply.wait();
  }
  EXPECT_EQ(counters.holes, 0u);
  EXPECT_EQ(counters.coarse, 0u);
  expect_consistent(*scene);
}

TEST(Steady, AfterASpinAt720DegreesASecondNothingIsMissing) {
  fly_a_second(steady_settings(),
               [](int i) { return pose_at(256, 256, 4 * std::numbers::pi * i / 60.0); });
}

TEST(Steady, AfterAFlightAt500MetresASecondNothingIsMissing) {
  fly_a_second(steady_settings(), [](int i) {
    core::CameraPose pose = pose_at(200, 200, 2.0);
    pose.position.local.x += 500.0 / 60.0 * i;
    return pose;
  });
}

TEST(Steady, AfterTeleportsNothingIsMissing) {
  fly_a_second(steady_settings(), [](int i) {
    const int jump = i / 15;
    return pose_at(100 + 77 * jump, 400 - 61 * jump, 1.3 * jump);
  });
}

// Coarse views have few nodes. Those that replace all others exist at once, although new nodes are
// spread over ticks and the main thread has time for nothing else.
TEST(Steady, AJumpShowsNoHoleWhereverItLeads) {
  SceneSettings settings = steady_settings();
  settings.view_distance_m = 16'000;
  settings.max_error_pixels = 16;
  settings.streaming_ticks = SceneSettings{}.streaming_ticks;
  settings.streaming_budget_ms = 0;
  settings.main_thread_budget_ms = 1e-9;
  const auto scene = make_scene(settings);
  const core::CameraPose home = pose_at(128, 128, 0.3);
  const core::CameraPose away = pose_at(366, 318, 2.0);
  scene->settle(home);
  for (const core::CameraPose& pose : {home, away, home, pose_at(160, 350, 4.0), away}) {
    for (int i = 0; i < 60; ++i) {
      tick_at(*scene, pose);
      EXPECT_EQ(scene->statistics().drawn.holes, 0u) << "tick " << i;
    }
  }
  expect_consistent(*scene);
}

// Nodes with ground but without their models wait for the models: their replacement became ready in
// the tick before.
TEST(Steady, AfterAJumpNoNodeIsDrawnWithoutItsModels) {
  SceneSettings settings = steady_settings();
  settings.view_distance_m = 16'000;
  const auto scene = make_scene(settings);
  State& s = state_of(*scene);
  const core::CameraPose home = pose_at(128, 128, 0.3);
  scene->settle(home);
  tick_at(*scene, home);
  for (int i = 0; i < 60; ++i)
    tick_at(*scene, pose_at(366, 318, 2.0));
  std::size_t released = 0;
  for (const synthesis::MeshRecord& record : s.supply.records()) {
    if (record.state != synthesis::MeshState::kReady || record.key.model != s.facts.merged_model)
      continue;
    s.supply.forget(s.supply.find(record.key));
    ++released;
  }
  EXPECT_GT(released, 20u);
  s.settings.plan_seconds_ahead = 0;  // so that nobody synthesises them again
  for (int i = 0; i < 10; ++i) {
    tick_at(*scene, home);
    EXPECT_EQ(s.draws.counts.holes, 0u) << "tick " << i;
  }
}

TEST(Steady, AfterAFallFrom2000MetresNothingIsMissing) {
  fly_a_second(steady_settings(), [](int i) {
    core::CameraPose pose = pose_at(256, 256, 0.6);
    pose.position.local.y = 2000.0 - 32.3 * i;
    pose.pitch = -0.6;
    return pose;
  });
}

TEST(Steady, TooLittleMemoryMakesNoHolesInTheGround) {
  SceneSettings settings = steady_settings();
  settings.budget_bytes = 6ull << 20;
  const auto scene = make_scene(settings);
  std::vector<Square> before;
  for (int i = 0; i < 120; ++i) {
    core::CameraPose pose = pose_at(200, 200, 0.05 * i);
    pose.position.local.x += 8.0 * i;
    tick_at(*scene, pose);
    state_of(*scene).supply.wait();
    expect_bounded(*scene);
    const std::vector<Square> now = drawn_ground(state_of(*scene));
    EXPECT_EQ(overlaps(now), 0u) << "frame " << i;
    EXPECT_EQ(vanished(state_of(*scene), before, now), 0u) << "frame " << i;
    before = now;
  }
  expect_consistent(*scene);
}

// Nodes drawn in the last tick, of which an ancestor is drawn now.
std::size_t gave_way(const std::vector<visibility::NodeCoord>& before, const State& s) {
  return static_cast<std::size_t>(std::ranges::count_if(before, [&](visibility::NodeCoord node) {
    while (std::size_t{node.level} + 1 < s.facts.levels.size()) {
      node = visibility::parent_of(node);
      if (std::ranges::find(s.draws.shown_nodes, node) != s.draws.shown_nodes.end()) return true;
    }
    return false;
  }));
}

std::size_t drawn_single_models(const State& s) {
  std::size_t count = 0;
  s.entities.each<const MeshDemand, const Fading>([&](std::span<const ecs::Entity>,
                                                      std::span<const MeshDemand> demands,
                                                      std::span<const Fading>) {
    count += static_cast<std::size_t>(std::ranges::count_if(
        demands, [](const MeshDemand& demand) { return demand.drawn_level != kNoLevel; }));
  });
  return count;
}

// Otherwise all models of a block would fade out and in again for each stone on it.
TEST(Steady, AModelThatBecomesLargeEnoughDoesNotMakeItsNodeCoarser) {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 500;
  settings.min_size_pixels = 8;
  const auto scene = make_scene(settings);
  core::CameraPose pose = pose_at(256, 256);
  for (int i = 0; i < 120; ++i)
    tick_at(*scene, pose);
  const State& s = state_of(*scene);
  const std::size_t models_before = drawn_single_models(s);
  std::size_t given_way = 0;
  for (int i = 0; i < 400; ++i) {
    const std::vector<visibility::NodeCoord> before = s.draws.shown_nodes;
    pose.position.local.z -= 0.1;
    tick_at(*scene, pose);
    given_way += gave_way(before, s);
  }
  EXPECT_EQ(given_way, 0U);
  EXPECT_GT(drawn_single_models(s), models_before + 10) << "nothing has become large enough";
}

}  // namespace
}  // namespace psygen::scene
