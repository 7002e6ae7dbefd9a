#include "engine/amplify/job_key.hpp"

#include <fmt/format.h>

#include "engine/amplify/block_synthesiser.hpp"
#include "engine/world/files/world_file.hpp"

namespace psygen::amplify {

std::string_view name_of(const JobFormat& format) {
  return format ? exchange::name_of(*format) : kNoFiles;
}

core::Result<JobKey> job_key(const world::World& world, const models::Registry& registry,
                             const Region& region, JobFormat format, std::string_view version) {
  const core::BlockCoord middle{static_cast<std::int32_t>((region.x0 + region.x1) / 2),
                                static_cast<std::int32_t>((region.z0 + region.z1) / 2)};
  const auto sample = sample_world_hash(world, registry, middle);
  if (!sample) {
    return core::fail(core::ErrorCode::kSynthesisFailed,
                      fmt::format("the world {} cannot be divided: a model on the blocks around "
                                  "{},{} fails",
                                  world.name, middle.x, middle.z));
  }
  return JobKey{.version = std::string(version),
                .world = world.name,
                .world_hash = world::world_hash(world, registry),
                .sample_hash = *sample,
                .region = region,
                .format = format};
}

std::string difference(const JobKey& mine, const JobKey& theirs) {
  if (theirs.version != mine.version)
    return fmt::format("psygen {} instead of {}", theirs.version, mine.version);
  if (theirs.world_hash != mine.world_hash)
    return theirs.world == mine.world
               ? fmt::format("another version of the world {} or of the files that it names",
                             mine.world)
               : fmt::format("the world {} instead of {}", theirs.world, mine.world);
  if (theirs.region != mine.region)
    return fmt::format("the region {} instead of {}", text_of(theirs.region), text_of(mine.region));
  if (theirs.format != mine.format)
    return fmt::format("files of format {} instead of {}", name_of(theirs.format),
                       name_of(mine.format));
  if (theirs.sample_hash != mine.sample_hash)
    return fmt::format(
        "other bits for the same world (a sample has the hash {:016x} instead of "
        "{:016x}): another build of psygen",
        theirs.sample_hash, mine.sample_hash);
  return {};
}

}  // namespace psygen::amplify
