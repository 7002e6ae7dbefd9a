#include "engine/tiles/tileset.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/exchange/write_document.hpp"
#include "engine/tiles/tile_content.hpp"
#include "tests/engine/world/shipped.hpp"
#include "tests/full_disk.hpp"

namespace psygen::tiles {
namespace {

using world::testing::kSmallWorld;
using world::testing::parsed;
using world::testing::registry;

std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path(), std::ios::binary);
    files[entry.path().lexically_relative(folder).string()] = {std::istreambuf_iterator<char>(file),
                                                               {}};
  }
  return files;
}

TEST(Tileset, HasAFileForEachTileAndIsTheSameForAnyNumberOfThreads) {
  const TemporaryFolder top;
  const world::World world = parsed(kSmallWorld);
  const auto tree = TileTree::over({0, 0, 8, 4}, {0, 2});
  const auto one = write_tileset(world, registry(), *tree, top / "one", {});
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(one->contents, 32u + 8 + 2);  // the root of 8 × 8 blocks has none
  EXPECT_EQ(one->subtrees, 1u);
  const auto files = files_in(top / "one");
  EXPECT_EQ(files.size(), one->contents + one->subtrees + 1);
  EXPECT_TRUE(files.contains("content/1/1/1.glb"));
  EXPECT_FALSE(files.contains("content/1/1/0.glb")) << "south of the region";
  TilesetOptions options;
  options.threads = 3;
  ASSERT_TRUE(write_tileset(world, registry(), *tree, top / "three", options));
  EXPECT_TRUE(files_in(top / "three") == files);
}

TEST(Tileset, BlocksHaveTheirPositionsAndEndInSkirts) {
  const world::World world = parsed(kSmallWorld);
  const auto tree = TileTree::over({0, 0, 8, 4}, {0, 2});
  const TileMaker maker(world, registry());
  const Tile tile{3, 5, 7 - 2};
  const auto document = maker.document(*tree, tile);
  ASSERT_TRUE(document);
  EXPECT_EQ(document->origin, glm::dvec3(5 * 64, 0, 2 * 64));
  EXPECT_EQ(document->objects.size(), 9u);
  EXPECT_EQ(document->objects[0].parts[0].indices.size() / 3, 2u * 32 * 32 + 4 * 32 * 2);
  const core::Bounds box = bounds_of(*document);
  EXPECT_NEAR(maker.error_m(3), 16, 1e-9);
  EXPECT_LE(box.min.x, 0);
  EXPECT_GE(box.max.x, 64);
  // A coarser tile covers its four children with fewer triangles.
  std::uint64_t fine = 0;
  for (const Tile child : {Tile{3, 4, 4}, Tile{3, 5, 4}, Tile{3, 4, 5}, Tile{3, 5, 5}})
    fine += maker.document(*tree, child)->triangle_count();
  const auto coarse = maker.document(*tree, {2, 2, 2});
  ASSERT_TRUE(coarse);
  EXPECT_LT(coarse->triangle_count(), fine / 2);
  EXPECT_EQ(coarse->origin, glm::dvec3(4 * 64, 0, 2 * 64));
}

TEST(Tileset, HasItsPlaceOnEarthAsTheTransformOfItsRoot) {
  const TemporaryFolder folder;
  const world::World world = parsed(kSmallWorld);
  const auto tree = TileTree::over({0, 0, 1, 1}, {0, 0});
  const auto transform = [&](const char* place) {
    TilesetOptions options;
    options.at_geo = parse_geo_place(place).value();
    EXPECT_TRUE(write_tileset(world, registry(), *tree, folder.path(), options));
    const auto json = nlohmann::json::parse(files_in(folder.path()).at("tileset.json"));
    return json["root"]["transform"].get<std::vector<double>>();
  };
  const auto expect_near = [](const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
      EXPECT_NEAR(a[i], b[i], 1e-5) << i;
  };
  expect_near(transform("0,0,100"),  // east, north, up, the place
              {0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 6'378'237, 0, 0, 1});
  expect_near(transform("90,0"), {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 6'356'752.314245, 1});
  expect_near(transform("0,-90"), {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, -6'378'137, 0, 1});
  ASSERT_TRUE(write_tileset(world, registry(), *tree, folder.path(), {}));
  const auto json = nlohmann::json::parse(files_in(folder.path()).at("tileset.json"));
  EXPECT_FALSE(json["root"].contains("transform"));
}

TEST(Tileset, PlacesOnEarthAreTwoOrThreeNumbersInTheirRanges) {
  EXPECT_EQ(parse_geo_place("47.25,-8.5")->longitude_deg, -8.5);
  EXPECT_EQ(parse_geo_place("47.25,-8.5,-30")->height_m, -30);
  for (const char* text : {"", "47", "47,", "47,8,", "47,8,1,2", "91,0", "0,181", "nan,0",
                           "0,0,inf", "47 ,8", "a,b", "47,8,-1e9"})
    EXPECT_FALSE(parse_geo_place(text)) << text;
}

TEST(Tileset, BoxesHoldTheirTilesAndThoseBelow) {
  const TemporaryFolder folder;
  const world::World world = parsed(kSmallWorld);
  const auto tree = TileTree::over({0, 0, 8, 4}, {1, 2});
  ASSERT_TRUE(write_tileset(world, registry(), *tree, folder.path(), {}));
  const auto files = files_in(folder.path());
  const auto json = nlohmann::json::parse(files.at("tileset.json"));
  const auto& root = json["root"];
  EXPECT_EQ(root["implicitTiling"]["availableLevels"], 3);
  EXPECT_EQ(root["geometricError"], 2.0 * 8);  // two metres a cell, eight blocks a side
  const auto box = root["boundingVolume"]["box"].get<std::vector<double>>();
  EXPECT_EQ(box[0], 256);
  EXPECT_EQ(box[1], -256) << "north is up in 3D Tiles";
  const TileMaker maker(world, registry());
  for (std::uint32_t x = 0; x < 4; ++x) {
    const auto document = maker.document(*tree, {2, x, 3});
    const core::Bounds content = bounds_of(*document);
    EXPECT_GE(static_cast<double>(content.min.y), box[2] - box[11] - 1e-3);
    EXPECT_LE(static_cast<double>(content.max.y), box[2] + box[11] + 1e-3);
  }
}

TEST(Tileset, OnAFullDiskHasNoTilesetJson) {
  const TemporaryFolder top;
  const world::World world = parsed(kSmallWorld);
  const auto tree = TileTree::over({0, 0, 2, 2}, {0, 1});
  for (const std::size_t calls : {0u, 10u, 25u}) {
    const FullDisk full(top / "tiles", calls);
    const auto report = write_tileset(world, registry(), *tree, top / "tiles", {});
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, core::ErrorCode::kIo);
    EXPECT_FALSE(std::filesystem::exists(top / "tiles/tileset.json"));
  }
}

}  // namespace
}  // namespace psygen::tiles
