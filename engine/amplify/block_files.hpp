// A folder with one file per block: glTF or OBJ with everything on it at one level of detail. Can
// be gone on with: what is there already is not written again unless it has lost its end, what a
// killed process left half-done is removed, a block with a mesh that failed gets no file. The
// folder also holds the world's own file and the hash of a sample of its blocks as they are
// written, so that blocks of two worlds never mix, nor, as far as that sample shows, those of one
// world made by two versions of the engine.
#pragma once

#include <atomic>
#include <filesystem>

#include "engine/amplify/amplify.hpp"
#include "engine/exchange/write_document.hpp"

namespace psygen::amplify {

// All meshes of a block as a document, in metres from the block's corner. Fails where a model did.
core::Result<exchange::Document> block_document(const world::World& world,
                                                const models::Registry& registry,
                                                core::BlockCoord block, int level);

class BlockFolder {
 public:
  // World and registry outlive it. Creates the folder. Fails with kIo where it cannot be written,
  // with kInvalidArgument where it holds the blocks of another world, such as this version of the
  // engine and these model types would make otherwise, or such of which neither is known.
  static core::Result<std::unique_ptr<BlockFolder>> open(std::filesystem::path folder,
                                                         const world::World& world,
                                                         const models::Registry& registry,
                                                         exchange::Format format);

  // A sink for one thread; the folder outlives it.
  std::unique_ptr<BlockSink> make_sink();
  // "block_X_Z.glb" in the folder.
  std::filesystem::path file_of(core::BlockCoord block) const;
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
