#include "engine/amplify/amplify.hpp"

#include <fmt/format.h>

#include <condition_variable>
#include <thread>

#include "engine/amplify/ledger.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/headroom.hpp"
#include "engine/core/log.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/core/rounding.hpp"

namespace psygen::amplify {
namespace {

// State shared by the threads. Each thread takes the lock once, when it ends.
struct Shared {
  const world::World& world;
  const models::Registry& registry;
  const Region& region;
  const Options& options;
  RunSource& source;
  const std::uint64_t block_count;
  alignas(64) std::atomic<bool> failed{false};
  std::atomic<bool> stopped{false};
  std::mutex mutex{};
  std::condition_variable ended{};
  int running = 0;
};

struct alignas(64) Worker {
  std::atomic<std::uint64_t> blocks_done{0};  // only the thread writes it
  Totals totals;
  double cpu_seconds = 0;
  std::optional<core::Error> error;
  std::thread thread;

  void work(Shared& shared);
  core::Result<void> make_blocks(Shared& shared);
  // Makes the blocks of a run. Returns false if it was stopped.
  core::Result<bool> make_run(Shared& shared, BlockSynthesiser& synthesiser, BlockSink* sink,
                              const BlockRun& run, Totals& made);
};

bool is_over(Shared& shared) {
  if (shared.failed.load(std::memory_order_relaxed)) return true;
  const std::atomic<bool>* stop = shared.options.stop;
  if (stop == nullptr || !stop->load(std::memory_order_relaxed)) return false;
  shared.stopped.store(true, std::memory_order_relaxed);
  return true;
}

core::Result<bool> Worker::make_run(Shared& shared, BlockSynthesiser& synthesiser, BlockSink* sink,
                                    const BlockRun& run, Totals& made) {
  core::BlockCoord block;
  const std::function<void(const BlockMesh&)> visit = [&](const BlockMesh& mesh) {
    sink->add(block, mesh);
  };
  const std::function<void(const BlockMesh&)> discard;
  for (std::uint64_t i = run.first; i < run.end; ++i) {
    if (i > run.first && is_over(shared)) return false;
    block = shared.region.block(i);
    const bool wanted = sink != nullptr && sink->wants(block);
    const std::uint64_t failed_before = made.failed;
    synthesiser.synthesise(block, made, wanted ? visit : discard);
    if (wanted && made.failed > failed_before) {
      sink->drop(block);
    } else if (wanted) {
      if (auto ok = sink->finish(block); !ok) return tl::unexpected(ok.error());
    }
    blocks_done.fetch_add(1, std::memory_order_relaxed);
  }
  return true;
}

core::Result<void> Worker::make_blocks(Shared& shared) {
  const Options& options = shared.options;
  BlockSynthesiser synthesiser(shared.world, shared.registry);
  const std::unique_ptr<BlockSink> sink = options.make_sink ? options.make_sink() : nullptr;
  while (!shared.failed.load(std::memory_order_relaxed)) {
    const auto run = shared.source.next();
    if (!run || is_over(shared)) break;
    Totals made;
    const auto whole = make_run(shared, synthesiser, sink.get(), *run, made);
    totals.add(made);
    if (!whole) return tl::unexpected(whole.error());
    if (!*whole) break;
    if (made.failed > 0) continue;
    if (auto ok = shared.source.finished(*run, made); !ok) return ok;
  }
  return {};
}

void Worker::work(Shared& shared) {
  core::name_this_thread("amplify");
  if (shared.options.lowest_priority) core::lower_priority_of_this_thread();
  // User types and sinks may throw; our own code throws only when memory is exhausted.
  const auto made = core::catch_exceptions(
      core::ErrorCode::kSynthesisFailed, [] { return "a block"; }, "failed",
      [&] { return make_blocks(shared); });
  if (!made) error = made.error();
  if (error) shared.failed.store(true, std::memory_order_relaxed);
  cpu_seconds = core::thread_cpu_seconds();
  const std::lock_guard lock(shared.mutex);
  --shared.running;
  shared.ended.notify_one();
}

void wait_for(Shared& shared, std::span<const std::unique_ptr<Worker>> workers) {
  const std::chrono::milliseconds period(shared.options.progress_period_ms);
  std::unique_lock lock(shared.mutex);
  while (shared.running > 0) {
    shared.ended.wait_until(lock, std::chrono::system_clock::now() + period);
    if (!shared.options.progress) continue;
    lock.unlock();
    std::uint64_t done = 0;
    for (const auto& worker : workers)
      done += worker->blocks_done.load(std::memory_order_relaxed);
    shared.options.progress(done);
    lock.lock();
  }
}

// The threads of a run. The destructor stops and joins them.
struct Crew {
  Shared& shared;
  std::vector<std::unique_ptr<Worker>> workers{};

