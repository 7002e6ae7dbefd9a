#include "engine/world/files/world_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

#include "engine/models/rock/rock.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/models/tree/tree.hpp"
#include "engine/world/files/text_file.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using ::testing::AllOf;
using testing::game_file;
using ::testing::HasSubstr;
using testing::kSmallWorld;
using testing::parsed;
using testing::registry;
using testing::replaced;
using ::testing::StartsWith;

core::Error error_of(std::string_view text) {
  const auto world = parse_world(text, "w.toml", registry());
  return world ? core::Error{core::ErrorCode::kInternal, "accepted"} : world.error();
}

// The error of the small world with a line replaced.
std::string error_with(std::string_view from, std::string_view to) {
  return error_of(replaced(kSmallWorld, from, to)).message;
}

TEST(WorldFile, ReadsEveryField) {
  const World world = parsed(kSmallWorld);
  EXPECT_EQ(world.name, "small");
  EXPECT_EQ(world.seed, 5U);
  EXPECT_EQ(world.blocks_x, 8);
  EXPECT_EQ(world.blocks_z, 4);
  EXPECT_EQ(world.terrain.integer(models::kTerrainSize), 33);
  EXPECT_EQ(world.terrain.real(models::kTerrainCellM), 2);
  EXPECT_EQ(world.terrain.integer(models::kTerrainOctaves), 4);
  EXPECT_EQ(world.terrain.real(models::kTerrainReliefM), 60);
  EXPECT_EQ(world.terrain.integer(models::kTerrainSeed), 5);
  ASSERT_EQ(world.scatter.size(), 2U);
  const Scatter& trees = world.scatter[0];
  EXPECT_EQ(registry()[trees.model].name(), "tree");
  EXPECT_EQ(trees.count, 3U);
  EXPECT_EQ(trees.ranges[models::kTreeIterations], (ParameterRange{2, 3}));
  EXPECT_EQ(trees.ranges[models::kTreeSizeM], (ParameterRange{1.5, 2.5}));
  EXPECT_FALSE(trees.has_filter());
  EXPECT_EQ(world.scatter[1].ranges[models::kRockSubdivisions], (ParameterRange{1, 1}));
}

TEST(WorldFile, ASeedHasAll64Bits) {
  const auto seed_of = [](const std::string& seed) {
    const World world = parsed(replaced(kSmallWorld, "seed = 5", "seed = " + seed));
    EXPECT_EQ(static_cast<std::uint64_t>(world.terrain.integer(models::kTerrainSeed)), world.seed);
    return world.seed;
  };
  EXPECT_EQ(seed_of("0"), 0u);
  EXPECT_EQ(seed_of("9223372036854775807"), 9223372036854775807u);
  EXPECT_EQ(seed_of("\"5\""), 5u);
  EXPECT_EQ(seed_of("\"15585416654101124857\""), 15585416654101124857u);
  EXPECT_EQ(seed_of("'18446744073709551615'"), UINT64_MAX);
}

TEST(WorldFile, MissingFieldsHaveTheDefaultsOfTheSchema) {
  const World world = parsed("format = 1\n[world]\nname = \"w\"\nseed = 1\nblocks = [1, 1]\n");
  const models::ModelType& terrain = registry()[world.terrain_model];
  for (std::size_t i = 0; i < terrain.parameters().size(); ++i) {
    const models::ParameterSpec& spec = terrain.parameters()[i];
    if (i == models::kTerrainSunAzimuth || i == models::kTerrainSunElevation)
      continue;  // the sky's
    const double value = spec.type == models::ParameterType::kInteger
                             ? static_cast<double>(world.terrain.integer(i))
                             : world.terrain.real(i);
    EXPECT_EQ(value, spec.default_value) << spec.name;
  }
  EXPECT_TRUE(world.scatter.empty());
  EXPECT_EQ(world.sky, Sky{});
  EXPECT_EQ(world.palette, Palette{});
}

