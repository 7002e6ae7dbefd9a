#include "engine/tiles/tile_tree.hpp"

#include <fmt/format.h>

#include <charconv>

namespace psygen::tiles {
namespace {

std::int64_t rounded_down(std::int64_t value, int level) {
  return value >> level << level;
}

}  // namespace

core::Result<NodeLevels> parse_levels(std::string_view text) {
  NodeLevels levels;
  const char* const end = text.data() + text.size();
  auto parsed = std::from_chars(text.data(), end, levels.finest);
  levels.coarsest = levels.finest;
  if (parsed.ec == std::errc() && parsed.ptr != end && *parsed.ptr == '-')
    parsed = std::from_chars(parsed.ptr + 1, end, levels.coarsest);
  if (parsed.ec == std::errc() && parsed.ptr == end && levels.finest >= 0 &&
      levels.finest <= levels.coarsest && levels.coarsest <= kMaxNodeLevel)
    return levels;
  return core::invalid_argument(
      fmt::format("'{}' is not FINEST-COARSEST, two levels from 0 to {}", text, kMaxNodeLevel));
}

core::Result<TileTree> TileTree::over(const amplify::Region& region, NodeLevels levels) {
  TileTree tree;
  tree.region_ = region;
  tree.levels_ = levels;
  const std::int64_t x = rounded_down(region.x0, levels.coarsest),
                     z = rounded_down(region.z0, levels.coarsest);
  tree.depth_ = levels.coarsest;
  const auto holds = [&](int depth) {
    const std::int64_t side = std::int64_t{1} << depth;
    return x + side >= region.x1 && z + side >= region.z1;
  };
  while (tree.depth_ <= kMaxNodeLevel && !holds(tree.depth_))
    ++tree.depth_;
  const std::int64_t side = std::int64_t{1} << tree.depth_;
  if (tree.depth_ > kMaxNodeLevel || x + side - 1 > INT32_MAX || z + side - 1 > INT32_MAX)
    return core::invalid_argument(
        fmt::format("the region is too large for one tileset (at most {} blocks per "
                    "side), or too near the limit of block coordinates",
                    std::uint64_t{1} << kMaxNodeLevel));
  tree.corner_ = {static_cast<std::int32_t>(x), static_cast<std::int32_t>(z)};
  return tree;
}

std::uint64_t TileTree::east(const Tile& tile) const {
  return std::uint64_t{tile.x} << node_level(tile);
}

std::uint64_t TileTree::south(const Tile& tile) const {
  const std::uint64_t rows = std::uint64_t{1} << tile.level;
  return (rows - 1 - tile.y) << node_level(tile);
}

core::BlockCoord TileTree::node(const Tile& tile) const {
  const int level = node_level(tile);
  return {static_cast<std::int32_t>((corner_.x + static_cast<std::int64_t>(east(tile))) >> level),
          static_cast<std::int32_t>((corner_.z + static_cast<std::int64_t>(south(tile))) >> level)};
}

bool TileTree::exists(const Tile& tile) const {
  if (node_level(tile) < levels_.finest) return false;
  const std::int64_t side = std::int64_t{1} << node_level(tile);
  const std::int64_t x = corner_.x + static_cast<std::int64_t>(east(tile)),
                     z = corner_.z + static_cast<std::int64_t>(south(tile));
  return x < region_.x1 && x + side > region_.x0 && z < region_.z1 && z + side > region_.z0;
}

bool TileTree::has_content(const Tile& tile) const {
  return node_level(tile) <= levels_.coarsest && exists(tile);
}

}  // namespace psygen::tiles
