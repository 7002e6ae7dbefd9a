// Shards: shard I of N is the part of a job that one process makes without any other. Shards are
// cut by predicted cost (cost_map.hpp), recorded in a ledger next to their blocks, resumed after a
// kill at any moment, and merged at the end. Processes do not communicate, so shards can run
// anywhere at any time. One thread.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/amplify/amplify.hpp"
#include "engine/amplify/cost_map.hpp"
#include "engine/amplify/ledger.hpp"

namespace psygen::amplify {

inline constexpr std::uint64_t kMaxShards = 1'000'000;

// Shard `index` of `count`; indices start at 1.
struct Shard {
  std::uint64_t index = 1, count = 1;
};
// Parses "I/N". Fails with kInvalidArgument for anything but 1 <= I <= N <= kMaxShards.
core::Result<Shard> parse_shard(std::string_view text);
// "shard 3 of 8"; and the name of its ledger, "shard_3_of_8.ledger".
std::string text_of(const Shard& shard);
std::string ledger_name(const Shard& shard);

// The entries of a ledger whose blocks all have whole files in the folder. An entry with a missing
// file is dropped as a whole.
std::vector<Finished> with_files(std::vector<Finished> finished, const JobKey& key,
                                 const std::filesystem::path& folder);

// The job that the blocks belong to.
struct Job {
  const world::World& world;
  const models::Registry& registry;
  JobKey key;
};

// Makes the missing blocks of a shard and records them in its ledger in `folder`, which must exist.
// The source in `options` is ignored. The report covers the whole shard, including earlier runs.
// Fails like Ledger::open() and amplify().
core::Result<Report> amplify_shard(const Job& job, const Shard& shard,
                                   const std::filesystem::path& folder, const Options& options);

}  // namespace psygen::amplify
