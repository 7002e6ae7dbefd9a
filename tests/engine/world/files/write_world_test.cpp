#include <gtest/gtest.h>

#include "engine/world/files/world_file.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using testing::game_file;
using testing::kSmallWorld;
using testing::parsed;
using testing::registry;

TEST(WriteWorld, AWrittenWorldReadsBackEqual) {
  const World world = parsed(kSmallWorld);
  EXPECT_EQ(parsed(write_world(world, registry())), world);
}

TEST(WriteWorld, EveryWorldOfTheGameReadsBackEqual) {
  for (const auto& entry : std::filesystem::directory_iterator(game_file("worlds"))) {
    models::Registry own = models::make_standard_registry();
    const World world = load_world(entry.path(), own).value();
    const std::string text = write_world(world, own);
    EXPECT_EQ(parse_world(text, "again.toml", own).value(), world);
    models::Registry other = models::make_standard_registry();
    EXPECT_EQ(parse_world(text, "again.toml", other).value(), world);
  }
}

TEST(WriteWorld, SeedsOfAll64BitsReadBackEqual) {
  World world = parsed(kSmallWorld);
  for (const std::uint64_t seed :
       {std::uint64_t{0}, std::uint64_t{INT64_MAX}, std::uint64_t{INT64_MAX} + 1,
        15585416654101124857u, UINT64_MAX}) {
    world.seed = seed;
    EXPECT_EQ(parsed(write_world(world, registry())).seed, seed);
  }
}

TEST(WriteWorld, OddNamesNumbersAndColoursReadBackEqual) {
  World world = parsed(kSmallWorld);
  world.name = "a \"quoted\" \\ name, ümlaut";
  world.seed = INT64_MAX;
  world.blocks_x = 0;
  world.sky.sun_azimuth_deg = 0.1 + 0.2;
  world.sky.haze_colour = {1.0F / 3, 1e-9F, 0.7F};
  world.palette.sand_end_m = -1.0 / 3;
  world.palette.images[1] = "wet \"moss\"/ü.png";
  world.scatter[0].ranges[4] = {1.0 / 7, 1.0 / 3};
  world.scatter[0].max_height_m = 1e-5;
  world.scatter[1].max_slope_deg = 33.3;
  const World again = parsed(write_world(world, registry()));
  EXPECT_EQ(again.name, world.name);
  EXPECT_EQ(again.seed, world.seed);
  EXPECT_EQ(again.sky, world.sky);
  EXPECT_EQ(again.palette, world.palette);
  EXPECT_EQ(again.scatter, world.scatter);
}

}  // namespace
}  // namespace psygen::world
