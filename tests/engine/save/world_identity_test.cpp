#include "engine/save/world_identity.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "engine/world/edits/edits.hpp"
#include "tests/engine/world/shaped_worlds.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::save {
namespace {

using world::testing::kSmallWorld;
using world::testing::parsed;
using world::testing::registry;
using world::testing::replaced;

TEST(WorldIdentity, IsTheSameForTheSameWorld) {
  const WorldIdentity one = identity_of(parsed(kSmallWorld), registry());
  EXPECT_EQ(one.name, "small");
  EXPECT_EQ(one, identity_of(parsed(kSmallWorld), registry()));
}

TEST(WorldIdentity, DiffersIfModelsStandElsewhere) {
  const auto hash = identity_of(parsed(kSmallWorld), registry()).hash;
  for (const auto& [from, to] : {std::pair{"seed = 5", "seed = 6"},
                                 {"count = 3", "count = 4"},
                                 {"relief_m = 60", "relief_m = 61"},
                                 {"[8, 4]", "[8, 5]"}})
    EXPECT_NE(identity_of(parsed(replaced(kSmallWorld, from, to)), registry()).hash, hash) << to;
}

TEST(WorldIdentity, IgnoresColoursAndTheName) {
  const auto hash = identity_of(parsed(kSmallWorld), registry()).hash;
  world::World world = parsed(kSmallWorld);
  world.sky.start_hour = 17;
  world.palette.grass.x = 0.5F;
  world.palette.snow_start_m = 20;
  world.water.colour.x = 0.5F;
  world.water.shore_m = 3;
  world.name = "other";
  EXPECT_EQ(identity_of(world, registry()).name, "other");
  EXPECT_EQ(identity_of(world, registry()).hash, hash);
}

TEST(WorldIdentity, CoversMasksAndTheirKindsOfGround) {
  world::World world = parsed(kSmallWorld);
  const auto hash = identity_of(world, registry()).hash;
  world.scatter[1].mask.share = 0.3;  // of no patches
  EXPECT_EQ(identity_of(world, registry()).hash, hash);
  world.scatter[1].mask.noise_m = 40;
  const auto patches = identity_of(world, registry()).hash;
  EXPECT_NE(patches, hash);
  world.palette.snow_start_m = 20;
  EXPECT_EQ(identity_of(world, registry()).hash, patches);
  world.scatter[1].mask.ground = 2;
  const auto by_ground = identity_of(world, registry()).hash;
  world.palette.snow_start_m = 30;
  EXPECT_NE(identity_of(world, registry()).hash, by_ground);
  world.palette.snow_start_m = 20;
  world.palette.snow = glm::vec3(0.5F);
  EXPECT_EQ(identity_of(world, registry()).hash, by_ground);
}

TEST(WorldIdentity, CoversStampsAndRoadsButNotEdits) {
  using world::testing::kShapes;
  world::World world = world::testing::shaped_world(kShapes);
  const auto hash = identity_of(world, registry()).hash;
  EXPECT_NE(hash, identity_of(parsed(kSmallWorld), registry()).hash);
  EXPECT_EQ(hash, identity_of(world::testing::shaped_world(kShapes), registry()).hash);
  const std::string wider = replaced(kShapes, "width_m = 10", "width_m = 12");
  EXPECT_NE(hash, identity_of(world::testing::shaped_world(wider), registry()).hash);
  world::Edits edits;
  ASSERT_TRUE(edits.raise(world, {{2, 2}, {8, 0, 8}}, 20, 3));
  world::set_edits(world, edits.layer());
  EXPECT_EQ(hash, identity_of(world, registry()).hash);
}

TEST(WorldIdentity, ShapesThatAreOffLeaveNoTrace) {
  using world::testing::kShapes;
  const auto hash_of = [](const std::string& tables) {
    return identity_of(world::testing::shaped_world(tables), registry()).hash;
  };
  const std::string lake = "[[lake]]\ncentre_m = [400, 100]\nradius_m = 40\n";
  const std::string river = "[[river]]\npoints_m = [[300, 200], [200, 160]]\n";
  const std::string stamp = "[[stamp]]\nimage = \"white.png\"\ncentre_m = [100, 100]\n";
  for (const std::string& shape : {lake, river, stamp}) {
    EXPECT_NE(hash_of(kShapes + shape), hash_of(kShapes));
    EXPECT_EQ(hash_of(kShapes + shape + "enabled = false\n"), hash_of(kShapes));
  }
}

TEST(WorldIdentity, CoversErosionIfThereIsAny) {
  const auto hash_of = [](const std::string& tables) {
    return identity_of(world::testing::shaped_world(tables), registry()).hash;
  };
  const auto plain = identity_of(parsed(kSmallWorld), registry()).hash;
  EXPECT_EQ(hash_of("[erosion]\ngully_m = 50\n"), plain);
  EXPECT_NE(hash_of("[erosion]\nstrength = 0.5\n"), plain);
  EXPECT_NE(hash_of("[erosion]\nstrength = 0.5\n"), hash_of("[erosion]\nstrength = 0.6\n"));
}

TEST(WorldIdentity, CoversTheWaterLevelIfThereIsWater) {
  world::World world = parsed(kSmallWorld);
  const auto hash = identity_of(world, registry()).hash;
  world.water.level_m = -2e6;
  EXPECT_EQ(identity_of(world, registry()).hash, hash);
  world.water.level_m = 3;
  const auto wet = identity_of(world, registry()).hash;
  EXPECT_NE(wet, hash);
  world.water.level_m = 4;
  EXPECT_NE(identity_of(world, registry()).hash, wet);
}

TEST(WorldIdentity, CoversTheBranchesOfSpeciesButNotTheirLooks) {
  models::Registry species = models::make_standard_registry();
  world::World world =
      *world::load_world(world::testing::game_file("worlds/five_species.toml"), species);
  ASSERT_FALSE(world.species.empty());
  const auto hash = identity_of(world, species).hash;
  const models::Species before = world.species[0];
  const auto changed = [&](auto&& change) {
    world.species[0] = before;
    change(world.species[0]);
    return identity_of(world, species).hash != hash;
  };
  EXPECT_FALSE(changed([](models::Species& s) { s.doc = "another line"; }));
  EXPECT_FALSE(changed([](models::Species& s) { s.colours.bark[0] += 0.1; }));
  EXPECT_FALSE(changed([](models::Species& s) { s.colour_variation += 0.1; }));
  EXPECT_FALSE(changed([](models::Species& s) { s.foliage.density_winter = 0.25; }));
  EXPECT_TRUE(changed([](models::Species& s) { s.name += "s"; }));
  EXPECT_TRUE(changed([](models::Species& s) { s.branches += 1; }));
  EXPECT_TRUE(changed([](models::Species& s) { s.taper += 0.01; }));
  EXPECT_TRUE(changed([](models::Species& s) { s.kinds[1].length += 0.01; }));
  EXPECT_TRUE(changed([](models::Species& s) { s.rules[0].to += "M"; }));
}

// A type with a schema that grows.
class Reed : public models::ModelType {
 public:
  explicit Reed(std::size_t count) : count_(count) {}
  std::string_view name() const override { return "reed"; }
  std::string_view doc() const override { return "a stalk"; }
  std::span<const models::ParameterSpec> parameters() const override {
    using enum models::ParameterType;
    static constexpr models::ParameterSpec kSchema[]{
        {"height_m", kReal, "m", 2, 0, 9, 0, 9, "height"},
        {"stalks", kInteger, "", 7, 0, 9, 0, 9, "how many"},
        {"bend", kReal, "1", 0, 0, 1, 0, 1, "how much"}};
    return std::span(kSchema).first(count_);
  }
  int level_count() const override { return 1; }
  double level_error_m(const models::Parameters&, int) const override { return 0; }
  core::Bounds bounds(const models::Parameters&) const override { return {}; }
  models::MeshSize mesh_size(const models::Parameters&, int) const override { return {}; }
  double complexity(const models::Parameters&, int) const override { return 0; }
  double log2_cost(const models::Parameters&) const override { return 0; }
  core::Bounds synthesise(const models::Parameters&, int, const models::MeshView&) const override {
    return {};
  }
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override {}