  core::Result<void> add_one() {
    Worker& worker = *workers.emplace_back(std::make_unique<Worker>());
    set_running(1);
    auto thread = core::start_thread([this, &worker] { worker.work(shared); });
    if (thread) {
      worker.thread = std::move(*thread);
      return {};
    }
    set_running(-1);
    workers.pop_back();
    return tl::unexpected(thread.error());
  }
  void set_running(int change) {
    const std::lock_guard lock(shared.mutex);
    shared.running += change;
  }
  void join() {
    for (const auto& worker : workers)
      if (worker->thread.joinable()) worker->thread.join();
  }
  ~Crew() {
    shared.failed.store(true, std::memory_order_relaxed);
    join();
  }
};

// Starts the requested threads, at most one per block, or as many as the system allows. Fails if it
// allows none.
core::Result<void> start(Crew& crew) {
  const std::uint64_t wanted =
      std::min<std::uint64_t>(crew.shared.options.threads, crew.shared.block_count);
  while (crew.workers.size() < wanted) {
    const auto added = crew.add_one();
    if (added) continue;
    if (crew.workers.empty()) return added;
    core::log_warning(fmt::format("only {} of {} threads can be started: {}", crew.workers.size(),
                                  wanted, added.error().message));
    break;
  }
  return {};
}

}  // namespace

BlockRun next_run(const BlockRanges& todo, std::uint64_t position, unsigned threads,
                  std::uint64_t most) {
  constexpr std::uint64_t kRunsPerThread = 4;  // of the remaining blocks
  const std::uint64_t left = todo.count() - position;
  const std::uint64_t wanted =
      std::clamp<std::uint64_t>(left / (kRunsPerThread * threads), 1, most);
  const BlockRanges next = todo.sub(position, position + wanted);
  return next.runs().front();
}

RunSource::RunSource(BlockRanges todo, unsigned threads, Ledger* ledger, More more)
    : todo_(std::move(todo)), threads_(threads), ledger_(ledger), more_(std::move(more)) {}

// The thread that finds no block left asks for more while the others wait some microseconds.
std::optional<BlockRun> RunSource::next() {
  const std::lock_guard lock(mutex_);
  while (position_ == todo_.count()) {
    if (!more_) return std::nullopt;
    todo_ = more_();
    position_ = 0;
    if (todo_.count() == 0) more_ = nullptr;
  }
  const BlockRun run = next_run(todo_, position_, threads_);
  position_ += run.count();
  return run;
}

core::Result<void> RunSource::finished(const BlockRun& run, const Totals& totals) {
  return ledger_ == nullptr ? core::Result<void>{} : ledger_->add({run, totals});
}

core::Result<Report> amplify(const world::World& world, const models::Registry& registry,
                             const Region& region, const Options& options) {
  const core::RoundToNearest rounding;
  if (auto ok = check_region(world, region); !ok) return tl::unexpected(ok.error());
  if (options.threads < 1 || options.threads > kMaxThreads) {
    return core::invalid_argument(
        fmt::format("the number of threads must be 1 to {}", kMaxThreads));
  }
  RunSource all(BlockRanges({0, region.block_count()}), options.threads);
  RunSource& source = options.source != nullptr ? *options.source : all;
  Shared shared{world, registry, region, options, source, region.block_count()};
  Crew crew{shared};
  const std::vector<std::unique_ptr<Worker>>& workers = crew.workers;
  const double start_s = core::monotonic_seconds();
  if (auto ok = start(crew); !ok) return tl::unexpected(ok.error());
  wait_for(shared, workers);
  crew.join();
  Report report;
  report.threads = static_cast<unsigned>(workers.size());
  for (const auto& worker : workers) {
    report.totals.add(worker->totals);
    report.cpu_seconds += worker->cpu_seconds;
  }
  report.seconds = core::monotonic_seconds() - start_s;
  for (const auto& worker : workers) {
    if (worker->error) return tl::unexpected(*worker->error);
  }
  report.stopped = shared.stopped.load(std::memory_order_relaxed);
  report.complete = !report.stopped && report.totals.failed == 0;
  return report;
}

}  // namespace psygen::amplify
