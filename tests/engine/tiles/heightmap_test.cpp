#include "engine/tiles/heightmap.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/image/image_io.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/placement.hpp"
#include "tests/engine/world/river_world.hpp"
#include "tests/engine/world/shipped.hpp"
#include "tests/full_disk.hpp"

namespace psygen::tiles {
namespace {

using world::testing::kSmallWorld;
using world::testing::parsed;

// Expects an image of a region of a world to have the heights that queries answer.
void expect_heights_of(const world::World& world) {
  const TemporaryFolder folder;
  const auto report = write_heightmap(world, {2, 1, 5, 3}, folder.path(), {.threads = 3});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->width, 3u * 32 + 1);
  EXPECT_EQ(report->height, 2u * 32 + 1);
  const auto json = nlohmann::json::parse(contents_of(folder.path()).at("heightmap.json"));
  EXPECT_EQ(json["west_m"], 128);
  EXPECT_EQ(json["north_m"], 64);
  const auto png = image::read_grey(folder / "heights.png");
  ASSERT_TRUE(png) << png.error().message;
  const double black = json["height_of_black_m"], white = json["height_of_white_m"];
  EXPECT_EQ(black, report->min_m);
  for (const auto& [x, z] : {std::pair{0, 0}, {96, 64}, {32, 5}, {50, 40}, {96, 0}}) {
    const core::BlockCoord block{2 + std::min(x / 32, 2), 1 + std::min(z / 32, 1)};
    const double height =
        models::ground_height_m(world::terrain_parameters(world, block), block,
                                2.0 * (x - 32 * (block.x - 2)), 2.0 * (z - 32 * (block.z - 1)));
    const std::size_t pixel = static_cast<std::size_t>(z) * 97 + static_cast<std::size_t>(x);
    EXPECT_NEAR(black + png->grey[pixel] / 65535.0 * (white - black), height,
                (white - black) / 65535)
        << x << " " << z;
  }
}

TEST(Heightmap, HasTheHeightsOfTheGround) {
  expect_heights_of(parsed(kSmallWorld));
}

TEST(Heightmap, HasTheHeightsOfErodedGround) {
  const std::string eroded = std::string(kSmallWorld) + "[erosion]\nstrength = 0.8\ngully_m = 50\n";
  expect_heights_of(parsed(eroded));
}

TEST(Heightmap, RegionsWithOneRangeJoinWithoutAStep) {
  const TemporaryFolder folder;
  const world::World world = parsed(kSmallWorld);
  const HeightmapOptions options{.range_m = std::pair{-5.0, 70.0}};
  ASSERT_TRUE(write_heightmap(world, {0, 0, 1, 1}, folder / "west", options));
  ASSERT_TRUE(write_heightmap(world, {1, 0, 2, 1}, folder / "east", options));
  const auto west = image::read_grey(folder / "west/heights.png");
  const auto east = image::read_grey(folder / "east/heights.png");
  ASSERT_TRUE(west && east);
  for (std::size_t z = 0; z < 33; ++z)
    EXPECT_EQ(west->grey[33 * z + 32], east->grey[33 * z]) << z;
  const double height =
      models::ground_height_m(world::terrain_parameters(world, {0, 0}), {0, 0}, 0, 0);
  EXPECT_NEAR(-5 + west->grey[0] / 65535.0 * 75, height, 75.0 / 65535);
  const auto json = nlohmann::json::parse(contents_of(folder / "east").at("heightmap.json"));
  EXPECT_EQ(json["height_of_black_m"], -5);
  EXPECT_EQ(json["height_of_white_m"], 70);
}

TEST(Heightmap, RejectsARangeThatLeavesHeightsOut) {
  const TemporaryFolder folder;
  const auto written = write_heightmap(parsed(kSmallWorld), {0, 0, 1, 1}, folder / "a",
                                       {.range_m = std::pair{0.0, 1.0}});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, core::ErrorCode::kInvalidArgument);
  EXPECT_NE(written.error().message.find("beyond the range 0 to 1 m"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "a/heights.png"));
}

TEST(Heightmap, HasMasksOfWaterWhereTheWorldHasWater) {
  const TemporaryFolder folder;
  const world::World& world = world::testing::river_world();
  ASSERT_TRUE(write_heightmap(world, {26, 26, 28, 27}, folder / "wet", {}));
  const auto mask = image::read_grey(folder / "wet/water_mask.png");
  ASSERT_TRUE(mask) << mask.error().message;
  int wet = 0;
  for (std::uint32_t z = 0; z < mask->height; ++z) {
    for (std::uint32_t x = 0; x < mask->width; ++x) {
      const core::WorldPosition at =
          core::normalised({{26, 26}, {1.0 * x, 0, 1.0 * z}}, world.block_size_m());
      const bool is_wet = !world::water_at(world, at).is_dry();
      ASSERT_EQ(mask->grey[std::size_t{z} * mask->width + x], is_wet ? 65'535 : 0);
      wet += is_wet ? 1 : 0;
    }
  }
  EXPECT_GT(wet, 1000);
  for (const char* name : {"water_depth.exr", "water_flow_x.exr", "water_flow_z.exr"})
    EXPECT_TRUE(contents_of(folder / "wet").contains(name)) << name;
  ASSERT_TRUE(write_heightmap(parsed(kSmallWorld), {0, 0, 1, 1}, folder / "dry", {}));
  EXPECT_FALSE(contents_of(folder / "dry").contains("water_mask.png"));
}

TEST(Heightmap, MasksAddUpToWhite) {
  const TemporaryFolder folder;
  const world::World world = parsed(kSmallWorld);
  ASSERT_TRUE(write_heightmap(world, {0, 0, 2, 2}, folder.path(), {}));
  std::vector<int> sums(65 * 65);
  for (const char* kind : {"grass", "forest", "dry", "sand", "rock", "snow"}) {
    const auto mask = image::read_grey(folder / ("ground_" + std::string(kind) + ".png"));
    ASSERT_TRUE(mask) << mask.error().message;
    for (std::size_t i = 0; i < sums.size(); ++i)
      sums[i] += mask->grey[i];
  }
  for (const int sum : sums)
    EXPECT_NEAR(sum, 65535, 3);
}

// The floats are read back as grey values, for which they must lie from 0 to 1.
TEST(Heightmap, OfFloatsReadsBackEqual) {
  const TemporaryFolder folder;
  const image::FloatImage values{3, 2, {0.0F, 0.25F, 0.5F, 0.75F, 1.0F, 0.125F}};
  ASSERT_TRUE(image::write_exr(folder / "a.exr", values));
  const auto read = image::read_grey(folder / "a.exr");
  ASSERT_TRUE(read) << read.error().message;
  for (std::size_t i = 0; i < values.values.size(); ++i)
    EXPECT_EQ(read->grey[i], static_cast<std::uint16_t>(values.values[i] * 65535 + 0.5F));
}

TEST(Heightmap, HasLimitsAndCanBeStopped) {
  const TemporaryFolder folder;
  const world::World world = parsed(kSmallWorld);
  const auto large = write_heightmap(world, {0, 0, 513, 1}, folder / "a", {});
  ASSERT_FALSE(large);
  EXPECT_NE(large.error().message.find("at most 16384 per side are allowed (511 blocks"),
            std::string::npos)
      << large.error().message;
  const std::atomic<bool> stop{true};
  EXPECT_EQ(write_heightmap(world, {0, 0, 1, 1}, folder / "b", {.stop = &stop}).error().code,
            core::ErrorCode::kInterrupted);
}

}  // namespace
}  // namespace psygen::tiles
