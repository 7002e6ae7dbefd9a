// A share of a job that one process makes alone, without any other: shard I of N of a region. Cut
// by predicted cost (cost_map.hpp), noted in a ledger beside its blocks, gone on with after a kill
// at any moment, joined with the others at the end. Nothing here knows other processes: shards run
// where and when anybody likes. One thread, except where RunSource says otherwise.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "engine/amplify/amplify.hpp"
#include "engine/amplify/cost_map.hpp"
#include "engine/amplify/ledger.hpp"

namespace psygen::amplify {

inline constexpr std::uint64_t kMaxShards = 1'000'000;

// Shard `index` of `count`, from 1 on.
struct Shard {
  std::uint64_t index = 1, count = 1;
};
// Parses "I/N". Fails with kInvalidArgument for anything but 1 <= I <= N <= kMaxShards.
core::Result<Shard> parse_shard(std::string_view text);
// "shard 3 of 8", and the name of its ledger, "shard_3_of_8.ledger".
std::string text_of(const Shard& shard);
std::string ledger_name(const Shard& shard);

// Hands out blocks in runs that become shorter towards the end, so that threads end together, and
// notes in a ledger what is finished. Any thread.
class LedgerSource final : public RunSource {
 public:
  // The longest run: what a kill costs a thread at most.
  static constexpr std::uint64_t kMaxBlocks = 64;

  // `ledger` must outlive it.
  LedgerSource(BlockRanges todo, unsigned threads, Ledger& ledger);
  core::Result<std::optional<BlockRun>> next() override;
  core::Result<void> finished(const BlockRun& run, const Totals& totals) override;

 private:
  const BlockRanges todo_;
  const unsigned threads_;
  Ledger& ledger_;
  std::mutex mutex_;
  std::uint64_t position_ = 0;
};

// The next run from `position` of some blocks for one of `threads` threads: 1 to `most`
// neighbours, fewer towards the end. Requires position < todo.count().
BlockRun next_run(const BlockRanges& todo, std::uint64_t position, unsigned threads,
                  std::uint64_t most = LedgerSource::kMaxBlocks);

// Of what a ledger says, the entries of which every block has its whole file in the folder. An
// entry without one of its files is left out as a whole.
std::vector<Finished> with_files(std::vector<Finished> finished, const JobKey& key,
                                 const std::filesystem::path& folder);

// Whose blocks they are.
struct Job {
  const world::World& world;
  const models::Registry& registry;
  JobKey key;
};

// Makes what is missing of a shard and notes it in its ledger in `folder`, which exists. `options`
// says how; its source is ignored. The report covers the whole shard, earlier runs included.
// Fails like Ledger::open() and amplify().
core::Result<Report> amplify_shard(const Job& job, const Shard& shard,
                                   const std::filesystem::path& folder, const Options& options);

}  // namespace psygen::amplify
