// The paper's walk with a single slow modeler, and the cost of wide views compared with narrow
// ones.
#include <algorithm>
#include <map>

#include "engine/world/camera_path.hpp"
#include "engine/world/files/path_file.hpp"
#include "tests/engine/scene/gate.hpp"
#include "tests/source_file.hpp"

namespace psygen::scene {
namespace {

// Starts with an empty cache. The modeler takes 0.4 ms for each ground mesh and tree, many times as
// long as a present-day core.
TEST(Flights, OneModelerLeavesNoHolesOnThePapersWalk) {
  constexpr int kMeshesPerTick = 40, kWarmupTicks = 60;
  const auto path = world::load_camera_path(source_file("game/paths/walk27.toml"));
  ASSERT_TRUE(path) << path.error().message;
  SceneSettings settings = gated_settings();
  settings.plan_seconds_ahead = 1e6;  // independent of the machine's speed
  GatedScene gated(settings);
  gated.gate.set_open(false);
  const State& s = state_of(*gated.scene);
  ASSERT_EQ(s.settings.modelers, 1u);
  std::size_t holes_before = 0, made = 0, max_in_view = 0;
  for (int tick = 0; tick / 60.0 < path->duration_seconds(); ++tick) {
    tick_at(*gated.scene, path->pose_at(tick / 60.0, s.facts.world));
    if (tick >= kWarmupTicks) {
      EXPECT_EQ(s.draws.counts.holes, 0u) << "tick " << tick;
    } else {
      holes_before += s.draws.counts.holes;
    }
    made += s.meshes.counts.models_synthesised;
    max_in_view = std::max<std::size_t>(max_in_view, s.draws.counts.nodes_in_view);
    gated.make(kMeshesPerTick);
  }
  EXPECT_GT(holes_before, 0u);
  EXPECT_GT(made, 5000u);
  EXPECT_GT(max_in_view, 300u);
  const synthesis::CacheStats& made_and_drawn = s.supply.stats();
  EXPECT_GT(made_and_drawn.triangles_drawn, made_and_drawn.triangles * 7 / 10);
}

// The LODs that individual models drew in the last tick, and their distances, by entity.
struct ShownModel {
  int level;
  float distance_m;
};
std::map<std::uint32_t, ShownModel> shown_models(const State& s) {
  std::map<std::uint32_t, ShownModel> shown;
  for (const ChosenNode& chosen : s.view.chosen) {
    if (chosen.level > 0) continue;
    const QuadtreeNode& node = *s.entities.get<QuadtreeNode>(chosen.entity);
    const glm::dvec3 corner = core::offset_m(visibility::corner_block(node.at),
                                             s.camera.pose.position, s.facts.world.block_size_m());
    for (const ecs::Entity model :
         s.entities.children(*s.entities.get<ecs::Children>(chosen.entity))) {
      const MeshDemand& demand = *s.entities.get<MeshDemand>(model);
      if (demand.in_view_tick != s.clock.tick - 1 || demand.drawn_level == kNoLevel) continue;
      const glm::vec3 foot = glm::vec3(corner) + s.entities.get<MeshPlacement>(model)->position;
      shown[model.index] = {demand.drawn_level, glm::length(foot)};
    }
  }
  return shown;
}

// The next LOD is ready before it is wanted, and it stays.
TEST(Flights, AnApproachingModelNeverGetsCoarser) {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 600;
  settings.max_error_pixels = 12;
  const auto scene = make_scene(settings);
  const State& s = state_of(*scene);
  core::CameraPose pose = pose_at(256, 256, 0.3);
  pose.position.local.y = 40;
  scene->settle(pose);
  std::map<std::uint32_t, ShownModel> before;
  int finer = 0;
  for (int tick = 0; tick < 120; ++tick) {
    const glm::dvec3 ahead(core::forward_of(pose));
    pose.position.local += glm::dvec3(ahead.x, 0, ahead.z) * (300.0 / 60);
    tick_at(*scene, pose);
    const auto now = shown_models(s);
    for (const auto& [model, is] : now) {
      const auto was = before.find(model);
      if (was == before.end() || is.distance_m >= was->second.distance_m) continue;
      EXPECT_LE(is.level, was->second.level) << "model " << model << " in tick " << tick;
      finer += is.level < was->second.level ? 1 : 0;
    }
    before = now;
  }
  EXPECT_GT(finer, 100);
}

// The size of a settled scene.
struct Size {
  double entities, nodes, cut, terrain_draws, model_draws, megabytes;
};

Size size_at(double view_distance_m) {
  SceneSettings settings = gated_settings();
  settings.view_distance_m = view_distance_m;
  settings.max_error_pixels = 4;
  settings.budget_bytes = 512ull << 20;
  settings.plan_seconds_ahead = 1e6;
  const auto scene =
      make_scene_of(settings, [](world::World& world) { world.blocks_x = world.blocks_z = 0; });
  core::CameraPose pose = pose_at(256, 256, 0.3);
  pose.position.local.y = 200;
  scene->settle(pose);
  tick_at(*scene, pose);
  const State& s = state_of(*scene);
  EXPECT_EQ(s.draws.counts.holes, 0u);
  const auto number = [](std::size_t count) { return static_cast<double>(count); };
  return {number(s.entities.size()),       number(s.entities.count<QuadtreeNode>()),
          number(s.view.cut.nodes.size()), number(s.draws.terrain.size()),
          number(s.draws.models.size()),   number(s.supply.stats().bytes) / (1 << 20)};
}

// Growth with the distance would make each doubling add twice as much as the one before.
TEST(Flights, EachDoublingOfTheViewDistanceAddsAtMostAsMuchAsTheFirst) {
  std::vector<Size> sizes;
  for (const double view_km : {2, 4, 8, 16, 32})
    sizes.push_back(size_at(1000 * view_km));
  for (const auto& [name, what] :
       {std::pair("entities", &Size::entities), std::pair("nodes", &Size::nodes),
        std::pair("nodes of the cut", &Size::cut),
        std::pair("draws of ground", &Size::terrain_draws),
        std::pair("draws of models", &Size::model_draws),
        std::pair("megabytes", &Size::megabytes)}) {
    const double first = sizes[1].*what - sizes[0].*what;
    EXPECT_GT(sizes[0].*what, 0) << name;
    EXPECT_LT(first, 0.6 * (sizes[0].*what)) << name;
    for (std::size_t i = 2; i < sizes.size(); ++i)
      EXPECT_LE(sizes[i].*what - sizes[i - 1].*what, 1.2 * first) << name << ", doubling " << i;
  }
}

}  // namespace
}  // namespace psygen::scene