 private:
  std::size_t count_;
};

constexpr const char* kReeds = R"(
[[scatter]]
model = "reed"
count = 9
height_m = [1, 3]
)";

// The hash of a world with reeds of so many parameters.
std::uint64_t with_reeds(std::size_t parameters, std::string_view more) {
  models::Registry known = models::make_standard_registry();
  EXPECT_TRUE(known.add(std::make_unique<Reed>(parameters)));
  const auto world = world::parse_world(kSmallWorld + std::string(kReeds) + std::string(more),
                                        "test.toml", std::as_const(known));
  EXPECT_TRUE(world) << world.error().message;
  return identity_of(*world, known).hash;
}

TEST(WorldIdentity, IsUnchangedByANewParameterWithItsDefault) {
  const std::uint64_t hash = with_reeds(1, "");
  EXPECT_EQ(with_reeds(2, ""), hash);
  EXPECT_EQ(with_reeds(3, ""), hash);
  EXPECT_EQ(with_reeds(3, "stalks = 7\n"), hash);
  EXPECT_NE(with_reeds(3, "stalks = 6\n"), hash);
  EXPECT_NE(with_reeds(3, "stalks = [7, 8]\n"), hash);
  EXPECT_NE(with_reeds(3, "bend = [0, 0.5]\n"), hash);
  EXPECT_EQ(identity_of(parsed(replaced(kSmallWorld, "octaves", "warp = 0\noctaves")), registry()),
            identity_of(parsed(kSmallWorld), registry()));
}

}  // namespace
}  // namespace psygen::save