TEST(WorldFile, ReadsSkyPaletteAndPlaces) {
  const World world = parsed(std::string(kSmallWorld) +
                             "min_height_m = 10\nmax_height_m = 50.5\nmax_slope_deg = 30\n"
                             "[sky]\nsun_elevation_deg = 12\nhaze_colour = [1, 0.5, 0.25]\n"
                             "[palette]\nsnow_start_m = 44\n");
  EXPECT_EQ(world.sky.sun_elevation_deg, 12);
  EXPECT_EQ(world.sky.haze_colour, glm::vec3(1, 0.5, 0.25));
  EXPECT_EQ(world.palette.snow_start_m, 44);
  EXPECT_EQ(world.scatter[1].min_height_m, 10);
  EXPECT_EQ(world.scatter[1].max_height_m, 50.5);
  EXPECT_EQ(world.scatter[1].max_slope_deg, 30);
  EXPECT_TRUE(world.scatter[1].has_filter());
}

TEST(WorldFile, ThePapersWorldHasThePapersValues) {
  const auto world = load_world(game_file("worlds/paper.toml"), registry());
  ASSERT_TRUE(world.has_value()) << world.error().message;
  EXPECT_EQ(world->blocks_x, 512);
  EXPECT_EQ(world->blocks_z, 512);
  EXPECT_EQ(world->terrain.integer(models::kTerrainSize), 64);
  EXPECT_EQ(world->terrain.integer(models::kTerrainOctaves), 9);
  ASSERT_EQ(world->scatter.size(), 2U);
  EXPECT_EQ(registry()[world->scatter[0].model].name(), "tree");
  EXPECT_EQ(world->scatter[0].count, 23U);
  EXPECT_EQ(world->scatter[0].ranges[models::kTreeIterations], (ParameterRange{3, 5}));
  EXPECT_EQ(world->scatter[0].ranges[models::kTreeBranches], (ParameterRange{2, 4}));
  EXPECT_EQ(registry()[world->scatter[1].model].name(), "rock");
  EXPECT_EQ(world->scatter[1].count, 40U);
  EXPECT_EQ(world->scatter[1].ranges[models::kRockSubdivisions], (ParameterRange{2, 2}));
}

TEST(WorldFile, EveryWorldOfTheGameLoads) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(game_file("worlds"))) {
    models::Registry own = models::make_standard_registry();
    const auto world = load_world(entry.path(), own);
    EXPECT_TRUE(world.has_value()) << world.error().message;
    ++count;
  }
  EXPECT_GE(count, 3);
}

TEST(WorldFile, HugeAndNonsensicalParametersAreRejectedWithFieldAndPredictedCost) {
  EXPECT_THAT(error_with("subdivisions = 1", "subdivisions = 40"),
              AllOf(StartsWith("w.toml:23: scatter[1].subdivisions: "),
                    HasSubstr("predicted cost: 2^82.0 triangles")));
  EXPECT_THAT(error_with("iterations = [2, 3]", "iterations = 1000"),
              AllOf(StartsWith("w.toml:17: scatter[0].iterations: "), HasSubstr("predicted cost")));
  EXPECT_THAT(error_with("iterations = [2, 3]", "iterations = [2, 1000]"),
              HasSubstr("iterations = 1000 is not allowed"));
  EXPECT_THAT(error_with("iterations = [2, 3]", "branches = 1000000000"),
              AllOf(HasSubstr("scatter[0].branches"), HasSubstr("predicted cost")));
  EXPECT_THAT(error_with("block_vertices = 33", "block_vertices = 2147483648"),
              AllOf(StartsWith("w.toml:8: world.block_vertices: "), HasSubstr("2147483648"),
                    HasSubstr("predicted cost")));
  EXPECT_THAT(error_with("octaves = 4", "octaves = 0"),
              AllOf(StartsWith("w.toml:11: terrain.octaves: "), HasSubstr("from 1 to")));
  EXPECT_THAT(error_with("octaves = 4", "octaves = 1000000000"), HasSubstr("terrain.octaves"));
  EXPECT_THAT(error_with("octaves = 4", "octaves = 9223372036854775807"),
              HasSubstr("terrain.octaves"));
}

