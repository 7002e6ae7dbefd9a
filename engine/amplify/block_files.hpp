// A folder with one file per block: glTF or OBJ with all its meshes at one level of detail. A run
// can be continued: existing files are not written again unless they are truncated, and
// half-written files of a killed process are removed. A block with a failed mesh gets no file. The
// folder also has the world file and a hash of some sample blocks. They prevent mixing blocks of
// two worlds, and, as far as the sample shows, blocks of one world from two versions of the engine.
// Sinks are per thread; the folder may be shared.
#pragma once

#include <atomic>
#include <filesystem>

#include "engine/amplify/amplify.hpp"
#include "engine/exchange/write_document.hpp"

namespace psygen::amplify {

// All meshes of a block at a level of detail, and then the surface of its water, as a document, in
// metres from the block's corner.
// Fails with the error of the first mesh that fails.
core::Result<exchange::Document> block_document(const world::World& world,
                                                const models::Registry& registry,
                                                core::BlockCoord block, int level);

// True if a folder has the whole file of a block, as BlockFolder writes it.
bool has_block_file(const std::filesystem::path& folder, core::BlockCoord block,
                    exchange::Format format);

// Removes half-written files that killed processes, on any host, have left for these blocks. Only
// for a caller that is the sole writer of these blocks.
void remove_partial_blocks(const std::filesystem::path& folder,
                           const std::function<bool(core::BlockCoord)>& is_ours);

// The folder of one run.
class BlockFolder {
 public:
  // Creates the folder if needed. `world` and `registry` must outlive it. Fails with kIo if the
  // folder cannot be written. Fails with kInvalidArgument if it has blocks of another world or of
  // other files that the world names, blocks that this version of the engine and these model types
  // would make differently, or blocks of unknown origin.
  static core::Result<std::unique_ptr<BlockFolder>> open(std::filesystem::path folder,
                                                         const world::World& world,
                                                         const models::Registry& registry,
                                                         exchange::Format format);

  // A sink for one thread, which the folder must outlive. Any thread.
  std::unique_ptr<BlockSink> make_sink();
  // The file of a block: "block_X_Z.glb" in the folder.
  std::filesystem::path file_of(core::BlockCoord block) const;
  // True if that file exists and is whole. Any thread.
  bool has(core::BlockCoord block) const;
  // Blocks written, and blocks skipped because their file exists; any thread.
  std::uint64_t written() const { return written_.load(std::memory_order_relaxed); }
  std::uint64_t skipped() const { return skipped_.load(std::memory_order_relaxed); }

 private:
  class Sink;
  BlockFolder(std::filesystem::path folder, const world::World& world,
              const models::Registry& registry, exchange::Format format);
  core::Result<void> claim() const;
  core::Result<void> claim(const char* file, const std::string& text, const char* others) const;
  bool has_blocks() const;

  std::filesystem::path folder_;
  const world::World& world_;
  const models::Registry& registry_;
  exchange::Format format_;
  std::atomic<std::uint64_t> written_{0}, skipped_{0};
};

}  // namespace psygen::amplify
