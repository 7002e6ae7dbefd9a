// What all parts of one job have in common: the world, its region, the files, and what makes them.
// Parts whose keys differ would make other bits and are never joined. Plain values; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/amplify/region.hpp"
#include "engine/exchange/write_document.hpp"
#include "engine/models/registry.hpp"

namespace psygen::amplify {

// The format of a job's files; none: only figures.
using JobFormat = std::optional<exchange::Format>;
inline constexpr std::string_view kNoFiles = "none";
// "glb", "obj" or "none".
std::string_view name_of(const JobFormat& format);

struct JobKey {
  std::string version;            // of psygen
  std::string world;              // its name, for messages
  std::uint64_t world_hash = 0;   // world::world_hash()
  std::uint64_t sample_hash = 0;  // of blocks in the middle of the region, at all levels of detail
  Region region;
  JobFormat format;
  friend bool operator==(const JobKey&, const JobKey&) = default;
};

// The key of a job. Makes 9 blocks. Fails with kSynthesisFailed if one of their models fails.
core::Result<JobKey> job_key(const world::World& world, const models::Registry& registry,
                             const Region& region, JobFormat format, std::string_view version);

// Where `theirs` differs from `mine`, as in "the region 0,0,8,8 instead of 0,0,4,4"; empty if
// equal.
std::string difference(const JobKey& mine, const JobKey& theirs);

}  // namespace psygen::amplify
