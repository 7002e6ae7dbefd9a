// Edits while a scene runs: they renew the changed meshes without a hole, leave all others, and
// restore the same meshes when they are taken back.
#include "engine/models/edits.hpp"

#include <algorithm>
#include <map>
#include <random>

#include "engine/models/terrain/terrain.hpp"
#include "engine/world/far/merged_models.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

const core::BlockCoord kEditedBlock{256, 256};

// Every mesh entity by its place: key, entity and drawn mesh.
struct Shown {
  ecs::Entity entity;
  std::uint64_t hash = 0;
  synthesis::MeshHandle mesh;
  bool stale = false, there = false;
  glm::vec3 position{0.0F};
};
using Name = std::tuple<std::int32_t, std::int32_t, int, std::uint32_t>;  // block, level, index

std::map<Name, Shown> shown_in(const Scene& scene) {
  std::map<Name, Shown> all;
  const ecs::World& entities = state_of(scene).entities;
  const auto add = [&](ecs::Entity entity, int level) {
    const MeshPlacement& placed = *entities.get<MeshPlacement>(entity);
    const MeshSource& source = *entities.get<MeshSource>(entity);
    const MeshDemand& demand = *entities.get<MeshDemand>(entity);
    all[{placed.block.x, placed.block.z, level, source.index}] = {
        entity,       source.parameters_hash,         entities.get<Mesh>(entity)->handle,
        demand.stale, demand.drawn_level != kNoLevel, placed.position};
  };
  entities.each<const QuadtreeNode>(
      [&](std::span<const ecs::Entity> rows, std::span<const QuadtreeNode> nodes) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
          add(rows[i], nodes[i].at.level);
          for (const ecs::Entity model : entities.children(rows[i]))
            add(model, nodes[i].at.level);
        }
      });
  return all;
}

std::size_t count_stale(const Scene& scene) {
  return static_cast<std::size_t>(
      std::ranges::count_if(shown_in(scene), [](const auto& named) { return named.second.stale; }));
}

// Ticks until no mesh is stale; no tick has a hole.
void tick_until_fresh(Scene& scene, const core::CameraPose& pose, int most = 60) {
  for (int i = 0; i < most; ++i) {
    state_of(scene).supply.wait();
    tick_at(scene, pose);
    EXPECT_EQ(scene.statistics().drawn.holes, 0u) << "tick " << i;
  }
  EXPECT_EQ(count_stale(scene), 0u);
  expect_consistent(scene);
}

std::unique_ptr<Scene> settled_scene(const core::CameraPose& pose = pose_at(256, 256)) {
  auto scene = make_scene(small_settings());
  scene->settle(pose);
  tick_at(*scene, pose);
  EXPECT_EQ(count_stale(*scene), 0u);
  return scene;
}

template <class T>
T expect_ok(core::Result<T> result) {
  EXPECT_TRUE(result) << result.error().message;
  return *result;
}
void expect_ok(const core::Result<void>& result) {
  EXPECT_TRUE(result) << result.error().message;
}

TEST(Edits, AFelledTreeIsGoneInTheNextTickAndNothingElseOfTheBlockChanges) {
  const auto scene = settled_scene();
  const auto before = shown_in(*scene);
  world::Edits edits = scene->edits();
  expect_ok(edits.remove(state_of(*scene).facts.world, {kEditedBlock, 3}));
  scene->edit(edits);
  tick_at(*scene, pose_at(256, 256));
  EXPECT_EQ(scene->statistics().drawn.holes, 0u);
  const auto after = shown_in(*scene);
  EXPECT_EQ(after.size() + 1, before.size());
  EXPECT_FALSE(after.contains({kEditedBlock.x, kEditedBlock.z, 0, 3}));
  std::size_t changed = 0;
  for (const auto& [name, shown] : after) {
    const Shown& old = before.at(name);
    EXPECT_EQ(old.entity, shown.entity);
    EXPECT_EQ(old.mesh, shown.mesh);
    changed += old.hash != shown.hash;
    if (old.hash != shown.hash) {
      EXPECT_EQ(std::get<3>(name), kMergedIndex);
    }
  }
  // The merged meshes of the nodes above the block, up to the last level that has them.
  const auto merged_above = std::ranges::count_if(before, [](const auto& named) {
    const auto& [x, z, level, index] = named.first;
    return index == kMergedIndex && x == (kEditedBlock.x >> level) << level &&
           z == (kEditedBlock.z >> level) << level;
  });
  EXPECT_EQ(changed, static_cast<std::size_t>(merged_above));
  EXPECT_GT(changed, 0u);
  tick_until_fresh(*scene, pose_at(256, 256));
}

