// Data amplification without a camera: synthesises all blocks of a region at full detail on several
// threads. Meshes are discarded or passed to a sink, and one hash identifies all of them. The hash
// does not depend on the number of threads or on their order. Threads share only the source of the
// next blocks, by default an atomic counter. It draws nothing.
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
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

// Hands out the blocks of a region to the threads of a run, which make all calls, several at once.
class RunSource {
 public:
  virtual ~RunSource() = default;
  // The next blocks for the calling thread, or nothing at the end. A failure ends the whole run.
  virtual core::Result<std::optional<BlockRun>> next() = 0;
  // Called once for each run of next() whose meshes are all made and whose sink has finished,
  // unless a mesh failed or the run was stopped. A failure ends the whole run.
  virtual core::Result<void> finished(const BlockRun& run, const Totals& totals) = 0;
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
