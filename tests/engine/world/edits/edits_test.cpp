#include "engine/world/edits/edits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "engine/models/terrain/terrain.hpp"
#include "engine/world/placement.hpp"
#include "tests/engine/world/edits/edited_world.hpp"

namespace psygen::world {
namespace {

using testing::EditedWorld;
using testing::hash_of;
using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class EditsTest : public ::testing::Test, protected EditedWorld {};

TEST_F(EditsTest, ARemovedModelIsGoneAndTheOthersDoNotChange) {
  const std::vector<Placement> before = placements({2, 3});
  const std::uint32_t index = before[before.size() / 2].index;
  ASSERT_TRUE(edits.remove(world, {{2, 3}, index}));
  apply();
  const std::vector<Placement> after = placements({2, 3});
  ASSERT_EQ(after.size() + 1, before.size());
  for (const Placement& placement : after) {
    EXPECT_NE(placement.index, index);
    const auto same = std::ranges::find(before, placement.index, &Placement::index);
    ASSERT_NE(same, before.end());
    EXPECT_EQ(same->position, placement.position);
    EXPECT_EQ(same->parameters, placement.parameters);
  }
  EXPECT_EQ(placements({3, 3}).size(), unedited({3, 3}).size());
  ASSERT_TRUE(edits.restore({{2, 3}, index}));
  EXPECT_TRUE(edits.empty());
}

TEST_F(EditsTest, AMovedModelKeepsItsParametersAndStandsOnTheGroundOfItsNewPlace) {
  const Placement tree = placements({2, 3})[4];
  const auto moved = edits.move(world, registry, {{2, 3}, tree.index}, {{4, 3}, {10, 0, 20.5}});
  ASSERT_TRUE(moved) << moved.error().message;
  EXPECT_EQ(moved->block, (core::BlockCoord{4, 3}));
  apply();
  const std::vector<Placement> there = placements({4, 3});
  const Placement& placed = there.back();
  EXPECT_EQ(placed.index, kPlacedIndex + moved->id);
  EXPECT_EQ(placed.model, tree.model);
  EXPECT_EQ(placed.position.x, 10);
  EXPECT_EQ(placed.position.z, 20.5F);
  EXPECT_NEAR(placed.position.y, models::ground_height_m(world.terrain, {4, 3}, 10, 20.5), 1e-3);
  EXPECT_EQ(placements({2, 3}).size() + 1, unedited({2, 3}).size());
  EXPECT_EQ(there.size(), unedited({4, 3}).size() + 1);
  EXPECT_EQ(edits.counts().removed, 1u);
  EXPECT_EQ(edits.counts().placed, 1u);
  // A second move would move a model that no longer exists.
  const std::uint64_t hash = hash_of(edits);
  EXPECT_FALSE(edits.move(world, registry, {{2, 3}, tree.index}, {{4, 3}, {1, 0, 1}}));
  EXPECT_EQ(hash_of(edits), hash);
  ASSERT_TRUE(edits.restore({{2, 3}, tree.index}));
  EXPECT_TRUE(edits.empty());
}

TEST_F(EditsTest, ModelsKeepTheirPlacesAndStandOnTheEditedGround) {
  ASSERT_TRUE(edits.raise(world, {{2, 3}, {31, 0, 31}}, 40, 20));
  apply();
  const std::vector<Placement> after = placements({2, 3}), before = unedited({2, 3});
  ASSERT_EQ(after.size(), before.size());
  std::size_t lifted = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after[i].position.x, before[i].position.x);
    EXPECT_EQ(after[i].position.z, before[i].position.z);
    const glm::dvec3 at(after[i].position);
    EXPECT_NEAR(at.y, models::ground_height_m(world.terrain, {2, 3}, at.x, at.z), 1e-3);
    lifted += after[i].position.y > before[i].position.y + 1;
  }
  EXPECT_GT(lifted, after.size() / 4);
}

