#include "engine/tiles/subtree.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <vector>

namespace psygen::tiles {
namespace {

static_assert(std::endian::native == std::endian::little, "subtrees are little-endian");

constexpr std::size_t kAlignment = 8;

void pad(std::string& text, char with) {
  text.resize((text.size() + kAlignment - 1) / kAlignment * kAlignment, with);
}

// The i-th tile of a level in Morton order, relative to the subtree's root.
Tile descendant(const Tile& root, int steps, std::uint32_t morton) {
  Tile tile{root.level + steps, root.x << steps, root.y << steps};
  for (int bit = 0; bit < steps; ++bit) {
    tile.x |= ((morton >> (2 * bit)) & 1U) << bit;
    tile.y |= ((morton >> (2 * bit + 1)) & 1U) << bit;
  }
  return tile;
}

class SubtreeWriter {
 public:
  // The JSON of an availability: one bit for each tile, lowest bits first.
  std::string availability(const std::vector<bool>& bits) {
    std::string bytes((bits.size() + 7) / 8, '\0');
    std::size_t count = 0;
    for (std::size_t i = 0; i < bits.size(); ++i) {
      if (!bits[i]) continue;
      bytes[i / 8] = static_cast<char>(static_cast<unsigned char>(bytes[i / 8]) | (1U << (i % 8)));
      ++count;
    }
    if (count == 0) return R"({"constant":0})";
    if (count == bits.size()) return R"({"constant":1})";
    return fmt::format(R"({{"bitstream":{},"availableCount":{}}})", view(bytes), count);
  }

  // Adds a buffer view and returns its number.
  std::size_t view(const std::string& bytes) {
    views_ += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}}})",
                          view_count_ == 0 ? "" : ",", binary_.size(), bytes.size());
    binary_ += bytes;
    pad(binary_, '\0');
    return view_count_++;
  }

  std::string finish(const std::string& members) {
    std::string json = "{";
    if (view_count_ > 0)
      json += fmt::format(R"("buffers":[{{"byteLength":{}}}],"bufferViews":[{}],)", binary_.size(),
                          views_);
    json += members + "}";
    pad(json, ' ');
    std::string bytes("subt");
    const auto number = [&bytes](auto value) {
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    number(std::uint32_t{1});
    number(std::uint64_t{json.size()});
    number(std::uint64_t{binary_.size()});
    return bytes + json + binary_;
  }

 private:
  std::string binary_, views_;
  std::size_t view_count_ = 0;
};

}  // namespace

const char* const kSchema =
    R"({"id":"psygen","classes":{"tile":{"properties":{"box":{"type":"SCALAR",)"
    R"("componentType":"FLOAT64","array":true,"count":12,"required":true,)"
    R"("semantic":"TILE_BOUNDING_BOX"}}}}})";

std::string subtree_bytes(const TileTree& tree, const Tile& root,
                          const std::function<TileBox(const Tile&)>& box_of) {
  std::vector<bool> tiles, contents, children;
  std::string boxes;
  std::size_t count = 0;
  for (int steps = 0; steps < kSubtreeLevels; ++steps) {
    for (std::uint32_t morton = 0; morton < 1U << (2 * steps); ++morton) {
      const Tile tile = descendant(root, steps, morton);
      const bool exists = tile.level < tree.level_count() && tree.exists(tile);
      tiles.push_back(exists);
      contents.push_back(exists && tree.has_content(tile));
      if (!exists) continue;
      ++count;
      const TileBox box = box_of(tile);
      boxes.append(reinterpret_cast<const char*>(box.data()), sizeof box);
    }
  }
  for (std::uint32_t morton = 0; morton < 1U << (2 * kSubtreeLevels); ++morton) {
    const Tile tile = descendant(root, kSubtreeLevels, morton);
    children.push_back(tile.level < tree.level_count() && tree.exists(tile));
  }
  SubtreeWriter writer;
  std::string members = fmt::format(R"("tileAvailability":{},)", writer.availability(tiles));
  members += fmt::format(R"("contentAvailability":[{}],)", writer.availability(contents));
  members += fmt::format(R"("childSubtreeAvailability":{},)", writer.availability(children));
  members += fmt::format(
      R"("propertyTables":[{{"class":"tile","count":{},"properties":{{"box":{{"values":{}}}}}}}],)"
      R"("tileMetadata":0)",
      count, writer.view(boxes));
  return writer.finish(members);
}

}  // namespace psygen::tiles
