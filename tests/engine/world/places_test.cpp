#include "engine/world/places.hpp"

#include <gmock/gmock.h>

#include "engine/models/terrain/ground.hpp"
#include "engine/world/edits/edits.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/files/world_schema.hpp"
#include "engine/world/placement.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/world/shaped_worlds.hpp"

namespace psygen::world {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::kSmallWorld;
using testing::parsed;
using testing::registry;
using testing::replaced;

constexpr const char* kPlaces = R"(
[[place]]
model = "tree"
at_m = [100, 70.5]
iterations = 3

[[place]]
model = "rock"
at_m = [101.5, 71]
above_m = 2.5
radius_m = 4

[[place]]
model = "tree"
at_m = [400, 200]
)";

std::vector<Placement> placed_on(const World& world, core::BlockCoord block) {
  std::vector<Placement> all;
  place_models(world, registry(), block, all);
  std::erase_if(all, [](const Placement& p) { return p.index < kFilePlacedIndex; });
  return all;
}

TEST(Places, HavePositionAndParametersOfTheFile) {
  const World world = parsed(std::string(kSmallWorld) + kPlaces);
  const auto placed = placed_on(world, {1, 1});
  ASSERT_EQ(placed.size(), 2U);
  EXPECT_EQ(registry()[placed[0].model].name(), "tree");
  EXPECT_EQ(placed[0].index, kFilePlacedIndex + 1);
  EXPECT_EQ(placed[0].position.x, 36);
  EXPECT_EQ(placed[0].position.z, 6.5F);
  const double ground_m = models::ground_height_m(world.terrain, {1, 1}, 37.5, 7);
  EXPECT_NEAR(static_cast<double>(placed[1].position.y), ground_m + 2.5, 1e-4);
  const models::ModelType& rock = registry()[placed[1].model];
  EXPECT_EQ(placed[1].parameters.real(
                static_cast<std::size_t>(models::parameter_index(rock, "radius_m"))),
            4);
  ASSERT_EQ(placed_on(world, {6, 3}).size(), 1U);
  EXPECT_NE(placed_on(world, {6, 3})[0].parameters.hash(), placed[0].parameters.hash());
  EXPECT_TRUE(placed_on(world, {0, 0}).empty());
  // Scattered models do not change.
  std::vector<Placement> before, now;
  place_models(parsed(kSmallWorld), registry(), {1, 1}, before);
  place_models(world, registry(), {1, 1}, now);
  ASSERT_EQ(now.size(), before.size() + 2);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_EQ(now[i].position, before[i].position);
}

TEST(Places, EveryModelTypeCanBePlaced) {
  for (models::ModelIndex i = 0; i < registry().size(); ++i) {
    const std::string name(registry()[i].name());
    if (name == "terrain") continue;
    const World world =
        parsed(std::string(kSmallWorld) + "[[place]]\nmodel = \"" + name + "\"\nat_m = [10, 10]\n");
    const auto placed = placed_on(world, {0, 0});
    ASSERT_EQ(placed.size(), 1U) << name;
    const auto mesh = models::test::synthesise(registry()[i], placed[0].parameters, 0);
    EXPECT_FALSE(mesh.vertex_bytes.empty()) << name;
  }
}

TEST(Places, StandOnEditedGroundTogetherWithPlacedModels) {
  World world = parsed(std::string(kSmallWorld) + kPlaces);
  const float before_m = placed_on(world, {1, 1})[0].position.y;
  Edits edits;
  ASSERT_TRUE(edits.raise(world, {{1, 1}, {36, 0, 6.5}}, 30, 4));
  const models::ModelIndex rock = world.scatter[1].model;
  ASSERT_TRUE(
      edits.place(world, registry(),
                  {rock, models::default_parameters(registry()[rock]), {{1, 1}, {5, 0, 5}}}));
  set_edits(world, edits.layer());
  const auto placed = placed_on(world, {1, 1});
  ASSERT_EQ(placed.size(), 2U);
  EXPECT_NEAR(placed[0].position.y, before_m + 4, 0.05);
  std::vector<Placement> all;
  place_models(world, registry(), {1, 1}, all);
  EXPECT_TRUE(std::ranges::is_sorted(all, {}, &Placement::index));
  EXPECT_EQ(std::ranges::count_if(all, [](const Placement& p) { return p.index >= kPlacedIndex; }),
            3);
  // They are no edits: saves do not store them, and edits cannot remove them.
  EXPECT_EQ(edits.counts().placed, 1U);
  EXPECT_FALSE(edits.remove(world, {{1, 1}, placed[0].index}));
}