TEST(WorldFile, LegalValuesWhoseProductIsTooLargeAreRejected) {
  const core::Error error = error_of(replaced(replaced(kSmallWorld, "count = 5", "count = 16000"),
                                              "subdivisions = 1", "subdivisions = 6"));
  EXPECT_EQ(error.code, core::ErrorCode::kOverBudget);
  EXPECT_THAT(error.message, AllOf(HasSubstr("together are too large"), HasSubstr("predicted")));
}

TEST(WorldFile, TooManyModelsAreRejected) {
  EXPECT_THAT(error_with("count = 5", "count = 1000000000"),
              AllOf(HasSubstr("scatter[1].count: 1000000000"), HasSubstr("from 0 to 16384"),
                    HasSubstr("predicted cost: 16000000000 triangles on each block")));
  EXPECT_THAT(error_with("count = 5", "count = 9223372036854775807"),
              AllOf(HasSubstr("scatter[1].count"), HasSubstr("predicted cost: 2^67")));
  EXPECT_THAT(error_of(replaced(replaced(kSmallWorld, "subdivisions = 1", "subdivisions = 40"),
                                "count = 5", "count = 1000000000"))
                  .message,
              AllOf(HasSubstr("scatter[1].count"), HasSubstr("predicted cost: 2^111.9")));
  EXPECT_THAT(error_with("count = 5", "count = -1"), HasSubstr("scatter[1].count: -1"));
  EXPECT_THAT(error_with("blocks = [8, 4]", "blocks = [8, 9000000000]"),
              HasSubstr("from 0 to 2147483648"));
  EXPECT_THAT(error_with("count = 5", "count = 16384"), HasSubstr("16387 models"));
  std::string many = kSmallWorld;
  for (int i = 0; i < 70; ++i)
    many += "[[scatter]]\nmodel = \"rock\"\ncount = 1\n";
  EXPECT_THAT(error_of(many).message, HasSubstr("at most 64 tables"));
}

TEST(WorldFile, NegativesNanInfinitiesAndWrongTypesAreRejected) {
  EXPECT_THAT(error_with("cell_m = 2", "cell_m = -2"), HasSubstr("world.cell_m"));
  EXPECT_THAT(error_with("relief_m = 60", "relief_m = nan"),
              AllOf(HasSubstr("terrain.relief_m"), HasSubstr("finite")));
  EXPECT_THAT(error_with("relief_m = 60", "relief_m = +inf"), HasSubstr("terrain.relief_m"));
  EXPECT_THAT(error_with("relief_m = 60", "relief_m = 1e999"), StartsWith("w.toml:12:"));
  EXPECT_THAT(error_with("relief_m = 60", "relief_m = \"high\""), HasSubstr("terrain.relief_m"));
  EXPECT_THAT(error_with("relief_m = 60", "relief_m = [50, 60]"), HasSubstr("one number"));
  EXPECT_THAT(error_with("octaves = 4", "octaves = 4.5"), HasSubstr("integer"));
  EXPECT_THAT(error_with("seed = 5", "seed = -5"), HasSubstr("world.seed"));
  const std::string large = error_with("seed = 5", "seed = 9223372036854775808");
  EXPECT_THAT(large, StartsWith("w.toml:5:"));
  EXPECT_THAT(large, HasSubstr("a larger seed is written in quotes"));
  for (const char* seed : {"\"18446744073709551616\"", "\"-1\"", "\"0x1\"", "\" 1\"", "\"\"",
                           "\"1 \"", "1.0", "true", "[1]"})
    EXPECT_THAT(error_with("seed = 5", "seed = " + std::string(seed)),
                HasSubstr("a string of digits up to \"18446744073709551615\""))
        << seed;
  EXPECT_THAT(error_with("count = 3", "count = -3"), HasSubstr("scatter[0].count"));
  EXPECT_THAT(error_with("count = 3", "count = 3.0"), HasSubstr("an integer from 0 to"));
  EXPECT_THAT(error_with("[8, 4]", "[8, -4]"), HasSubstr("world.blocks[1]"));
  EXPECT_THAT(error_with("[8, 4]", "[8, 4294967296]"), HasSubstr("world.blocks[1]"));
  EXPECT_THAT(error_with("[8, 4]", "8"), HasSubstr("array of 2"));
  EXPECT_THAT(error_with("name = \"small\"", "name = 7"), HasSubstr("world.name"));
  EXPECT_THAT(error_of(std::string(kSmallWorld) + "[sky]\nexposure = 0\n").message,
              HasSubstr("sky.exposure"));
  EXPECT_THAT(error_of(std::string(kSmallWorld) + "[palette]\ngrass = [0, 0, 2]\n").message,
              HasSubstr("palette.grass[2]"));
  EXPECT_THAT(error_of("format = 1\nworld = 3\n").message, HasSubstr("must be a table"));
}