TEST_F(EditsTest, AHeightmapShapesItsWholeSquareAndNothingElseHasOne) {
  auto map = std::make_shared<models::Heightmap>();
  *map = {2, 2, {50, 50, 50, 50}};
  models::GroundEdit stamp;
  stamp.change = models::GroundChange::kStampSet;
  stamp.centre = {{2, 3}, {31, 0, 31}};
  stamp.radius_m = 20;
  stamp.falloff = 0;
  stamp.map = map;
  ASSERT_TRUE(edits.edit_ground(world, stamp));
  apply();
  for (const glm::dvec2 corner : {glm::dvec2(12, 12), glm::dvec2(50, 50)})
    EXPECT_NEAR(models::ground_height_m(world.terrain, {2, 3}, corner.x, corner.y), 50, 0.01);
  stamp.change = models::GroundChange::kRaise;
  stamp.centre.block = {8, 8};
  ASSERT_TRUE(edits.edit_ground(world, stamp));
  EXPECT_EQ(edits.layer()->block({8, 8})->ground[0]->map, nullptr);
}

TEST_F(EditsTest, KeysOfUneditedNodesAreThoseOfAnUneditedWorld) {
  ASSERT_TRUE(edits.remove(world, {{2, 3}, 0}));
  ASSERT_TRUE(edits.raise(world, {{2, 3}, {31, 0, 31}}, 5, 3));
  const World before = world;
  apply();
  EXPECT_NE(terrain_parameters(world, {2, 3}).hash(), terrain_parameters(before, {2, 3}).hash());
  EXPECT_EQ(terrain_parameters(world, {9, 3}).hash(), terrain_parameters(before, {9, 3}).hash());
  EXPECT_EQ(terrain_parameters(world, {9, 3}).edits(), nullptr);
}

TEST_F(EditsTest, AnEarlierCopyRestoresEverythingExactly) {
  ASSERT_TRUE(edits.remove(world, {{2, 3}, 1}));
  const Edits kept = edits;
  const std::uint64_t hash = hash_of(kept);
  ASSERT_TRUE(edits.flatten(world, {{2, 3}, {5, 0, 5}}, 12, 30));
  ASSERT_TRUE(edits.remove(world, {{7, 7}, 2}));
  EXPECT_NE(hash_of(edits), hash);
  EXPECT_EQ(hash_of(kept), hash);
  std::vector<core::BlockCoord> changed = changed_blocks(kept, edits);
  std::ranges::sort(changed);
  EXPECT_EQ(changed, (std::vector<core::BlockCoord>{{2, 3}, {7, 7}}));
  EXPECT_TRUE(changed_blocks(edits, edits).empty());
}

