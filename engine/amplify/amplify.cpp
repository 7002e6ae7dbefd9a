#include "engine/amplify/amplify.hpp"

#include <fmt/format.h>

#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <optional>
#include <thread>

#include "engine/core/clock.hpp"
#include "engine/synthesis/thread_priority.hpp"

namespace psygen::amplify {
namespace {

constexpr std::chrono::milliseconds kProgressPeriod{100};

// What the threads share. The lock is taken once per thread, when it ends.
struct Shared {
  const world::World& world;
  const models::Registry& registry;
  const Region& region;
  const Options& options;
  const std::uint64_t block_count;
  alignas(64) std::atomic<std::uint64_t> next{0};
  alignas(64) std::atomic<bool> failed{false};
  std::mutex mutex{};
  std::condition_variable ended{};
  unsigned running = 0;
};

struct alignas(64) Worker {
  std::atomic<std::uint64_t> blocks_done{0};  // written by the thread only
  Totals totals;
  double cpu_seconds = 0;
  std::optional<core::Error> error;
  std::thread thread;

  void work(Shared& shared);
  core::Result<void> make_blocks(Shared& shared);
};

core::Result<void> Worker::make_blocks(Shared& shared) {
  const Options& options = shared.options;
  BlockSynthesizer synthesizer(shared.world, shared.registry);
  const std::unique_ptr<BlockSink> sink = options.make_sink ? options.make_sink() : nullptr;
  core::BlockCoord block;
  const std::function<void(const BlockMesh&)> visit = [&](const BlockMesh& mesh) {
    sink->add(block, mesh);
  };
  const std::function<void(const BlockMesh&)> discard;
  while (!shared.failed.load(std::memory_order_relaxed) &&
         !(options.stop != nullptr && options.stop->load(std::memory_order_relaxed))) {
    const std::uint64_t i = shared.next.fetch_add(1, std::memory_order_relaxed);
    if (i >= shared.block_count) break;
    block = shared.region.block(i);
    const bool wanted = sink && sink->wants(block);
    const std::uint64_t failed = totals.failed;
    synthesizer.synthesise(block, totals, wanted ? visit : discard);
    if (wanted && totals.failed > failed) {
      sink->drop(block);
    } else if (wanted) {
      if (auto ok = sink->finish(block); !ok) return ok;
    }
    blocks_done.store(totals.blocks, std::memory_order_relaxed);
  }
  return {};
}

void Worker::work(Shared& shared) {
  synthesis::name_this_thread("amplify");
  if (shared.options.lowest_priority) synthesis::lower_priority_of_this_thread();
  try {  // types and sinks of users may throw; nothing of ours does unless memory ends
    if (auto ok = make_blocks(shared); !ok) error = ok.error();
  } catch (const std::bad_alloc&) {
    error = core::Error{core::ErrorCode::kOutOfMemory, "the heap has no memory for a block"};
  } catch (const std::exception& e) {
    error =
        core::Error{core::ErrorCode::kSynthesisFailed, fmt::format("a block failed: {}", e.what())};
  } catch (...) {
    error = core::Error{core::ErrorCode::kSynthesisFailed,
                        "a block failed: something threw that is no std::exception"};
  }
  if (error) shared.failed.store(true, std::memory_order_relaxed);
  cpu_seconds = core::thread_cpu_seconds();
  const std::lock_guard lock(shared.mutex);
  --shared.running;
  shared.ended.notify_one();
}

void wait_for(Shared& shared, std::span<const std::unique_ptr<Worker>> workers) {
  std::unique_lock lock(shared.mutex);
  while (shared.running > 0) {
    shared.ended.wait_until(lock, std::chrono::system_clock::now() + kProgressPeriod);
    if (!shared.options.progress) continue;
    lock.unlock();
    std::uint64_t done = 0;
    for (const auto& worker : workers)
      done += worker->blocks_done.load(std::memory_order_relaxed);
    shared.options.progress(done);
    lock.lock();
  }
}

// False where the system allows no more threads or memory: those that there are do it.
bool start_one(Shared& shared, std::vector<std::unique_ptr<Worker>>& workers) {
  const auto set_running = [&shared](bool one_more) {
    const std::lock_guard lock(shared.mutex);
    one_more ? ++shared.running : --shared.running;
  };
  std::unique_ptr<Worker> worker(new (std::nothrow) Worker);
  if (!worker) return false;
  set_running(true);
  try {
    worker->thread = std::thread([&shared, w = worker.get()] { w->work(shared); });
  } catch (const std::exception&) {  // system_error or bad_alloc
    set_running(false);
    return false;
  }
  workers.push_back(std::move(worker));
  return true;
}

void start(Shared& shared, std::vector<std::unique_ptr<Worker>>& workers) {
  // No more threads than blocks.
  const std::uint64_t threads = std::min<std::uint64_t>(shared.options.threads, shared.block_count);
  workers.reserve(threads);  // nothing may throw while threads run that nobody joins
  for (std::uint64_t i = 0; i < threads; ++i) {
    if (!start_one(shared, workers)) return;
  }
}

}  // namespace

core::Result<Report> amplify(const world::World& world, const models::Registry& registry,
                             const Region& region, const Options& options) {
  if (auto ok = check_region(world, region); !ok) return tl::unexpected(ok.error());
  if (options.threads < 1 || options.threads > kMaxThreads) {
    return core::fail(core::ErrorCode::kInvalidArgument,
                      fmt::format("there may be 1 to {} threads", kMaxThreads));
  }
  Shared shared{world, registry, region, options, region.block_count()};
  std::vector<std::unique_ptr<Worker>> workers;
  const double start_s = core::monotonic_seconds();
  start(shared, workers);
  if (workers.empty()) return core::fail(core::ErrorCode::kInternal, "no thread can be started");
  wait_for(shared, workers);
  Report report;
  report.threads = static_cast<unsigned>(workers.size());
  for (const auto& worker : workers) {
    worker->thread.join();
    report.totals.add(worker->totals);
    report.cpu_seconds += worker->cpu_seconds;
  }
  report.seconds = core::monotonic_seconds() - start_s;
  for (const auto& worker : workers) {
    if (worker->error) return tl::unexpected(*worker->error);
  }
  report.region_blocks = shared.block_count;
  report.complete = report.totals.blocks == shared.block_count && report.totals.failed == 0;
  return report;
}

}  // namespace psygen::amplify