TEST(WorldFile, MissingFieldsAreNamed) {
  EXPECT_THAT(error_with("seed = 5\n", ""), StartsWith("w.toml:3: world.seed: this field is miss"));
  EXPECT_THAT(error_with("blocks = [8, 4]\n", ""), HasSubstr("world.blocks"));
  EXPECT_THAT(error_with("count = 3\n", ""), HasSubstr("scatter[0].count"));
  EXPECT_THAT(error_with("model = \"tree\"\n", ""), HasSubstr("scatter[0].model"));
  EXPECT_THAT(error_of("format = 1\n").message, HasSubstr("world: this field is missing"));
}

TEST(WorldFile, UnknownKeysAreRejectedAndTheNearestIsSuggested) {
  EXPECT_EQ(error_with("octaves = 4", "octavs = 4"),
            "w.toml:11: terrain.octavs: this key is unknown; did you mean octaves?");
  EXPECT_THAT(error_with("iterations = [2, 3]", "iteration = 2"),
              HasSubstr("did you mean iterations?"));
  EXPECT_THAT(error_with("[terrain]", "[terain]"), HasSubstr("did you mean terrain?"));
  EXPECT_THAT(error_with("iterations = [2, 3]", "seed = 2"), HasSubstr("this key is unknown"));
  EXPECT_THAT(error_with("octaves = 4", "block_x = 4"), HasSubstr("this key is unknown"));
}

TEST(WorldFile, UnknownModelsAreRejectedAndTheKnownOnesListed) {
  EXPECT_THAT(error_with("\"rock\"", "\"rocket\""),
              AllOf(StartsWith("w.toml:21: scatter[1].model"), HasSubstr("rock, tree")));
  EXPECT_THAT(error_with("\"rock\"", "\"terrain\""), HasSubstr("no such model to scatter"));
}

TEST(WorldFile, DuplicateKeysAndTablesAreRejected) {
  EXPECT_THAT(error_with("octaves = 4", "octaves = 4\noctaves = 5"), StartsWith("w.toml:12:"));
  EXPECT_THAT(error_of(std::string(kSmallWorld) + "[terrain]\ngain = 1\n").message,
              StartsWith("w.toml:24:"));
}

TEST(WorldFile, ANewerFormatIsReportedFirst) {
  EXPECT_THAT(error_of("format = 2\n[worlds]\nnew_thing = 1\n").message,
              AllOf(StartsWith("w.toml:1: format: "), HasSubstr("newer than this program")));
  EXPECT_THAT(error_with("format = 1", "format = 0"), HasSubstr("it must be 1"));
  EXPECT_THAT(error_with("format = 1", "format = \"1\""), HasSubstr("it must be 1"));
  EXPECT_THAT(error_of("").message, AllOf(StartsWith("w.toml:1: format"), HasSubstr("missing")));
}

