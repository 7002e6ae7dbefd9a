// Replacing a world while it is drawn.
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "engine/scene/objects/components.hpp"
#include "engine/world/files/text_edit.hpp"
#include "tests/engine/scene/fixture.hpp"
#include "tests/engine/scene/forwarding_type.hpp"

namespace psygen::scene {
namespace {

std::string text_of(const std::string& file) {
  std::ifstream in(source_file("game/worlds/" + file));
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string replaced(std::string text, const std::string& what, std::string_view by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

struct Parsed {
  models::Registry registry = models::make_standard_registry();
  world::World world;
  explicit Parsed(const std::string& text) {
    auto read = world::parse_world(text, "test.toml", registry);
    EXPECT_TRUE(read) << read.error().message;
    world = std::move(*read);
  }
};

std::unique_ptr<Scene> scene_of(const std::string& text, const SceneSettings& settings) {
  Parsed parsed(text);
  return make_scene(parsed.world, settings, std::move(parsed.registry));
}

core::Result<void> set(Scene& scene, const std::string& text) {
  Parsed parsed(text);
  return scene.set_world(std::move(parsed.world), std::move(parsed.registry));
}

// The nodes in view and their models, by index.
std::set<std::uint32_t> seen_in(Scene& scene) {
  const State& s = state_of(scene);
  std::set<std::uint32_t> seen;
  for (const ChosenNode& node : s.view.chosen) {
    if (!node.in_view) continue;
    seen.insert(node.entity.index);
    const auto models = s.entities.children(*s.entities.get<ecs::Children>(node.entity));
    for (const ecs::Entity model : models)
      seen.insert(model.index);
  }
  return seen;
}

// All mesh entities of a scene, by place: type, position, and the drawn mesh if it is in view.
// Others keep their meshes, which belong to the present world.
using What = std::tuple<std::string, std::uint64_t, float, float, float, int, std::uint64_t>;
std::multimap<std::tuple<int, int, std::uint32_t>, What> contents_of(Scene& scene) {
  std::multimap<std::tuple<int, int, std::uint32_t>, What> contents;
  const State& s = state_of(scene);
  const std::set<std::uint32_t> seen = seen_in(scene);
  std::as_const(state_of(scene).entities)
      .each<const MeshPlacement, const MeshSource, const MeshDemand, const Mesh>(
          [&](std::span<const ecs::Entity> entities, std::span<const MeshPlacement> placed,
              std::span<const MeshSource> sources, std::span<const MeshDemand> demands,
              std::span<const Mesh> meshes) {
            for (std::size_t i = 0; i < placed.size(); ++i) {
              const bool shown = demands[i].drawn_level != kNoLevel;
              const bool compared = shown && seen.contains(entities[i].index);
              const synthesis::MeshRecord* drawn =
                  compared ? s.supply.ready(meshes[i].handle) : nullptr;
              const MeshPlacement& at = placed[i];
              contents.emplace(
                  std::tuple{at.block.x, at.block.z, sources[i].index},
                  What{s.facts.registry[sources[i].model].name(), sources[i].parameters_hash,
                       at.position.x, at.position.y, at.box_half_extent.y,
                       compared ? demands[i].drawn_level : kNoLevel,
                       drawn != nullptr ? drawn->key.parameters_hash : 0});
            }
          });
  return contents;
}

std::size_t drawn_in(Scene& scene) {
  std::size_t drawn = 0;
  for (const auto& [place, what] : contents_of(scene))
    drawn += std::get<5>(what) != kNoLevel;
  return drawn;
}

bool draws_of_a_world_before(Scene& scene) {
  bool any = false;
  std::as_const(state_of(scene).entities)
      .each<const MeshDemand>(
          [&](std::span<const ecs::Entity>, std::span<const MeshDemand> demands) {
            for (const MeshDemand& demand : demands)
              any |= demand.drawn_level != kNoLevel && demand.stale;
          });
  return any;
}

class SetWorld : public testing::Test {
 protected:
  // A scene of `before` that gets `after` equals a scene of `after`.
  void expect_like_new(const std::string& before, const std::string& after) {
    const auto changed = scene_of(before, settings_);
    changed->settle(pose_);
    ASSERT_TRUE(set(*changed, after));
    changed->settle(pose_);
    expect_consistent(*changed);
    EXPECT_FALSE(draws_of_a_world_before(*changed));
    const auto fresh = scene_of(after, settings_);
    fresh->settle(pose_);
    EXPECT_EQ(contents_of(*changed), contents_of(*fresh));
  }

  const SceneSettings settings_ = small_settings();
  const core::CameraPose pose_ = pose_at(256, 256);
  const std::string paper_ = text_of("paper.toml"), species_ = text_of("five_species.toml");
};

TEST_F(SetWorld, OtherParametersOfTreesLeadToTheSameSceneAsANewOne) {
  expect_like_new(paper_, replaced(paper_, "branches = [2, 4]", "branches = [3, 3]"));
}

// Instances, and the impostors of other species, are kept.
TEST_F(SetWorld, OneSpeciesOfManyLeadsToTheSameSceneAsANewOne) {
  expect_like_new(species_, replaced(species_, "size_m = [1.9, 3.0]", "size_m = [1.9, 2.4]"));
  expect_like_new(species_, replaced(species_, "flare = 0.9", "flare = 1.1"));
  expect_like_new(species_, replaced(species_, "max_slope_deg = 38", "max_slope_deg = 12"));
}

// A world with two types of trees and rocks that counts synthesised meshes.
struct Counting {
  std::atomic<int> oaks = 0, firs = 0, rocks = 0;
  models::Registry standard = models::make_standard_registry();

  static std::string text(const std::string& of_firs) {
    return "format = 1\n[world]\nname = \"counted\"\nseed = 3\nblocks = [512, 512]\n"
           "[terrain]\noctaves = 5\n[[scatter]]\nmodel = \"oak\"\ncount = 4\n"
           "[[scatter]]\nmodel = \"rock2\"\ncount = 6\n"
           "[[scatter]]\nmodel = \"fir\"\ncount = 4\n" +
           of_firs;
  }
  std::pair<world::World, models::Registry> parsed(const std::string& of_firs) {
    models::Registry registry = models::make_standard_registry();
    const models::ModelType& tree =
        standard[static_cast<models::ModelIndex>(standard.find("tree"))];
    const models::ModelType& rock =
        standard[static_cast<models::ModelIndex>(standard.find("rock"))];
    EXPECT_TRUE(registry.add(std::make_unique<CountingType>("oak", tree, oaks)));
    EXPECT_TRUE(registry.add(std::make_unique<CountingType>("rock2", rock, rocks)));
    EXPECT_TRUE(registry.add(std::make_unique<CountingType>("fir", tree, firs)));
    auto world = world::parse_world(text(of_firs), "counted.toml", registry);
    EXPECT_TRUE(world) << world.error().message;
    return {*std::move(world), std::move(registry)};
  }
};

// The entities of an instance of a scatter, with their meshes.
std::map<std::uint32_t, std::pair<ecs::Entity, synthesis::MeshHandle>> entities_of(
    Scene& scene, const std::string& type) {
  std::map<std::uint32_t, std::pair<ecs::Entity, synthesis::MeshHandle>> found;
  const State& s = state_of(scene);
  std::as_const(s.entities)
      .each<const MeshSource, const Mesh>([&](std::span<const ecs::Entity> rows,
                                              std::span<const MeshSource> sources,
                                              std::span<const Mesh> meshes) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
          if (sources[i].index < kMergedIndex && s.facts.registry[sources[i].model].name() == type)
            found.emplace(rows[i].index, std::pair{rows[i], meshes[i].handle});
        }
      });
  return found;
}

TEST_F(SetWorld, KeptMeshesAreNotSynthesisedAgain) {
  Counting counting;
  auto [world, registry] = counting.parsed("iterations = [3, 4]\n");
  const auto scene = make_scene(world, settings_, std::move(registry));
  scene->settle(pose_);
  const auto oaks = entities_of(*scene, "oak"), rocks = entities_of(*scene, "rock2"),
             firs = entities_of(*scene, "fir");
  ASSERT_GT(oaks.size(), 20U);
  counting.oaks = counting.rocks = counting.firs = 0;
  auto [next, types] = counting.parsed("iterations = [3, 3]\n");
  auto prepared = prepare_world(std::move(next), std::move(types), scene->snapshot());
  ASSERT_TRUE(prepared);
  EXPECT_EQ(counting.oaks, 0) << "for pictures";
  EXPECT_EQ(counting.rocks, 0);
  EXPECT_GT(counting.firs, 0);
  for (const auto& [block, models] : prepared->models) {
    for (const world::Placement& placed : models)
      ASSERT_EQ(prepared->facts.registry[placed.model].name(), "fir") << "placed anew";
  }
  ASSERT_TRUE(scene->set_world(std::move(*prepared)));
  scene->settle(pose_);
  EXPECT_EQ(counting.oaks, 0) << "meshes of near ones";
  EXPECT_EQ(counting.rocks, 0);
  EXPECT_EQ(entities_of(*scene, "oak"), oaks);
  EXPECT_EQ(entities_of(*scene, "rock2"), rocks);
  EXPECT_NE(entities_of(*scene, "fir"), firs);
}

TEST_F(SetWorld, GrassThatFollowsTheSlopeLeadsToTheSameSceneAsANewOne) {
  const std::string meadow = paper_ + "\n[[scatter]]\nmodel = \"grass\"\ncount = 30\n";
  expect_like_new(meadow, meadow + "height_m = [0.5, 0.6]\n");
}

TEST_F(SetWorld, OtherGroundLeadsToTheSameSceneAsANewOne) {
  expect_like_new(paper_, replaced(paper_, "octaves = 9", "octaves = 9\nrelief_m = 40"));
}

TEST_F(SetWorld, MoreModelsLeadToTheSameSceneAsANewOne) {
  expect_like_new(paper_, replaced(paper_, "count = 23", "count = 31"));
}

TEST_F(SetWorld, OtherMasksLeadToTheSameSceneAsANewOne) {
  const std::string thin = replaced(paper_, "count = 23", "count = 23\nmask_noise_m = 60");
  expect_like_new(paper_, thin);
  expect_like_new(thin, replaced(thin, "mask_noise_m = 60", "mask_noise_m = 60\nmask_share = 0.2"));
}

TEST_F(SetWorld, AnotherSeaLevelMovesWhatStandsByTheWater) {
  const std::string wet =
      replaced(paper_, "count = 23", "count = 23\nmax_depth_m = 0") + "\n[water]\nlevel_m = 55\n";
  expect_like_new(wet, replaced(wet, "level_m = 55", "level_m = 62"));
}

std::string with_road(const std::string& text, const char* width = "8") {
  return text +
         "\n[[road]]\npoints_m = [[15900, 16160], [16160, 16100], [16300, 16200]]\nwidth_m = " +
         width + "\n";
}

TEST_F(SetWorld, AddingOrRemovingARoadLeadsToTheSameSceneAsANewOne) {
  expect_like_new(paper_, with_road(paper_));
  expect_like_new(with_road(paper_), with_road(paper_, "12"));
  expect_like_new(with_road(paper_), paper_);
}

// Equal roads are not computed again when colours change.
TEST_F(SetWorld, LooksOfAWorldWithARoadAreLooksOnly) {
  const std::string road = with_road(paper_);
  const auto scene = scene_of(road, settings_);
  Parsed after(road + "\n[palette]\ndry = [0.3, 0.2, 0.1]\n");
  const auto prepared =
      prepare_world(std::move(after.world), std::move(after.registry), scene->snapshot());
  ASSERT_TRUE(prepared);
  EXPECT_TRUE(prepared->looks_only);
}

TEST_F(SetWorld, ANewSkyIsUsedAtOnceAndNothingElseChanges) {
  const auto scene = scene_of(paper_, settings_);
  const WorldFacts& facts = state_of(*scene).facts;
  world::Sky sky = facts.world.sky;
  sky.cloud_cover = 0.9;
  sky.visibility_m = 40;
  const render::Light before = facts.light;
  ASSERT_TRUE(scene->set_sky(sky));
  EXPECT_EQ(facts.world.sky, sky);
  EXPECT_FLOAT_EQ(facts.light.cloud_cover, 0.9F);
  EXPECT_GT(facts.light.haze_density, before.haze_density);
  sky.exposure = 0;
  EXPECT_FALSE(scene->set_sky(sky));
  sky.exposure = 1;
  sky.haze_colour.y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(scene->set_sky(sky));
  EXPECT_FLOAT_EQ(facts.light.cloud_cover, 0.9F);
}

// Where the palette decides the placement of models, it is more than looks.
TEST_F(SetWorld, OtherKindsOfGroundLeadToTheSameSceneAsANewOne) {
  const std::string dry = replaced(paper_, "count = 23", "count = 23\non_ground = [\"dry\"]");
  expect_like_new(dry, dry + "\n[palette]\ndry_start_m = 20\n");
}

TEST_F(SetWorld, OtherTypesLeadToTheSameSceneAsANewOne) {
  expect_like_new(paper_, species_);
  expect_like_new(species_, paper_);
}

TEST_F(SetWorld, OneSpeciesMoreOrLessLeadsToTheSameSceneAsANewOne) {
  const std::string oak = replaced(*world::table_text(species_, {"species", 0}), "oak", "new_oak");
  const auto more = world::with_table_appended(species_, {"species"}, oak);
  ASSERT_TRUE(more) << more.error().message;
  expect_like_new(species_, *more);
  expect_like_new(*more, species_);
  const auto planted =
      world::with_table_appended(*more, {"scatter"}, "model = \"new_oak\"\ncount = 4\n");
  ASSERT_TRUE(planted) << planted.error().message;
  expect_like_new(species_, *planted);
}

TEST_F(SetWorld, BlocksOfAnotherSizeLeadToTheSameSceneAsANewOne) {
  expect_like_new(paper_, replaced(paper_, "block_vertices = 64", "block_vertices = 32"));
}

TEST_F(SetWorld, OldMeshesAreDrawnUntilTheNewOnesAreReady) {
  const auto scene = scene_of(paper_, settings_);
  scene->settle(pose_);
  const std::size_t drawn = drawn_in(*scene);
  ASSERT_GT(drawn, 100u);
  ASSERT_TRUE(set(*scene, replaced(paper_, "branches = [2, 4]", "branches = [3, 3]")));
  EXPECT_EQ(drawn_in(*scene), drawn);
  tick_at(*scene, pose_);
  EXPECT_EQ(drawn_in(*scene), drawn);
  EXPECT_EQ(scene->statistics().drawn.holes, 0u);
}

// Ticks until there are no requests.
void tick_until_quiet(Scene& scene, const core::CameraPose& pose) {
  for (int quiet = 0; quiet < 16;) {
    tick_at(scene, pose);
    state_of(scene).supply.wait();
    quiet = scene.statistics().meshes.requests == 0 && scene.statistics().meshes.completed == 0
                ? quiet + 1
                : 0;
  }
}

// The triangles of drawn models, whether any belongs to the replaced world, and by how many levels
// the coarsest is too coarse.
struct DrawnModels {
  std::uint64_t triangles = 0;
  bool stale = false;
  int coarser = 0;
};
DrawnModels models_drawn(Scene& scene) {
  DrawnModels drawn;
  std::as_const(state_of(scene).entities)
      .each<const MeshDemand, const Mesh, const MeshSource>(
          [&](std::span<const ecs::Entity>, std::span<const MeshDemand> demands,
              std::span<const Mesh> meshes, std::span<const MeshSource> sources) {
            for (std::size_t i = 0; i < demands.size(); ++i) {
              const MeshDemand& demand = demands[i];
              if (sources[i].index >= kMergedIndex || demand.drawn_level == kNoLevel ||
                  demand.wanted_level == kNoLevel)
                continue;
              if (const auto* record = state_of(scene).supply.ready(meshes[i].handle))
                drawn.triangles += record->size.triangle_count();
              drawn.stale |= demand.stale;
              drawn.coarser = std::max(drawn.coarser, demand.drawn_level - demand.wanted_level);
            }
          });
  return drawn;
}

TEST_F(SetWorld, ADraftIsCoarseAndGetsFineWhenItEnds) {
  const auto scene = scene_of(paper_, settings_);
  scene->settle(pose_);
  tick_until_quiet(*scene, pose_);
  const DrawnModels before = models_drawn(*scene);
  EXPECT_EQ(before.coarser, 0);
  ASSERT_TRUE(set(*scene, replaced(paper_, "branches = [2, 4]", "branches = [3, 3]")));
  state_of(*scene).input.draft = true;
  tick_until_quiet(*scene, pose_);
  const DrawnModels draft = models_drawn(*scene);
  EXPECT_FALSE(draft.stale) << "everything is of the new world";
  EXPECT_GT(draft.coarser, 0);
  EXPECT_LT(draft.triangles, before.triangles);
  state_of(*scene).input.draft = false;
  tick_until_quiet(*scene, pose_);
  const DrawnModels fine = models_drawn(*scene);
  EXPECT_FALSE(fine.stale);
  EXPECT_EQ(fine.coarser, 0);
  EXPECT_GT(fine.triangles, draft.triangles);
  expect_consistent(*scene);
}

// In virtual time the modelers had no time yet: the main thread makes the meshes.
TEST_F(SetWorld, ADraftRenewsTheNearestModelsInTheNextFrame) {
  const auto scene = scene_of(paper_, settings_);
  scene->settle(pose_);
  tick_until_quiet(*scene, pose_);
  ASSERT_TRUE(set(*scene, replaced(paper_, "branches = [2, 4]", "branches = [3, 3]")));
  const auto stale_in_view = [&] {
    std::size_t stale = 0;
    const std::uint32_t tick = state_of(*scene).clock.tick - 1;
    std::as_const(state_of(*scene).entities)
        .each<const MeshDemand, const MeshSource>([&](std::span<const ecs::Entity>,
                                                      std::span<const MeshDemand> demands,
                                                      std::span<const MeshSource> sources) {
          for (std::size_t i = 0; i < demands.size(); ++i)
            stale += sources[i].index < kMergedIndex && demands[i].in_view_tick == tick &&
                     demands[i].stale;
        });
    return stale;
  };
  const std::size_t before = stale_in_view();
  ASSERT_GT(before, 0u);
  state_of(*scene).input.draft = true;
  tick_at(*scene, pose_);
  EXPECT_LT(stale_in_view(), before);
}

TEST_F(SetWorld, MeshesOfAnUndoneChangeAreStillInTheCache) {
  const auto scene = scene_of(paper_, settings_);
  scene->settle(pose_);
  const auto before = contents_of(*scene);
  ASSERT_TRUE(set(*scene, replaced(paper_, "branches = [2, 4]", "branches = [3, 3]")));
  scene->settle(pose_);
  ASSERT_NE(contents_of(*scene), before);
  ASSERT_TRUE(set(*scene, paper_));
  EXPECT_EQ(scene->settle(pose_), 0u);
  EXPECT_EQ(contents_of(*scene), before);
}

TEST_F(SetWorld, ARejectedWorldChangesNothing) {
  const auto scene = scene_of(paper_, settings_);
  scene->settle(pose_);
  const auto before = contents_of(*scene);
  Parsed crowded(replaced(replaced(paper_, "cell_m = 1", "cell_m = 0.1"),
                          "count = 40\nsubdivisions = 2", "count = 15000\nsubdivisions = 0"));
  const auto refused = scene->set_world(std::move(crowded.world), std::move(crowded.registry));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::ErrorCode::kOverBudget);
  EXPECT_EQ(contents_of(*scene), before);
  tick_at(*scene, pose_);
  expect_consistent(*scene);
}

TEST_F(SetWorld, EditsAreKept) {
  const auto scene = scene_of(paper_, settings_);
  scene->settle(pose_);
  Parsed parsed(paper_);
  world::Edits edits = scene->edits();
  ASSERT_TRUE(edits.remove(parsed.world, {{256, 256}, 3}));
  scene->edit(edits);
  scene->settle(pose_);
  const std::size_t left = contents_of(*scene).count({256, 256, 3});
  ASSERT_EQ(left, 0u);
  ASSERT_TRUE(set(*scene, replaced(paper_, "count = 40", "count = 41")));
  scene->settle(pose_);
  EXPECT_EQ(contents_of(*scene).count({256, 256, 3}), 0u);
}

// The newest world wins, however often it changes.
TEST_F(SetWorld, ChangesInEveryTickEndWithTheLastOne) {
  const auto scene = scene_of(paper_, settings_);
  scene->settle(pose_);
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(set(*scene, replaced(paper_, "branches = [2, 4]",
                                     i % 2 == 0 ? "branches = [2, 2]" : "branches = [2, 3]")));
    tick_at(*scene, pose_);
    EXPECT_EQ(scene->statistics().drawn.holes, 0u);
    expect_consistent(*scene);
  }
  ASSERT_TRUE(set(*scene, paper_));
  scene->settle(pose_);
  const auto fresh = scene_of(paper_, settings_);
  fresh->settle(pose_);
  EXPECT_EQ(contents_of(*scene), contents_of(*fresh));
}