TEST(Edits, TakenBackRestoreTheSameMeshes) {
  const auto scene = settled_scene();
  const auto before = shown_in(*scene);
  const world::World& world = state_of(*scene).facts.world;
  world::Edits edits = scene->edits();
  expect_ok(edits.remove(world, {kEditedBlock, 3}));
  expect_ok(edits.raise(world, {kEditedBlock, {31, 0, 31}}, 40, 10));
  expect_ok(edits.flatten(world, {{257, 255}, {3, 0, 60}}, 25, 30));
  scene->edit(edits);
  tick_until_fresh(*scene, pose_at(256, 256));
  const auto edited = shown_in(*scene);
  scene->edit(world::Edits());
  tick_until_fresh(*scene, pose_at(256, 256));
  const auto after = shown_in(*scene);
  ASSERT_EQ(after.size(), before.size());
  std::size_t edited_meshes = 0;
  for (const auto& [name, shown] : after) {
    EXPECT_EQ(shown.hash, before.at(name).hash);
    EXPECT_EQ(shown.position, before.at(name).position);
    if (before.at(name).there && edited.contains(name))
      edited_meshes += edited.at(name).hash != shown.hash;
  }
  EXPECT_GT(edited_meshes, 5u);
}

TEST(Edits, TakenBackBeforeTheyAreDrawnChangeNothing) {
  const auto scene = settled_scene();
  const auto before = shown_in(*scene);
  world::Edits edits;
  expect_ok(edits.raise(state_of(*scene).facts.world, {kEditedBlock, {31, 0, 31}}, 40, 10));
  scene->edit(edits);
  tick_at(*scene, pose_at(256, 256));
  EXPECT_GT(count_stale(*scene), 0u);
  scene->edit({});
  tick_at(*scene, pose_at(256, 256));
  EXPECT_EQ(count_stale(*scene), 0u);
  for (const auto& [name, shown] : shown_in(*scene)) {
    EXPECT_EQ(shown.hash, before.at(name).hash);
    EXPECT_EQ(shown.mesh, before.at(name).mesh);
  }
  tick_until_fresh(*scene, pose_at(256, 256));
}

// Every byte of the meshes that are drawn.
std::map<Name, std::uint64_t> drawn_bytes(const Scene& scene) {
  std::map<Name, std::uint64_t> bytes;
  const State& s = state_of(scene);
  for (const auto& [name, shown] : shown_in(scene)) {
    if (!shown.there) continue;
    const synthesis::MeshRecord& record = *s.supply.get(shown.mesh);
    bytes[name] = core::combine(core::hash_bytes(s.memory->vertex_bytes(record.range)),
                                record.key.parameters_hash);
  }
  return bytes;
}

// A road of the world lies below edits, and a camera that follows it sees no hole.
TEST(Edits, LieOverRoadsOfTheWorldWhileACameraFollowsOne) {
  models::Registry registry = models::make_standard_registry();
  world::World world = paper_world(registry);
  const double size_m = world.block_size_m();
  world::Road road;
  for (int i = 0; i < 6; ++i)
    road.points_m.emplace_back((252 + 2 * i) * size_m, (256 + i % 2) * size_m);
  world.shaped.roads.push_back(road);
  ASSERT_TRUE(world::shape_ground(world));
  const auto scene = make_scene(world, small_settings(), std::move(registry));
  scene->settle(pose_at(254, 256));
  const auto plain = shown_in(*scene);
  world::Edits edits = scene->edits();
  EXPECT_TRUE(edits.empty());
  for (int tick = 0; tick < 90; ++tick) {
    core::CameraPose pose = pose_at(254, 256, 0.02 * tick);
    pose.position.local.x += 3.0 * tick;
    if (tick == 30) expect_ok(edits.raise(world, {{256, 256}, {31, 0, 31}}, 20, 5));
    if (tick == 60) edits = {};
    if (tick == 30 || tick == 60) scene->edit(edits);
    state_of(*scene).supply.wait();
    tick_at(*scene, pose);
    EXPECT_EQ(scene->statistics().drawn.holes, 0u) << "tick " << tick;
  }
  tick_until_fresh(*scene, pose_at(254, 256));
  const auto again = shown_in(*scene);
  std::size_t compared = 0;
  for (const auto& [name, shown] : again) {
    if (!plain.contains(name)) continue;
    EXPECT_EQ(shown.hash, plain.at(name).hash);
    ++compared;
  }
  EXPECT_GT(compared, 100u);
}

