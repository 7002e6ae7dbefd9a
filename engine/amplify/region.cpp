#include "engine/amplify/region.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>

namespace psygen::amplify {
namespace {

constexpr std::int64_t kFirstBlock = INT32_MIN;
constexpr std::int64_t kEndBlock = std::int64_t{INT32_MAX} + 1;

}  // namespace

std::uint64_t Region::block_count() const {
  const auto width = static_cast<std::uint64_t>(x1 - x0),
             depth = static_cast<std::uint64_t>(z1 - z0);
  constexpr std::uint64_t kAll = std::uint64_t{1} << 32;
  return width == kAll && depth == kAll ? UINT64_MAX : width * depth;
}

core::BlockCoord Region::block(std::uint64_t i) const {
  const auto width = static_cast<std::uint64_t>(x1 - x0);
  return {static_cast<std::int32_t>(x0 + static_cast<std::int64_t>(i % width)),
          static_cast<std::int32_t>(z0 + static_cast<std::int64_t>(i / width))};
}

std::optional<std::uint64_t> Region::number_of(core::BlockCoord block) const {
  if (block.x < x0 || block.x >= x1 || block.z < z0 || block.z >= z1) return std::nullopt;
  return static_cast<std::uint64_t>(block.z - z0) * static_cast<std::uint64_t>(x1 - x0) +
         static_cast<std::uint64_t>(block.x - x0);
}

core::Result<Region> parse_region(std::string_view text) {
  const auto refuse = [text](std::string_view why) {
    return core::invalid_argument(
        fmt::format("'{}' is not a region X0,Z0,X1,Z1 in blocks: {}", text, why));
  };
  std::array<std::int64_t, 4> values{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return refuse("it needs four integers");
    const auto parsed = std::from_chars(at, end, values[i]);
    if (parsed.ec != std::errc()) return refuse("it needs four integers");
    at = parsed.ptr;
  }
  if (at != end) return refuse("it needs four integers");
  const Region region{values[0], values[1], values[2], values[3]};
  if (region.x0 >= region.x1 || region.z0 >= region.z1)
    return refuse("its end must be greater than its start (the end is exclusive)");
  if (region.x0 < kFirstBlock || region.z0 < kFirstBlock || region.x1 > kEndBlock ||
      region.z1 > kEndBlock)
    return refuse(fmt::format("block coordinates must be {} to {}", kFirstBlock, kEndBlock - 1));
  return region;
}

std::string text_of(const Region& region) {
  return fmt::format("{},{},{},{}", region.x0, region.z0, region.x1, region.z1);
}

core::Result<Region> whole(const world::World& world) {
  if (world.is_endless()) {
    return core::invalid_argument(fmt::format(
        "the world {} is endless: choose a region, such as --region 0,0,16,16", world.name));
  }
  return Region{0, 0, world.blocks_x, world.blocks_z};
}

core::Result<void> check_region(const world::World& world, const Region& region) {
  const auto outside = [](std::int64_t first, std::int64_t end, std::int64_t blocks) {
    return blocks != 0 && (first < 0 || end > blocks);
  };
  if (!outside(region.x0, region.x1, world.blocks_x) &&
      !outside(region.z0, region.z1, world.blocks_z))
    return {};
  const auto range = [](std::int64_t blocks) {
    return blocks == 0 ? std::string("all") : fmt::format("0 to {}", blocks - 1);
  };
  return core::invalid_argument(
      fmt::format("the region {} extends beyond the world {}, whose blocks are x {}, z {}",
                  text_of(region), world.name, range(world.blocks_x), range(world.blocks_z)));
}

}  // namespace psygen::amplify
