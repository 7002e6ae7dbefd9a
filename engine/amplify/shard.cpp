#include "engine/amplify/shard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "engine/amplify/block_files.hpp"
#include "engine/core/log.hpp"

namespace psygen::amplify {

core::Result<Shard> parse_shard(std::string_view text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto index = std::from_chars(text.data(), end, shard.index);
  const bool slash = index.ec == std::errc() && index.ptr != end && *index.ptr == '/';
  const auto count = std::from_chars(slash ? index.ptr + 1 : end, end, shard.count);
  if (slash && count.ec == std::errc() && count.ptr == end && shard.index >= 1 &&
      shard.index <= shard.count && shard.count <= kMaxShards)
    return shard;
  return core::invalid_argument(
      fmt::format("'{}' is not a shard I/N with I from 1 to N and N up to {}", text, kMaxShards));
}

std::string text_of(const Shard& shard) {
  return fmt::format("shard {} of {}", shard.index, shard.count);
}

std::string ledger_name(const Shard& shard) {
  return fmt::format("shard_{}_of_{}{}", shard.index, shard.count, kLedgerExtension);
}

std::vector<Finished> with_files(std::vector<Finished> finished, const JobKey& key,
                                 const std::filesystem::path& folder) {
  if (!key.format) return finished;
  std::erase_if(finished, [&](const Finished& f) {
    for (std::uint64_t i = f.run.first; i < f.run.end; ++i)
      if (!has_block_file(folder, key.region.block(i), *key.format)) return true;
    return false;
  });
  return finished;
}

core::Result<Report> amplify_shard(const Job& job, const Shard& shard,
                                   const std::filesystem::path& folder, const Options& given) {
  const std::uint64_t blocks = job.key.region.block_count();
  const CostRates rates = CostRates::with_files(job.key.format.has_value());
  const CostMap costs = shard.count == 1
                            ? CostMap::flat(blocks)
                            : CostMap::of(job.world, job.registry, job.key.region, rates);
  const BlockRun share = shard_of(costs, shard.index, shard.count);
  auto ledger = Ledger::open(folder / ledger_name(shard), {job.key, text_of(shard), share, {}, 0});
  if (!ledger) return tl::unexpected(ledger.error());
  remove_partial_blocks(folder, [&](core::BlockCoord block) {
    const auto number = job.key.region.number_of(block);
    return number && *number >= share.first && *number < share.end;
  });
  const std::size_t noted = (*ledger)->finished().size();
  std::vector<Finished> known = with_files((*ledger)->finished(), job.key, folder);
  if (known.size() < noted)
    if (auto ok = (*ledger)->rewrite(known); !ok) return tl::unexpected(ok.error());
  const auto done = blocks_of(known);
  if (!done) return tl::unexpected(done.error());
  RunSource source(BlockRanges(share).without(*done), given.threads, ledger->get());
  Options options = given;
  options.source = &source;
  auto report = amplify(job.world, job.registry, job.key.region, options);
  if (!report) return report;
  for (const Finished& f : known)
    report->totals.add(f.totals);
  // The ledger already has everything, in more lines.
  if (auto ok = (*ledger)->rewrite(compacted((*ledger)->finished())); !ok)
    core::log_warning(ok.error().message);
  return report;
}

}  // namespace psygen::amplify