TEST(Places, AreInMergedModelsAndTheirIdentity) {
  const std::string bare = replaced(kSmallWorld, "count = 3", "count = 0");
  const auto base = std::make_shared<const World>(parsed(bare));
  const auto high = std::make_shared<const World>(
      parsed(bare + "[[place]]\nmodel = \"rock\"\nat_m = [60, 60]\nabove_m = 200\nradius_m = 9\n"));
  const auto make = [](const std::shared_ptr<const World>& world, core::BlockCoord node) {
    const auto merged = make_merged_type(world, registry());
    const models::Parameters p = merged_parameters(*world, node, 1);
    const auto mesh = models::test::synthesise(*merged, p, 0);
    const core::Bounds box = merged->bounds(p);
    EXPECT_LE(mesh.box.max.y, box.max.y);
    return mesh.box;
  };
  EXPECT_LT(make(base, {0, 0}).max.y, 100);
  EXPECT_GT(make(high, {0, 0}).max.y, 200);
  EXPECT_LT(make(high, {1, 1}).max.y, 100);
  EXPECT_NE(merged_identity(*base, registry()), merged_identity(*high, registry()));
  EXPECT_EQ(places_hash(*base, registry()), 0U);
  EXPECT_GT(with_placed_models({1, 1}, *high).y, 200);
  EXPECT_EQ(with_placed_models({1, 1}, *base), glm::vec2(1, 1));
  EXPECT_EQ(world_size(*base, registry()).models, world_size(*high, registry()).models);
}

TEST(Places, ReadBackEqualAndAppearInEditors) {
  const std::string text = std::string(kSmallWorld) + kPlaces;
  const World world = parsed(text);
  const World again = parsed(write_world(world, registry()));
  EXPECT_EQ(again, world);
  EXPECT_EQ(places_hash(again, registry()), places_hash(world, registry()));
  const auto sections = world_schema(text, world, registry());
  ASSERT_TRUE(sections) << sections.error().message;
  const WorldField* above = find_field(*sections, {"place", 1, "above_m"});
  ASSERT_NE(above, nullptr);
  EXPECT_EQ(above->value, "2.5");
  EXPECT_EQ(find_field(*sections, {"place", 0, "at_m"})->value, "[100, 70.5]");
  EXPECT_EQ(find_field(*sections, {"place", 1, "radius_m"})->value, "4");
  EXPECT_FALSE(world_schema(text, parsed(kSmallWorld), registry()));
}

TEST(Places, BadOnesAreRejectedWithLineAndField) {
  const auto error = [](const std::string& tables) {
    const auto world = parse_world(kSmallWorld + tables, "w.toml", registry());
    return world ? "" : world.error().message;
  };
  const std::string place = "[[place]]\nmodel = \"rock\"\nat_m = [10, 10]\n";
  ASSERT_EQ(error(place), "");
  const auto with = [&](const char* from, const std::string& to) {
    return error(replaced(place, from, to));
  };
  EXPECT_THAT(with("\"rock\"", "\"castle\""),
              AllOf(HasSubstr("w.toml:25: place[0].model"), HasSubstr("tree")));
  EXPECT_THAT(with("\"rock\"", "\"terrain\""), HasSubstr("place[0].model"));
  EXPECT_THAT(with("model = \"rock\"\n", ""), HasSubstr("place[0].model"));
  EXPECT_THAT(with("at_m = [10, 10]\n", ""), HasSubstr("place[0].at_m"));
  for (const char* at : {"[10]", "[nan, 1]", "[-1, 1]", "[1, 256]", "[1e9, 1]", "\"here\""})
    EXPECT_THAT(with("[10, 10]", at), HasSubstr("w.toml:26: place[0].at_m")) << at;
  for (const char* key : {"above_m = 1001", "above_m = nan", "radius_m = -1", "radius_m = [1, 2]",
                          "seed = 3", "turn = 4"})
    EXPECT_THAT(error(place + key), HasSubstr("w.toml:27: place[0].")) << key;
  std::string many;
  for (int i = 0; i < 4097; ++i)
    many += place;
  EXPECT_THAT(error(many), HasSubstr("at most 4096 tables"));
}

}  // namespace
}  // namespace psygen::world
