// Data amplification without a camera: synthesises all blocks of a region at full detail on several
// threads. Meshes are discarded or passed to a sink, and one hash identifies all of them. The hash
// does not depend on the number of threads or on their order. Threads share only the source of the
// next blocks. It draws nothing.
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "engine/amplify/block_ranges.hpp"
#include "engine/amplify/block_synthesiser.hpp"
#include "engine/amplify/region.hpp"

namespace psygen::amplify {

inline constexpr unsigned kMaxThreads = 256;
// One thread per processor, within 1 … kMaxThreads. `processors` is 0 if their number is unknown.
constexpr unsigned threads_for(unsigned processors) {
  return std::clamp(processors, 1u, kMaxThreads);
}

// Takes the meshes of one thread, which makes all calls. For each block: wants(), and if true add()
// for every mesh, then finish() or drop().
class BlockSink {
 public:
  virtual ~BlockSink() = default;
  // One mesh, valid during the call.
  virtual void add(core::BlockCoord block, const BlockMesh& mesh) = 0;  // terrain first
  // All meshes of the block have been added. A failure ends the whole run.
  virtual core::Result<void> finish(core::BlockCoord block) = 0;
  // Called instead of finish() if a mesh of the block failed: discards the added meshes.
  virtual void drop(core::BlockCoord block) = 0;
  // Returns true if this sink needs the meshes of the block.
  virtual bool wants(core::BlockCoord block) = 0;
};

// The longest run of blocks: the maximum work that a kill costs a thread.
inline constexpr std::uint64_t kMaxRun = 64;
// The next run from `position` of some blocks for one of `threads` threads: 1 to `most`
// neighbours, fewer towards the end. Requires position < todo.count().
BlockRun next_run(const BlockRanges& todo, std::uint64_t position, unsigned threads,
                  std::uint64_t most = kMaxRun);

class Ledger;

// Hands out blocks to the threads of a run, which make all calls, several at once. Runs become
// shorter towards the end, so that threads end together. Records finished runs in a ledger.
class RunSource {
 public:
  // Returns further blocks once all are handed out; empty at the end. One call at a time.
  using More = std::function<BlockRanges()>;

  // `ledger` may be null, and outlives the source.
  RunSource(BlockRanges todo, unsigned threads, Ledger* ledger = nullptr, More more = {});
  // The next blocks for the calling thread, or nothing at the end.
  std::optional<BlockRun> next();
  // Called once for each run of next() whose meshes are all made and whose sink has finished,
  // unless a mesh failed or the run was stopped. A failure ends the whole run.
  core::Result<void> finished(const BlockRun& run, const Totals& totals);

 private:
  BlockRanges todo_;
  const unsigned threads_;
  Ledger* const ledger_;
  More more_;
  std::mutex mutex_;
  std::uint64_t position_ = 0;
};

// Options of a run.
struct Options {
  unsigned threads = 1;         // 1 … kMaxThreads
  bool lowest_priority = true;  // scheduling priority of the threads
  // Makes the sink of a thread, in that thread. Empty: meshes are discarded.
  std::function<std::unique_ptr<BlockSink>()> make_sink;
  // Selects the blocks of the region and their order. Null: all of them, once.
  RunSource* source = nullptr;
  // Called in the calling thread every `progress_period_ms` with the number of finished blocks.
  std::function<void(std::uint64_t)> progress;
  unsigned progress_period_ms = 100;
  // Set it to true from any thread to stop after the blocks in progress. May be null.
  const std::atomic<bool>* stop = nullptr;
};

// The result of a run.
struct Report {
  Totals totals;
  unsigned threads = 0;    // threads that were started
  double seconds = 0;      // wall-clock time
  double cpu_seconds = 0;  // all threads together
  bool stopped = false;    // by Options::stop, before all blocks were done
  bool complete = false;   // not stopped, and no mesh failed
  // Triangles per second of CPU time; 0 if no time was measured.
  double triangles_per_second_per_core() const {
    return cpu_seconds > 0 ? static_cast<double>(totals.triangles) / cpu_seconds : 0;
  }
};

// Synthesises the blocks of `region` and returns when all threads have ended. If the system cannot
// start all threads, it continues with fewer and logs a warning. A mesh that fails is only counted.
// Fails with kInvalidArgument for a wrong region or number of threads, with kInternal if no thread
// can be started, and with the error of a sink. An exception outside of synthesis gives
// kSynthesisFailed, or kOutOfMemory if memory is exhausted.
core::Result<Report> amplify(const world::World& world, const models::Registry& registry,
                             const Region& region, const Options& options);

}  // namespace psygen::amplify
