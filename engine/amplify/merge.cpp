#include "engine/amplify/merge.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/amplify/block_files.hpp"

namespace psygen::amplify {
namespace {

core::Result<std::vector<std::filesystem::path>> ledger_files(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return std::vector{path};
  std::vector<std::filesystem::path> files;
  for (std::filesystem::directory_iterator it(path, error), end; !error && it != end;
       it.increment(error))
    if (it->path().extension() == kLedgerExtension) files.push_back(it->path());
  if (error)
    return core::fail(core::ErrorCode::kIo,
                      fmt::format("{}: cannot be read: {}", path.string(), error.message()));
  if (files.empty())
    return core::invalid_argument(
        fmt::format("{}: has no ledger of a shard (shard_I_of_N.ledger)", path.string()));
  return files;
}

struct Entry {
  const Finished* finished;
  const NamedLedger* from;
};

std::string blocks_text(const Region& region, const BlockRun& run) {
  const core::BlockCoord first = region.block(run.first);
  if (run.count() == 1) return fmt::format("the block {},{} is", first.x, first.z);
  const core::BlockCoord last = region.block(run.end - 1);
  return fmt::format("{} blocks from {},{} to {},{} are", run.count(), first.x, first.z, last.x,
                     last.z);
}

// The part, of these ledgers, that has the block.
std::string owner_of(std::span<const NamedLedger> ledgers, std::uint64_t block) {
  for (const NamedLedger& l : ledgers)
    if (block >= l.ledger.share.first && block < l.ledger.share.end)
      return fmt::format("{} has not finished ({})", l.ledger.part, l.file.string());
  return "the ledger of their shard is missing";
}

core::Result<void> check_files(const NamedLedger& named) {
  const JobKey& key = named.ledger.key;
  if (!key.format) return {};
  const auto folder = named.file.has_parent_path() ? named.file.parent_path() : ".";
  for (const Finished& finished : named.ledger.finished) {
    for (std::uint64_t i = finished.run.first; i < finished.run.end; ++i) {
      const core::BlockCoord block = key.region.block(i);
      if (has_block_file(folder, block, *key.format)) continue;
      return core::invalid_argument(
          fmt::format("{}: the file of block {},{} is missing or truncated; "
                      "run {} again",
                      folder.string(), block.x, block.z, named.ledger.part));
    }
  }
  return {};
}

}  // namespace

core::Result<std::vector<NamedLedger>> read_ledgers(std::span<const std::filesystem::path> paths) {
  std::vector<NamedLedger> ledgers;
  for (const std::filesystem::path& path : paths) {
    const auto files = ledger_files(path);
    if (!files) return tl::unexpected(files.error());
    for (const std::filesystem::path& file : *files) {
      auto ledger = read_ledger(file);
      if (!ledger) return tl::unexpected(ledger.error());
      ledgers.push_back({file, std::move(*ledger)});
    }
  }
  std::ranges::sort(ledgers, {}, &NamedLedger::file);
  return ledgers;
}

core::Result<Totals> merge(std::span<const NamedLedger> ledgers) {
  if (ledgers.empty()) return core::invalid_argument("there is no ledger to merge");
  const JobKey& key = ledgers.front().ledger.key;
  std::vector<Entry> entries;
  for (const NamedLedger& named : ledgers) {
    const std::string other = difference(key, named.ledger.key);
    if (!other.empty())
      return core::invalid_argument(fmt::format("{}: belongs to another job than {}: {}",
                                                named.file.string(), ledgers.front().file.string(),
                                                other));
    for (const Finished& finished : named.ledger.finished)
      entries.push_back({&finished, &named});
  }
  std::ranges::sort(entries, {}, [](const Entry& e) { return e.finished->run.first; });
  Totals totals;
  std::uint64_t next = 0;
  const NamedLedger* before = nullptr;
  for (const Entry& entry : entries) {
    const BlockRun& run = entry.finished->run;
    if (run.first < next)
      return core::invalid_argument(fmt::format(
          "{} in both {} and {}", blocks_text(key.region, {run.first, std::min(run.end, next)}),
          before->file.string(), entry.from->file.string()));
    if (run.first > next) break;
    totals.add(entry.finished->totals);
    next = run.end;
    before = entry.from;
  }
  if (const std::uint64_t all = key.region.block_count(); next < all) {
    const auto after = std::ranges::find_if(
        entries, [next](const Entry& e) { return e.finished->run.first > next; });
    const std::uint64_t end = after == entries.end() ? all : after->finished->run.first;
    return core::invalid_argument(fmt::format(
        "{} missing: {}", blocks_text(key.region, {next, end}), owner_of(ledgers, next)));
  }
  for (const NamedLedger& named : ledgers)
    if (auto ok = check_files(named); !ok) return tl::unexpected(ok.error());
  return totals;
}

}  // namespace psygen::amplify