std::string with_species(int count, const char* more = "") {
  std::string text =
      "format = 1\n[world]\nname = \"w\"\nseed = 1\nblocks = [0, 0]\n[terrain]\nrelief_m = 80\n";
  for (int i = 0; i < count; ++i)
    text += "[[species]]\nname = \"kind_" + std::to_string(i) +
            "\"\naxiom = \"T\"\niterations = 3\nbranches = 3\nspread = 1\n"
            "[[species.kind]]\nsymbol = \"T\"\nleaves = \"none\"\n"
            "[[species.kind]]\nsymbol = \"B\"\nangle_deg = 40\n"
            "[[species.rule]]\nfrom = \"T\"\nto = \"B*\"\n";
  text += "[[scatter]]\nmodel = \"rock\"\ncount = 5\n";
  for (int i = 0; i < count; ++i)
    text += "[[scatter]]\nmodel = \"kind_" + std::to_string(i) + "\"\ncount = 2\n";
  return text + more;
}

// The types of the placed models that a scene shows in a block.
std::vector<std::string> placed_in(Scene& scene, core::BlockCoord block) {
  std::vector<std::string> names;
  for (const auto& [place, what] : contents_of(scene)) {
    const auto [x, z, index] = place;
    if (core::BlockCoord{x, z} == block && index > world::kPlacedIndex &&
        index < world::kFilePlacedIndex)
      names.push_back(std::get<0>(what));
  }
  return names;
}

