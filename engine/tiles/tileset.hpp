// Writes a region of a world as one 3D Tiles 1.1 tileset: tileset.json, subtrees/ and content/ with
// a .glb for each tile (OGC 22-025r4). Coordinates are metres from the tileset's north-west corner:
// +X east, and up and north as 3D Tiles have them (z up) and glTF has them (y up). Several threads.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>

#include "engine/models/registry.hpp"
#include "engine/tiles/tile_tree.hpp"
#include "engine/world/world.hpp"

namespace psygen::tiles {

// How to write.
struct TilesetOptions {
  unsigned threads = 1;
  // Called in the calling thread with the share that is done, 0 … 1.
  std::function<void(double)> progress;
  const std::atomic<bool>* stop = nullptr;  // ends it after the tiles in hand
};

// What was written.
struct TilesetReport {
  std::uint64_t contents = 0;   // tiles with a file
  std::uint64_t triangles = 0;  // of all of them, skirts included
  std::uint64_t bytes = 0;      // of their files
  std::uint64_t subtrees = 0;
};

// The folder is created; files that are there are replaced, each as a whole, and tileset.json is
// written last. The world's species must be in `registry`. Fails with kIo, kInterrupted and like
// TileMaker::document().
core::Result<TilesetReport> write_tileset(const world::World& world,
                                          const models::Registry& registry, const TileTree& tree,
                                          const std::filesystem::path& folder,
                                          const TilesetOptions& options);

}  // namespace psygen::tiles
