#include "engine/cli/text_values.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

namespace psygen::cli {
namespace {

// Removes and returns the number at the start of `text`.
std::optional<std::uint64_t> leading_number(std::string_view& text) {
  std::uint64_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr == text.data()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(result.ptr - text.data()));
  return value;
}

// Reads "X,Z". Returns false unless both are numbers and span the text.
template <class Number>
bool read_pair(std::string_view text, Number& x, Number& z) {
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, x);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != ',') return false;
  const auto second = std::from_chars(first.ptr + 1, end, z);
  return second.ec == std::errc() && second.ptr == end;
}

// "0 to 32256" metres; endless worlds end at the largest block index.
std::string range_of(std::int64_t blocks, double block_size_m) {
  if (blocks > 0) return fmt::format("0 to {:g}", static_cast<double>(blocks) * block_size_m);
  return fmt::format("{:g} to {:g}", -0x1p31 * block_size_m, 0x1p31 * block_size_m);
}

}  // namespace

core::Result<std::uint64_t> parse_bytes(const std::string& text) {
  const auto refuse = [&text] {
    return core::invalid_argument(
        fmt::format("'{}' is not a number of bytes such as 512M or 2G", text));
  };
  std::string_view rest = text;
  const auto value = leading_number(rest);
  if (!value) return refuse();
  unsigned shift = 0;
  if (!rest.empty()) {
    const std::size_t unit = std::string_view("KMGT").find(rest.front() & ~0x20);
    if (unit == std::string_view::npos) return refuse();
    shift = 10 * (static_cast<unsigned>(unit) + 1);
    rest.remove_prefix(1);
    if (!rest.empty() && rest != "B" && rest != "iB") return refuse();
  }
  if (*value > (std::numeric_limits<std::uint64_t>::max() >> shift)) return refuse();
  return *value << shift;
}

core::Result<core::Extent> parse_size(const std::string& text) {
  constexpr std::uint64_t kMaxPixels = 16384;
  std::string_view rest = text;
  const std::uint64_t width = leading_number(rest).value_or(0);
  const bool separated = !rest.empty() && (rest.front() == 'x' || rest.front() == 'X');
  if (separated) rest.remove_prefix(1);
  const std::uint64_t height = separated ? leading_number(rest).value_or(0) : 0;
  if (!rest.empty() || width < 1 || height < 1 || width > kMaxPixels || height > kMaxPixels) {
    return core::invalid_argument(
        fmt::format("'{}' is not a size such as 1280x720 (1 to 16384 each)", text));
  }
  return core::Extent{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

core::Result<glm::dvec2> parse_place(const std::string& text) {
  glm::dvec2 place{0.0};
  if (read_pair(text, place.x, place.y) && std::isfinite(place.x) && std::isfinite(place.y))
    return place;
  return core::invalid_argument(fmt::format("'{}' is not a position X,Z in metres", text));
}

core::Result<core::BlockCoord> parse_block(const std::string& text) {
  core::BlockCoord block;
  if (read_pair(text, block.x, block.z)) return block;
  return core::invalid_argument(fmt::format("'{}' is not a block X,Z", text));
}

core::Result<core::WorldPosition> position_at(const world::World& world, glm::dvec2 place) {
  const double size_m = world.block_size_m();
  const double x = std::floor(place.x / size_m), z = std::floor(place.y / size_m);
  const auto exists = [](double block) { return block >= INT32_MIN && block <= INT32_MAX; };
  const bool some = exists(x) && exists(z);
  core::WorldPosition at;
  if (some) at.block = {static_cast<std::int32_t>(x), static_cast<std::int32_t>(z)};
  if (!some || !world.contains(at.block)) {
    return core::invalid_argument(fmt::format(
        "{},{} is outside the world {}: X is {} m, Z is {} m", place.x, place.y, world.name,
        range_of(world.blocks_x, size_m), range_of(world.blocks_z, size_m)));
  }
  at.local = {place.x - x * size_m, 0.0, place.y - z * size_m};
  return at;
}

}  // namespace psygen::cli