TEST_F(SetWorld, PlacedModelsKeepTheirTypesWhenSpeciesGoAndReturn) {
  const auto scene = scene_of(with_species(20), settings_);
  scene->settle(pose_);
  world::Edits edits;
  for (const char* name : {"rock", "kind_3", "kind_19"}) {
    const auto model = static_cast<models::ModelIndex>(scene->registry().find(name));
    ASSERT_TRUE(edits.place(scene->world(), scene->registry(),
                            {model,
                             models::default_parameters(scene->registry()[model]),
                             {{256, 256}, {30, 0, 30}},
                             0}));
  }
  using Names = std::vector<std::string>;
  scene->edit(edits);
  scene->settle(pose_);
  EXPECT_EQ(placed_in(*scene, {256, 256}), (Names{"rock", "kind_3", "kind_19"}));
  const std::pair<int, Names> worlds[] = {
      {4, {"rock", "kind_3"}}, {0, {"rock"}}, {20, {"rock", "kind_3", "kind_19"}}};
  for (const auto& [count, names] : worlds) {
    ASSERT_TRUE(set(*scene, with_species(count)));
    scene->settle(pose_);
    expect_consistent(*scene);
    EXPECT_EQ(placed_in(*scene, {256, 256}), names);
    scene->edit(edits);  // of the first registry
    scene->settle(pose_);
    EXPECT_EQ(placed_in(*scene, {256, 256}), names);
    EXPECT_EQ(scene->edits().counts().placed, 3U);
  }
}