TEST_F(EditsTest, ImpossibleEditsAreRejectedWithAMessageAndChangeNothing) {
  const auto refused = [&](const auto& result, const char* why) {
    ASSERT_FALSE(result);
    EXPECT_THAT(result.error().message, HasSubstr(why));
    EXPECT_TRUE(edits.empty());
  };
  const core::WorldPosition good{{2, 3}, {5, 0, 5}};
  const NewModel rock{world.scatter[0].model, scatter_parameters(registry, world.scatter[0]), good,
                      0};
  const auto rock_at = [&](core::WorldPosition at, double above_m = 0) {
    NewModel model = rock;
    model.at = at;
    model.above_m = above_m;
    return edits.place(world, registry, model);
  };
  refused(edits.remove(world, {{-1, 3}, 0}), "outside the world");
  refused(edits.remove(world, {{2, 3}, 1'000'000}), "has no model 1000000");
  refused(edits.restore({{2, 3}, 0}), "was not removed");
  refused(edits.remove_placed({{2, 3}, 4}), "has no placed model");
  refused(edits.remove_ground(world, {{2, 3}, 4}), "has no ground edit");
  refused(rock_at({{2, 3}, {kNan, 0, 1}}), "out of range");
  refused(rock_at({{2, 3}, {1, 0, 1e300}}), "out of range");
  refused(rock_at({{2, 3}, {-1000, 0, 1}}), "outside the world");
  refused(rock_at(good, kNan), "above the ground");
  refused(edits.raise(world, {{2, 3}, {1e8, 0, 1}}, 5, 1), "outside the world");
  refused(edits.raise(world, good, kNan, 1), "radius");
  refused(edits.raise(world, good, 1e6, 1), "radius");
  refused(edits.raise(world, good, 0, 1), "radius");
  refused(edits.raise(world, good, 5, kNan), "raising ground by nan m");
  models::GroundEdit part;
  part.centre = good;
  for (const double strength : {-0.1, 1.1, kNan}) {
    part.strength = strength;
    refused(edits.edit_ground(world, part), "a strength of");
  }
  part.strength = 1;
  part.blend = static_cast<models::GroundBlend>(3);
  refused(edits.edit_ground(world, part), "blend does not exist");
  part.blend = models::GroundBlend::kMix;
  part.mask = std::make_shared<const models::GroundMask>();
  refused(edits.edit_ground(world, part), "masks can be in world files only");
  refused(edits.raise(world, good, 5, 1e5), "not allowed");
  refused(edits.flatten(world, good, 5, -1), "height range of the terrain");
  refused(edits.flatten(world, good, 5, 1e4), "height range of the terrain");
  models::GroundEdit stamp;
  stamp.centre = good;
  stamp.change = models::GroundChange::kStampSet;
  refused(edits.edit_ground(world, stamp), "no heightmap");
  auto map = std::make_shared<models::Heightmap>();
  *map = {5000, 2, {}};
  stamp.map = map;
  refused(edits.edit_ground(world, stamp), "5000 × 2 points is not allowed");
  *map = {2, 2, {1, 2, 3}};
  refused(edits.edit_ground(world, stamp), "3 heights");
  *map = {2, 2, {1, 2, 3, std::numeric_limits<float>::quiet_NaN()}};
  refused(edits.edit_ground(world, stamp), "nan m in the heightmap");
  *map = {1024, 1024, std::vector<float>(1024 * 1024, 1.0F)};
  Edits full = edits;
  for (int i = 0; i < 3; ++i)
    ASSERT_TRUE(full.edit_ground(world, stamp));
  const auto fourth = full.edit_ground(world, stamp);
  ASSERT_FALSE(fourth);
  EXPECT_THAT(fourth.error().message, HasSubstr("4194304 heights"));
  NewModel wrong = rock;
  wrong.model = 999;
  refused(edits.place(world, registry, wrong), "no model type 999");
  wrong = rock;
  wrong.model = world.terrain_model;
  wrong.parameters = world.terrain;
  refused(edits.place(world, registry, wrong), "cannot be placed");
  wrong = rock;
  wrong.parameters.set_integer(0, -5);
  wrong.parameters.set_real(1, kNan);
  refused(edits.place(world, registry, wrong), "not allowed");
}

// Worlds whose registries give the same type other numbers.
struct Planted {
  models::Registry registry = models::make_standard_registry();
  World world;

  explicit Planted(const std::vector<std::string>& species, int vertices = 64) {
    std::string text =
        "format = 1\n[world]\nname = \"w\"\nseed = 1\nblocks = [0, 0]\nblock_vertices = " +
        std::to_string(vertices) + "\n[terrain]\nrelief_m = 60\n";
    for (const std::string& name : species)
      text += "[[species]]\nname = \"" + name +
              "\"\naxiom = \"T\"\niterations = 3\nbranches = 3\nspread = 1\n"
              "[[species.kind]]\nsymbol = \"T\"\nleaves = \"none\"\n"
              "[[species.kind]]\nsymbol = \"B\"\nangle_deg = 40\n"
              "[[species.rule]]\nfrom = \"T\"\nto = \"B*\"\n";
    auto read = parse_world(text, "test.toml", registry);
    EXPECT_TRUE(read) << read.error().message;
    world = std::move(*read);
  }
  // The names of the types that stand in a block with these edits.
  std::vector<std::string> standing(const Edits& edits, core::BlockCoord block) {
    World edited = world;
    set_edits(edited, fitted(edits, world, registry).layer());
    std::vector<Placement> found, unfitted;
    place_models(edited, registry, block, found);
    set_edits(edited, edits.layer());
    place_models(edited, registry, block, unfitted);
    if (!edits.empty() && edits.layer()->block_m == world.block_size_m()) {
      EXPECT_EQ(found.size(), unfitted.size());
    }
    std::vector<std::string> names;
    for (const Placement& placement : found)
      names.emplace_back(registry[placement.model].name());
    return names;
  }
  NewModel model(const char* name, const core::WorldPosition& at) const {
    const auto index = static_cast<models::ModelIndex>(registry.find(name));
    return {index, models::default_parameters(registry[index]), at, 0};
  }
};

