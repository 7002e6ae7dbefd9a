#include "engine/cli/places.hpp"

#include <fmt/format.h>

#include <cmath>

namespace psygen::cli {
namespace {

// "0 to 32256" metres; endless worlds end at the largest block index.
std::string range_of(std::int64_t blocks, double block_size_m) {
  if (blocks > 0) return fmt::format("0 to {:g}", static_cast<double>(blocks) * block_size_m);
  return fmt::format("{:g} to {:g}", -0x1p31 * block_size_m, 0x1p31 * block_size_m);
}

}  // namespace

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
