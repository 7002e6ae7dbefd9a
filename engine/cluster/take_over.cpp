#include "engine/cluster/take_over.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/amplify/block_files.hpp"
#include "engine/amplify/shard.hpp"
#include "engine/core/replace_file.hpp"

namespace psygen::cluster {
namespace {

using amplify::Finished;

constexpr const char* kWhole = "all blocks";

bool is_rank_ledger(const std::string& name) {
  return name.starts_with("rank_") && name.ends_with(amplify::kLedgerExtension);
}

std::vector<std::filesystem::path> rank_ledgers(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    if (is_rank_ledger(it->path().filename().string())) files.push_back(it->path());
  }
  return files;
}

bool holds(const std::vector<Finished>& all, const amplify::BlockRun& run) {
  return std::ranges::any_of(
      all, [&](const Finished& f) { return f.run.first <= run.first && run.end <= f.run.end; });
}

// Adds the finished blocks of the ranks' ledgers. An entry that a killed job had already merged is
// in both ledgers; it counts once.
core::Result<void> add_from(const std::vector<std::filesystem::path>& files,
                            const amplify::JobKey& key, std::vector<Finished>& all) {
  const std::vector<Finished> before = all;
  for (const std::filesystem::path& file : files) {
    auto ledger = amplify::read_ledger(file);
    if (!ledger) return tl::unexpected(ledger.error());
    const std::string other = amplify::difference(key, ledger->key);
    if (!other.empty())
      return core::fail(
          core::ErrorCode::kInvalidArgument,
          fmt::format("{}: belongs to {}; choose another folder", file.string(), other));
    for (Finished& finished : ledger->finished)
      if (!holds(before, finished.run)) all.push_back(std::move(finished));
  }
  return {};
}

}  // namespace

std::filesystem::path rank_ledger(const std::filesystem::path& folder, unsigned rank) {
  return folder / fmt::format("rank_{}{}", rank, amplify::kLedgerExtension);
}

core::Result<void> gather_ledgers(const std::filesystem::path& folder, amplify::Ledger& job,
                                  Check check) {
  const std::vector<std::filesystem::path> files = rank_ledgers(folder);
  std::vector<Finished> all = job.finished();
  if (auto ok = add_from(files, job.key(), all); !ok) return ok;
  if (auto once = amplify::blocks_of(all); !once)
    return core::fail(
        core::ErrorCode::kInvalidArgument,
        fmt::format("{}: its ledgers contradict each other: {}; remove them (existing "
                    "blocks are not written again)",
                    folder.string(), once.error().message));
  if (check == Check::kFiles) all = amplify::with_files(std::move(all), job.key(), folder);
  if (auto ok = job.rewrite(amplify::compacted(std::move(all))); !ok) return ok;
  for (const std::filesystem::path& file : files) {
    std::error_code error;
    std::filesystem::remove(file, error);
    if (error)
      return core::fail(core::ErrorCode::kIo, fmt::format("{}: cannot remove the file: {}",
                                                          file.string(), error.message()));
  }
  return {};
}

core::Result<std::unique_ptr<amplify::Ledger>> take_over(const std::filesystem::path& folder,
                                                         const amplify::JobKey& key) {
  const amplify::BlockRun all{0, key.region.block_count()};
  auto job = amplify::Ledger::open(folder / fmt::format("job{}", amplify::kLedgerExtension),
                                   {key, kWhole, all, {}, 0});
  if (!job) return job;
  amplify::remove_partial_blocks(folder, [](core::BlockCoord) { return true; });
  core::remove_partials_of(folder, is_rank_ledger);
  if (auto ok = gather_ledgers(folder, **job, Check::kFiles); !ok)
    return tl::unexpected(ok.error());
  return job;
}

}  // namespace psygen::cluster