TEST(FittedEdits, PlacedModelsKeepTheirTypesUnderAnotherRegistry) {
  Planted before({"ash", "beech", "oak"}), fewer({"oak"}), turned({"oak", "ash"}), none({});
  Edits edits;
  for (const char* name : {"ash", "beech", "oak", "rock"})
    ASSERT_TRUE(
        edits.place(before.world, before.registry, before.model(name, {{2, 3}, {9, 0, 9}})));
  using Names = std::vector<std::string>;
  EXPECT_EQ(before.standing(edits, {2, 3}), (Names{"ash", "beech", "oak", "rock"}));
  EXPECT_EQ(turned.standing(edits, {2, 3}), (Names{"ash", "oak", "rock"}));
  EXPECT_EQ(fewer.standing(edits, {2, 3}), (Names{"oak", "rock"}));
  EXPECT_EQ(none.standing(edits, {2, 3}), (Names{"rock"}));
  EXPECT_EQ(edits.counts().placed, 4U) << "all stand again when their types return";
  EXPECT_EQ(fitted(edits, before.world, before.registry).layer(), edits.layer());
}

TEST(FittedEdits, AreTheSameAfterALayerThatFits) {
  Planted before({"ash", "oak"}), after({"oak"});
  Edits edits;
  const auto place = [&](const char* name, core::BlockCoord block) {
    ASSERT_TRUE(edits.place(before.world, before.registry, before.model(name, {block, {9, 0, 9}})));
  };
  place("ash", {2, 3});
  place("oak", {2, 3});
  place("oak", {5, 5});
  const Edits first = fitted(edits, after.world, after.registry);
  ASSERT_EQ(first.counts().placed, 2U);
  place("ash", {5, 5});
  place("ash", {7, 7});
  ASSERT_TRUE(edits.remove_placed({{2, 3}, 2}));
  const Edits next = fitted(edits, after.world, after.registry, first.layer().get());
  EXPECT_EQ(next.counts().placed, 1U);
  EXPECT_EQ(next.layer()->blocks.root()->hash,
            fitted(edits, after.world, after.registry).layer()->blocks.root()->hash);
}

TEST(FittedEdits, KeepTheirPlacesInBlocksOfAnotherSize) {
  Planted before({"oak"}, 64), after({"oak"}, 32);
  Edits edits;
  ASSERT_TRUE(
      edits.place(before.world, before.registry, before.model("oak", {{2, 3}, {9, 0, 50}})));
  ASSERT_TRUE(edits.raise(before.world, {{2, 3}, {9, 0, 50}}, 20, 7));
  ASSERT_TRUE(
      edits.remove_placed({{2, 3}, 1}) &&
      edits.place(before.world, before.registry, before.model("oak", {{2, 3}, {9, 0, 50}})));
  EXPECT_EQ(before.world.block_size_m(), 63);
  EXPECT_EQ(after.world.block_size_m(), 31);
  // 135 m along x are 4 blocks and 11 m; 239 m along z are 7 blocks and 22 m.
  EXPECT_EQ(after.standing(edits, {4, 7}), std::vector<std::string>{"oak"});
  World edited = after.world;
  const core::WorldPosition place{{4, 7}, {11, 0, 22}};
  const double flat_m = surface_height_m(edited, place);
  set_edits(edited, fitted(edits, after.world, after.registry).layer());
  EXPECT_NEAR(surface_height_m(edited, place), std::min(flat_m + 7, 60.0), 1e-3);
  Edits more = edits;
  ASSERT_TRUE(more.place(after.world, after.registry, after.model("rock", place)));
  EXPECT_EQ(after.standing(more, {4, 7}), (std::vector<std::string>{"oak", "rock"}));
}

}  // namespace
}  // namespace psygen::world
