#include "engine/cluster/job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <thread>
#include <utility>

#include "engine/cluster/meeting.hpp"
#include "engine/cluster/plan.hpp"
#include "engine/core/bytes.hpp"
#include "engine/core/processors.hpp"
#include "engine/core/replace_file.hpp"

namespace psygen::cluster {
namespace {

using amplify::BlockRanges;
using amplify::BlockRun;
using amplify::Finished;
using amplify::Totals;

constexpr unsigned kProgressMs = 1, kShownMs = 100;

tl::unexpected<JobError> common(const core::Error& error) {
  return tl::unexpected(JobError{error, true});
}

std::string text_of(const BlockRanges& blocks) {
  std::string text;
  for (const BlockRun& run : blocks.runs())
    text += fmt::format("{} {} ", run.first, run.end);
  return text;
}

BlockRanges ranges_from(const std::string& text) {
  std::istringstream numbers(text);
  BlockRanges blocks;
  for (BlockRun run; numbers >> run.first >> run.end;)
    blocks.append(run);
  return blocks;
}

// Each rank predicts the cost of its part of the samples; all ranks get the combined costs.
amplify::CostMap shared_costs(const world::World& world, const models::Registry& registry,
                              const amplify::JobKey& key, Peers& peers) {
  const std::uint64_t blocks = key.region.block_count();
  if (peers.count() == 1) return amplify::CostMap::flat(blocks);
  const amplify::CostRates rates = amplify::CostRates::with_files(key.format.has_value());
  const std::uint64_t samples = amplify::sample_count(key.region);
  const auto border = [&](std::uint64_t rank) { return samples * rank / peers.count(); };
  const std::vector<double> mine = amplify::prices_of(
      world, registry, key.region, rates, border(peers.rank()), border(peers.rank() + 1));
  std::string bytes;
  core::put_all(bytes, std::span(mine));
  std::vector<double> all;
  for (const std::string& part : peers.exchange(bytes)) {
    const auto theirs = core::ByteReader(part).get_all<double>(part.size() / sizeof(double));
    all.insert(all.end(), theirs.begin(), theirs.end());
  }
  return amplify::CostMap::from(blocks, std::move(all));
}

std::string bytes_of(const JobReport& job) {
  const amplify::Report& r = job.report;
  const Totals& t = r.totals;
  std::string bytes;
  core::put(bytes, t.blocks, t.models, t.triangles, t.bytes, t.failed, t.hash.sum(), t.hash.count(),
            r.threads, r.cpu_seconds, r.seconds, job.written, job.skipped, job.messages);
  return bytes + t.first_failure;
}

void add_from(const std::string& bytes, JobReport& sum) {
  core::ByteReader in(bytes);
  JobReport part;
  amplify::Report &r = part.report, &all = sum.report;
  Totals& t = r.totals;
  std::uint64_t hash_sum = 0, hash_count = 0;
  in.read(t.blocks, t.models, t.triangles, t.bytes, t.failed, hash_sum, hash_count, r.threads,
          r.cpu_seconds, r.seconds, part.written, part.skipped, part.messages);
  t.first_failure = in.get_text(in.left());
  t.hash = synthesis::WorldHash::restored(hash_sum, hash_count);
  all.totals.add(t);
  all.threads += r.threads;
  all.cpu_seconds += r.cpu_seconds;
  all.seconds = std::max(all.seconds, r.seconds);
  sum.written += part.written;
  sum.skipped += part.skipped;
  sum.messages += part.messages;
}

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

bool holds(const std::vector<Finished>& all, const BlockRun& run) {
  return std::ranges::any_of(
      all, [&](const Finished& f) { return f.run.first <= run.first && run.end <= f.run.end; });
}

// Adds the finished blocks of the ranks' ledgers. An entry that a killed job had already merged is
// in both ledgers; it counts once.
core::Result<void> add_finished_from(const std::vector<std::filesystem::path>& files,
                                     const amplify::JobKey& key, std::vector<Finished>& all) {
  const std::vector<Finished> before = all;
  for (const std::filesystem::path& file : files) {
    auto ledger = amplify::read_ledger(file);
    if (!ledger) return tl::unexpected(ledger.error());
    const std::string other = amplify::difference(key, ledger->key);
    if (!other.empty())
      return core::invalid_argument(
          fmt::format("{}: belongs to {}; choose another folder", file.string(), other));
    for (Finished& finished : ledger->finished)
      if (!holds(before, finished.run)) all.push_back(std::move(finished));
  }
  return {};
}

// Path of a rank's ledger in a folder; the ledger of the whole job is "job.ledger".
std::filesystem::path rank_ledger(const std::filesystem::path& folder, unsigned rank) {
  return folder / fmt::format("rank_{}{}", rank, amplify::kLedgerExtension);
}

// kFiles checks that every finished block of an earlier job still has its files.
enum class Check : std::uint8_t { kNothing, kFiles };

// Merges the ledgers of all ranks into the ledger of the job, and removes them. With Check::kFiles,
// drops entries that lost a file. For one rank, while no other writes into the folder. Fails with
// kIo, with kParse, and with kInvalidArgument if the ledgers belong to another job.
core::Result<void> gather_ledgers(const std::filesystem::path& folder, amplify::Ledger& job,
                                  Check check) {
  const std::vector<std::filesystem::path> files = rank_ledgers(folder);
  std::vector<Finished> all = job.finished();
  if (auto ok = add_finished_from(files, job.key(), all); !ok) return ok;
  if (auto once = amplify::blocks_of(all); !once)
    return core::invalid_argument(
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

// Opens the ledger of the whole job, locked for this process; removes half-written blocks and
// merges the ledgers of an earlier job. Fails like Ledger::open() and gather_ledgers().
core::Result<std::unique_ptr<amplify::Ledger>> take_over(const std::filesystem::path& folder,
                                                         const amplify::JobKey& key) {
  const BlockRun all{0, key.region.block_count()};
  auto job = amplify::Ledger::open(folder / fmt::format("job{}", amplify::kLedgerExtension),
                                   {key, kWhole, all, {}, 0});
  if (!job) return job;
  amplify::remove_partial_blocks(folder, [](core::BlockCoord) { return true; });
  core::remove_partials_of(folder, is_rank_ledger);
  if (auto ok = gather_ledgers(folder, **job, Check::kFiles); !ok)
    return tl::unexpected(ok.error());
  return job;
}

// State of a job during set-up: the steps of amplify_together(), in order.
struct Start {
  const world::World& world;
  const models::Registry& registry;
  const std::filesystem::path& folder;
  Peers& peers;
  amplify::JobKey key{};
  std::unique_ptr<amplify::Ledger> job{}, mine{};  // job: on rank 0 only
  std::unique_ptr<amplify::BlockFolder> files{};
  BlockRanges done{};

  // Rank 0 opens the ledger of the job and sends the finished blocks to the other ranks.
  core::Result<void> take_over_folder() {
    core::Result<std::unique_ptr<amplify::Ledger>> opened;
    if (peers.rank() == 0) opened = take_over(folder, key);
    if (auto ok = agree(opened, peers); !ok) return ok;
    job = std::move(*opened);
    const std::string text = job ? text_of(*amplify::blocks_of(job->finished())) : "";
    done = ranges_from(peers.exchange(text).front());
    return {};
  }

  // Rank 0 opens first, so that it alone claims the folder.
  core::Result<void> open_files(bool now) {
    if (!now || !key.format) return agree({}, peers);
    auto opened = amplify::BlockFolder::open(folder, world, registry, *key.format);
    if (opened) files = std::move(*opened);
    return agree(opened, peers);
  }

  core::Result<void> open_ledger() {
    auto opened = amplify::Ledger::open(
        rank_ledger(folder, peers.rank()),
        {key, fmt::format("rank {}", peers.rank()), {0, key.region.block_count()}, {}, 0});
    if (opened) mine = std::move(*opened);
    return agree(opened, peers);
  }

  core::Result<void> open() {
    if (auto ok = check_folder(folder, peers); !ok) return ok;
    if (auto ok = take_over_folder(); !ok) return ok;
    if (auto ok = open_files(peers.rank() == 0); !ok) return ok;
    if (auto ok = open_files(peers.rank() != 0); !ok) return ok;
    return open_ledger();
  }
};

// Synthesises the blocks of this rank: first its fixed share, then chunks that it claims one at a
// time.
core::Result<amplify::Report> run_rank(Start& start, const amplify::Options& given) {
  const amplify::Region& region = start.key.region;
  Peers& peers = start.peers;
  const Plan plan(BlockRanges({0, region.block_count()}).without(start.done),
                  shared_costs(start.world, start.registry, start.key, peers), peers.count());
  amplify::RunSource source(plan.own(peers.rank()), given.threads, start.mine.get(), [&] {
    const std::uint64_t chunk = plan.chunk_count() > 0 ? peers.claim() : 0;
    return chunk < plan.chunk_count() ? plan.chunk(chunk) : BlockRanges();
  });
  amplify::Options options = given;
  options.source = &source;
  options.make_sink = nullptr;
  if (start.files) options.make_sink = [&start] { return start.files->make_sink(); };
  unsigned calls = 0;
  if (peers.rank() == 0 && peers.count() > 1) {
    options.progress_period_ms = kProgressMs;
    options.progress = [&](std::uint64_t blocks) {
      peers.progress();
      if (given.progress && ++calls % (kShownMs / kProgressMs) == 0) given.progress(blocks);
    };
  }
  return amplify::amplify(start.world, start.registry, region, options);
}

}  // namespace

unsigned threads_for_rank(unsigned allowed, unsigned of_machine, unsigned ranks_here) {
  return std::max(1u, std::min(allowed, of_machine / std::max(1u, ranks_here)));
}

unsigned threads_for_rank(const Peers& peers) {
  return threads_for_rank(core::allowed_processors(),
                          core::within_quota(std::thread::hardware_concurrency()),
                          peers.count_here());
}

tl::expected<JobReport, JobError> amplify_together(const world::World& world,
                                                   const models::Registry& registry,
                                                   const core::Result<amplify::JobKey>& key,
                                                   const std::filesystem::path& folder,
                                                   const amplify::Options& options, Peers& peers) {
  if (auto ok = check_same_job(key, !folder.empty(), peers); !ok) return common(ok.error());
  Start start{world, registry, folder, peers, *key};
  if (!folder.empty())
    if (auto ok = start.open(); !ok) return common(ok.error());
  auto made = run_rank(start, options);
  if (!made) return tl::unexpected(JobError{made.error(), false});
  JobReport own{std::move(*made), 0, 0, peers.messages()};
  if (start.files) {
    own.written = start.files->written();
    own.skipped = start.files->skipped();
  }
  if (own.report.stopped) return own;
  JobReport all;
  for (const std::string& bytes : peers.exchange(bytes_of(own)))
    add_from(bytes, all);
  core::Result<void> gathered{};
  start.mine.reset();
  if (start.job) {
    for (const amplify::Finished& finished : start.job->finished())
      all.report.totals.add(finished.totals);
  }
  // agree() returns once every rank has closed its ledger.
  if (auto ok = agree({}, peers); !ok) return common(ok.error());
  if (start.job) gathered = gather_ledgers(folder, *start.job, Check::kNothing);
  if (auto ok = agree(gathered, peers); !ok) return common(ok.error());
  all.report.complete = all.report.totals.failed == 0;
  return all;
}

}  // namespace psygen::cluster
