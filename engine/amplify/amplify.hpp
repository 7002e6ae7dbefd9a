// Data amplification without a camera: synthesises all blocks of a region at full detail over
// several threads, throws the meshes away or hands them to a sink, and names what was made by one
// hash. The hash does not depend on the number of threads or on their order. Threads share an
// atomic number of the next block and nothing else.
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>

#include "engine/amplify/block_synthesizer.hpp"
#include "engine/amplify/region.hpp"

namespace psygen::amplify {

inline constexpr unsigned kMaxThreads = 256;
// One for each processor, as far as allowed; 0 processors: it is not known how many there are.
constexpr unsigned threads_for(unsigned processors) {
  return std::clamp(processors, 1u, kMaxThreads);
}

// What takes the meshes. Each thread has one of its own.
class BlockSink {
 public:
  virtual ~BlockSink() = default;
  virtual void add(core::BlockCoord block, const BlockMesh& mesh) = 0;  // terrain first
  // All meshes of the block have been added. A failure ends everything.
  virtual core::Result<void> finish(core::BlockCoord block) = 0;
  // Instead of finish(), where a mesh of the block failed: what was added is to be forgotten.
  virtual void drop(core::BlockCoord block) = 0;
  // Whether the block's meshes are wanted; called first.
  virtual bool wants(core::BlockCoord block) = 0;
};

struct Options {
  unsigned threads = 1;  // 1 … kMaxThreads
  bool lowest_priority = true;
  // Makes the sink of a thread; empty: the meshes are discarded.
  std::function<std::unique_ptr<BlockSink>()> make_sink;
  // Told in the calling thread, ten times a second, how many blocks are done.
  std::function<void(std::uint64_t)> progress;
  // Set from anywhere to end after the blocks that are being made.
  const std::atomic<bool>* stop = nullptr;
};

struct Report {
  Totals totals;
  unsigned threads = 0;    // that could be started
  double seconds = 0;      // wall-clock time
  double cpu_seconds = 0;  // of all threads together
  std::uint64_t region_blocks = 0;
  bool complete = false;  // every mesh of every block of the region was made
  double triangles_per_second_per_core() const {
    return cpu_seconds > 0 ? static_cast<double>(totals.triangles) / cpu_seconds : 0;
  }
};

// Goes on with fewer threads where the system gives no more, and warns of it. Fails with
// kInvalidArgument for a region or a number of threads that is not allowed, with kInternal where
// there is not one thread, and with what a sink failed with. A mesh that fails is counted; an
// exception from anywhere else is kSynthesisFailed, or kOutOfMemory where memory ended.
core::Result<Report> amplify(const world::World& world, const models::Registry& registry,
                             const Region& region, const Options& options);

}  // namespace psygen::amplify