TEST(Edits, ASceneThatStartsWithEditsEqualsOneThatGotThemLater) {
  models::Registry registry = models::make_standard_registry();
  world::World world = paper_world(registry);
  world::Edits edits;
  expect_ok(edits.remove(world, {kEditedBlock, 3}));
  expect_ok(edits.raise(world, {kEditedBlock, {31, 0, 31}}, 40, 10));
  expect_ok(edits.move(world, registry, {kEditedBlock, 5}, {{257, 256}, {1, 0, 1}}));
  const auto later = settled_scene();
  later->edit(edits);
  tick_until_fresh(*later, pose_at(256, 256));
  later->settle(pose_at(256, 256));
  world::set_edits(world, edits.layer());
  const auto first = make_scene(world, small_settings(), std::move(registry));
  first->settle(pose_at(256, 256));
  const auto restarted = shown_in(*first), ran = shown_in(*later);
  ASSERT_EQ(restarted.size(), ran.size());
  for (const auto& [name, shown] : restarted) {
    EXPECT_EQ(shown.hash, ran.at(name).hash);
    EXPECT_EQ(shown.position, ran.at(name).position);
  }
  const auto a = drawn_bytes(*first), b = drawn_bytes(*later);
  const auto level = [&](const Scene& scene, const Shown& shown) {
    return state_of(scene).supply.get(shown.mesh)->key.level;
  };
  std::size_t compared = 0, ground = 0;
  for (const auto& [name, hash] : a) {
    if (!b.contains(name)) continue;
    if (level(*first, restarted.at(name)) != level(*later, ran.at(name))) continue;
    EXPECT_EQ(hash, b.at(name));
    ++compared;
    ground += std::get<3>(name) == kTerrainIndex;
  }
  EXPECT_GT(compared, 100u);
  EXPECT_GT(ground, 4u);
}

TEST(Edits, AFelledTreeStaysFelledAfterReturn) {
  const auto scene = settled_scene();
  world::Edits edits;
  expect_ok(edits.remove(state_of(*scene).facts.world, {kEditedBlock, 3}));
  scene->edit(edits);
  for (const std::int32_t x : {256, 200, 256}) {
    scene->settle(pose_at(x, 256));
    tick_at(*scene, pose_at(x, 256));
  }
  const auto shown = shown_in(*scene);
  EXPECT_TRUE(shown.contains({kEditedBlock.x, kEditedBlock.z, 0, 4}));
  EXPECT_FALSE(shown.contains({kEditedBlock.x, kEditedBlock.z, 0, 3}));
}

TEST(Edits, APlacedModelAppearsAndItsBlockGetsNoCoarser) {
  const auto scene = settled_scene();
  const WorldFacts& facts = state_of(*scene).facts;
  const world::Scatter& rocks = facts.world.scatter[1];
  world::Edits edits;
  models::Parameters rock = world::scatter_parameters(facts.registry, rocks);
  rock.set_integer(0, 99);
  const auto placed = expect_ok(edits.place(facts.world, facts.registry,
                                            {rocks.model, rock, {kEditedBlock, {30, 0, 20}}, 0}));
  scene->edit(edits);
  const std::vector<visibility::NodeCoord> before = state_of(*scene).draws.shown_nodes;
  for (int i = 0; i < 5; ++i) {
    state_of(*scene).supply.wait();
    tick_at(*scene, pose_at(256, 256));
    EXPECT_TRUE(state_of(*scene).draws.shown_nodes == before) << "tick " << i;
  }
  const Shown rock_shown =
      shown_in(*scene).at({kEditedBlock.x, kEditedBlock.z, 0, world::kPlacedIndex + placed.id});
  EXPECT_TRUE(rock_shown.there);
  EXPECT_EQ(rock_shown.position.x, 30);
}

