#include "engine/tiles/subtree.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

namespace psygen::tiles {
namespace {

struct Parts {
  nlohmann::json json;
  std::string binary;
};

Parts parts_of(const std::string& bytes) {
  std::uint64_t json_bytes = 0, binary_bytes = 0;
  std::memcpy(&json_bytes, bytes.data() + 8, 8);
  std::memcpy(&binary_bytes, bytes.data() + 16, 8);
  EXPECT_EQ(bytes.substr(0, 4), "subt");
  EXPECT_EQ(bytes.size(), 24 + json_bytes + binary_bytes);
  EXPECT_EQ(json_bytes % 8, 0u);
  EXPECT_EQ(binary_bytes % 8, 0u);
  return {nlohmann::json::parse(bytes.substr(24, json_bytes)), bytes.substr(24 + json_bytes)};
}

// The i-th bit of an availability.
bool bit(const Parts& parts, const nlohmann::json& availability, std::size_t i) {
  if (availability.contains("constant")) return availability["constant"] == 1;
  const auto& view = parts.json["bufferViews"][availability["bitstream"].get<std::size_t>()];
  const auto byte = parts.binary[view["byteOffset"].get<std::size_t>() + i / 8];
  return ((static_cast<unsigned char>(byte) >> (i % 8)) & 1U) != 0;
}

TEST(Subtree, ListsExistingTilesInMortonOrder) {
  // The south-eastern quarter of the root's square alone: x = 1, y = 0 of level 1.
  const auto tree = TileTree::over({2, 2, 4, 4}, {0, 2});
  ASSERT_TRUE(tree);
  int boxes = 0;
  const Parts parts = parts_of(subtree_bytes(*tree, {0, 0, 0}, [&](const Tile& tile) {
    ++boxes;
    return TileBox{static_cast<double>(tile.level), static_cast<double>(tile.x),
                   static_cast<double>(tile.y)};
  }));
  const auto& tiles = parts.json["tileAvailability"];
  EXPECT_TRUE(bit(parts, tiles, 0));
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(bit(parts, tiles, 1 + i), i == 1) << i;  // bit 0 is x, bit 1 is y
  for (std::size_t i = 0; i < 16; ++i)
    EXPECT_EQ(bit(parts, tiles, 5 + i), i / 4 == 1) << i;
  EXPECT_EQ(tiles["availableCount"], 6);
  EXPECT_EQ(parts.json["childSubtreeAvailability"]["constant"], 0);
  EXPECT_EQ(boxes, 6);
  const auto& table = parts.json["propertyTables"][0];
  EXPECT_EQ(table["count"], 6);
  const auto& view =
      parts.json["bufferViews"][table["properties"]["box"]["values"].get<std::size_t>()];
  EXPECT_EQ(view["byteLength"], 6 * 96);
  double first[3];
  std::memcpy(first, parts.binary.data() + view["byteOffset"].get<std::size_t>() + 96,
              sizeof first);
  EXPECT_EQ(first[0], 1);  // the second tile is that of level 1
  EXPECT_EQ(first[1], 1);
  EXPECT_EQ(first[2], 0);
}

TEST(Subtree, LeadsToTheNextSubtrees) {
  const auto tree = TileTree::over({0, 0, 64, 1}, {0, 6});
  const Parts parts =
      parts_of(subtree_bytes(*tree, {0, 0, 0}, [](const Tile&) { return TileBox{}; }));
  EXPECT_EQ(parts.json["childSubtreeAvailability"]["availableCount"], 32);
  EXPECT_TRUE(bit(parts, parts.json["childSubtreeAvailability"], 0b1010101010));
  const Parts next =
      parts_of(subtree_bytes(*tree, {5, 0, 31}, [](const Tile&) { return TileBox{}; }));
  EXPECT_EQ(next.json["tileAvailability"]["availableCount"], 3);  // of two levels
}

}  // namespace
}  // namespace psygen::tiles