TEST(WorldFile, ImpossibleLimitsOfPlacesAreRejected) {
  EXPECT_THAT(error_of(std::string(kSmallWorld) + "min_height_m = 9\nmax_height_m = 8\n").message,
              HasSubstr("must not be above max_height_m"));
  EXPECT_THAT(error_of(std::string(kSmallWorld) + "max_slope_deg = 91\n").message,
              HasSubstr("scatter[1].max_slope_deg"));
}

TEST(WorldFile, TruncatedAtEveryByteItIsAWorldOrAnError) {
  const std::string text = read_text_file(game_file("worlds/paper.toml")).value();
  int worlds = 0;
  for (std::size_t n = 0; n <= text.size(); ++n) {
    const auto world = parse_world(std::string_view(text).substr(0, n), "w.toml", registry());
    if (world) {
      ++worlds;
    } else {
      EXPECT_THAT(world.error().message, StartsWith("w.toml:"));
    }
  }
  EXPECT_GT(worlds, 0);
}

TEST(WorldFile, WithRandomBytesChangedItIsAWorldOrAnError) {
  core::RandomStream random(1, 0, 0, 0, core::Purpose::kStructure);
  for (int i = 0; i < 2000; ++i) {
    std::string text = kSmallWorld;
    const std::int64_t changes = random.next_integer(1, 4);
    for (std::int64_t k = 0; k < changes; ++k) {
      const auto at = static_cast<std::size_t>(
          random.next_integer(0, static_cast<std::int64_t>(text.size()) - 1));
      constexpr std::string_view kLikely = "=[]{}\"'.,#\n\\0e-";
      const auto pick = static_cast<std::size_t>(random.next_integer(0, 31));
      text[at] =
          pick < kLikely.size() ? kLikely[pick] : static_cast<char>(random.next_integer(0, 255));
    }
    const auto world = parse_world(text, "w.toml", registry());
    if (!world) {
      EXPECT_THAT(world.error().message, StartsWith("w.toml:"));
    }
  }
}

TEST(WorldFile, NamesOfImagesStayInTheFolderOfTheWorld) {
  const auto with = [](std::string_view name) {
    return std::string(kSmallWorld) + "\n[palette]\nsand_image = \"" + std::string(name) + "\"\n";
  };
  EXPECT_EQ(parsed(with("ground/beach.png")).palette.images[3], "ground/beach.png");
  EXPECT_EQ(parsed(with("beach..png")).palette.images[3], "beach..png");
  for (const std::string_view name : {"/beach.png", "../beach.png", "ground/../../beach.png"})
    EXPECT_THAT(error_of(with(name)).message,
                AllOf(StartsWith("w.toml:"), HasSubstr("palette.sand_image"),
                      HasSubstr("relative to the folder of the world file")))
        << name;
  EXPECT_THAT(error_of(with("")).message, HasSubstr("palette.sand_image"));
  EXPECT_THAT(error_of(with(std::string(201, 'a'))).message, HasSubstr("palette.sand_image"));
}

TEST(WorldFile, MissingFilesFoldersAndHugeFilesAreRejected) {
  EXPECT_EQ(load_world("no/such.toml", registry()).error().code, core::ErrorCode::kIo);
  EXPECT_EQ(load_world(game_file("worlds"), registry()).error().code, core::ErrorCode::kIo);
}

TEST(WorldFile, ARegistryWithoutTerrainIsRejected) {
  const auto world = parse_world(kSmallWorld, "w.toml", models::Registry());
  ASSERT_FALSE(world.has_value());
  EXPECT_EQ(world.error().code, core::ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace psygen::world