// A wall between the camera and the ground behind it hides that ground.
TEST(Edits, ARaisedRidgeHidesTheGroundBehindIt) {
  core::CameraPose pose = pose_at(256, 256);  // looks along −z
  SceneSettings settings = small_settings();
  settings.view_distance_m = 1000;
  const auto scene = make_scene(settings);
  world::Edits edits;
  const world::World& world = state_of(*scene).facts.world;
  models::GroundEdit flat;  // so that nothing else hides anything
  flat.change = models::GroundChange::kFlatten;
  flat.square = true;
  flat.centre = {kEditedBlock, {31, 0, 31}};
  flat.radius_m = 1500;
  flat.height_m = 20;
  expect_ok(edits.edit_ground(world, flat));
  pose.position.local.y = 30;
  scene->edit(edits);
  scene->settle(pose);
  tick_at(*scene, pose);
  const std::uint32_t seen = scene->statistics().drawn.nodes_in_view;
  const std::uint32_t hidden = scene->statistics().nodes_hidden;
  models::GroundEdit wall;
  wall.square = true;
  wall.radius_m = 60;
  wall.height_m = 90;
  wall.falloff = 0.4;
  for (int i = -4; i <= 4; ++i) {
    wall.centre = {{256, 252}, {31.5 + 90.0 * i, 0, 0}};
    expect_ok(edits.edit_ground(world, wall));
  }
  scene->edit(edits);
  scene->settle(pose);
  tick_at(*scene, pose);
  EXPECT_GT(scene->statistics().nodes_hidden, hidden);
  EXPECT_LT(scene->statistics().drawn.nodes_in_view, seen);
  EXPECT_EQ(scene->statistics().drawn.holes, 0u);
}

// Light is baked up to 5.5 radii from an edit: of what an edit renews, most has only other light.
TEST(Edits, NewLightWaitsForNewHeights) {
  const core::CameraPose pose = pose_at(256, 256);
  const auto scene = settled_scene(pose);
  State& s = state_of(*scene);
  world::Edits edits;
  expect_ok(edits.raise(s.facts.world, {{256, 255}, {31, 0, 31}}, 60, 8));
  scene->edit(edits);
  tick_at(*scene, pose);
  std::size_t heights = 0, light = 0;
  s.entities.each<const QuadtreeNode, const MeshPlacement, const LodErrors, const MeshSource,
                  const MeshDemand>(
      [&](auto rows, auto, auto placed, auto detail, auto source, auto demand) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
          const MeshDemand& d = demand[i];
          if (!d.stale || d.in_view_tick + 1 != s.clock.tick || d.requested_level == kNoLevel)
            continue;
          const auto key = key_of(placed[i], detail[i], source[i], d.requested_level);
          const auto* record = s.supply.get(s.supply.find(key));
          if (record == nullptr) continue;
          EXPECT_EQ(synthesis::is_visible(record->rank.group()), !d.stale_light);
          ++(d.stale_light ? light : heights);
        }
      });
  EXPECT_GT(heights, 0U);
  EXPECT_GT(light, 0U);
  tick_until_fresh(*scene, pose);
}

TEST(Edits, ManyEditsWhileFlyingLeaveTheSceneConsistent) {
  auto scene = make_scene(small_settings());
  scene->settle(pose_at(256, 256));
  std::mt19937 random(4);
  std::vector<world::Edits> history{world::Edits()};
  const auto below = [&random](unsigned n) { return static_cast<double>(random() % n); };
  for (int i = 0; i < 150; ++i) {
    const world::World& world = state_of(*scene).facts.world;
    const models::Registry& registry = state_of(*scene).facts.registry;
    world::Edits edits = scene->edits();
    const core::BlockCoord block{254 + static_cast<std::int32_t>(random() % 8),
                                 254 + static_cast<std::int32_t>(random() % 5)};
    const core::WorldPosition at{block, {below(63) + 0.25, 0, below(63) + 0.75}};
    const auto index = static_cast<std::uint32_t>(random() % 60);
    switch (random() % 6) {
      case 0:
        (void)edits.remove(world, {block, index});
        break;
      case 1:
        (void)edits.move(world, registry, {block, index}, at);
        break;
      case 2:
        (void)edits.raise(world, at, 1.0 + below(50), 12.0 - below(24));
        break;
      case 3:
        (void)edits.flatten(world, at, 1.0 + below(50), 40);
        break;
      case 4:
        edits = history[random() % history.size()];
        break;
      default:
        (void)edits.restore({block, index});
        break;
    }
    history.push_back(edits);
    scene->edit(std::move(edits));
    const auto pose = pose_at(256 + i / 40, 256, 0.05 * i);
    tick_at(*scene, pose);
    if (i % 10 == 0) expect_consistent(*scene);
  }
  tick_until_fresh(*scene, pose_at(259, 256));
}

}  // namespace
}  // namespace psygen::scene