TEST_F(SetWorld, EveryReplacementEmitsOneEventThatTellsWhatChanged) {
  const auto scene = scene_of(with_species(2), settings_);
  scene->settle(pose_);
  const ecs::Entity object = scene->entities().create<Transform>(1).entities[0];
  scene->entities().get<Transform>(object)->position = {{100, 10}, {62, 5, 1}};
  ecs::EventReader<WorldChanged> reader = state_of(*scene).events.world_changed.reader();
  const auto expect = [&](const std::string& text, bool ground, bool models, bool looks) {
    const std::uint64_t revision = scene->world().revision.number;
    ASSERT_TRUE(set(*scene, text));
    EXPECT_NE(scene->world().revision.number, revision);
    std::vector<WorldChanged> seen;
    reader.drain([&](std::span<const WorldChanged> events) {
      seen.insert(seen.end(), events.begin(), events.end());
    });
    ASSERT_EQ(seen.size(), 1U);
    EXPECT_EQ(seen[0].ground, ground);
    EXPECT_EQ(seen[0].models, models);
    EXPECT_EQ(seen[0].looks, looks);
    EXPECT_EQ(seen[0].block_m_before, 63);
  };
  expect(with_species(2, "[sky]\ncloud_cover = 0.1\n"), false, false, true);
  expect(with_species(1, "[sky]\ncloud_cover = 0.1\n"), false, true, false);
  expect(replaced(with_species(1, "[sky]\ncloud_cover = 0.1\n"), "relief_m = 80", "relief_m = 90"),
         true, true, false);
  expect(replaced(with_species(1), "blocks = [0, 0]", "blocks = [0, 0]\nblock_vertices = 32"), true,
         true, true);
  const core::WorldPosition at = scene->entities().get<Transform>(object)->position;
  EXPECT_EQ(at.block, (core::BlockCoord{205, 20}));  // 6362 m and 631 m
  EXPECT_DOUBLE_EQ(at.local.x, 7);
  EXPECT_DOUBLE_EQ(at.local.z, 11);
}

}  // namespace
}  // namespace psygen::scene
