// The common properties of all parts of one job: the world, its region, the files, and the version
// that makes them. Parts with different keys would make different bits and are never joined. Plain
// values; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "engine/amplify/region.hpp"
#include "engine/exchange/write_document.hpp"
#include "engine/models/registry.hpp"

namespace psygen::amplify {

// The format of a job's files; nothing: no files, only statistics.
using JobFormat = std::optional<exchange::Format>;
inline constexpr std::string_view kNoFiles = "none";
// "glb", "obj" or "none".
std::string_view name_of(const JobFormat& format);

struct JobKey {
  std::string version;            // version of psygen
  std::string world;              // the world's name, for messages
  std::uint64_t world_hash = 0;   // world::world_hash()
  std::uint64_t sample_hash = 0;  // of blocks in the middle of the region, all levels of detail
  Region region;
  JobFormat format;
  friend bool operator==(const JobKey&, const JobKey&) = default;
};

// The key of a job. Makes 9 blocks. Fails with kSynthesisFailed if one of their models fails.
core::Result<JobKey> job_key(const world::World& world, const models::Registry& registry,
                             const Region& region, JobFormat format, std::string_view version);

// The difference between `theirs` and `mine`, as in "the region 0,0,8,8 instead of 0,0,4,4"; empty
// if they are equal.
std::string difference(const JobKey& mine, const JobKey& theirs);

}  // namespace psygen::amplify
