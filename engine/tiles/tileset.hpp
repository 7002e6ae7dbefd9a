// Writes a region of a world as one 3D Tiles 1.1 tileset: tileset.json, subtrees/ and content/ with
// a .glb for each tile (OGC 22-025r4). Coordinates are metres from the tileset's north-west corner:
// +X east; up and north as in 3D Tiles (z up) and glTF (y up). Several threads.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "engine/models/registry.hpp"
#include "engine/tiles/tile_tree.hpp"
#include "engine/world/world.hpp"

namespace psygen::tiles {

// A place on Earth: WGS 84, the height in metres above the ellipsoid.
struct GeoPlace {
  double latitude_deg = 0;   // -90 … 90, north positive
  double longitude_deg = 0;  // -180 … 180, east positive
  double height_m = 0;       // -12000 … 1e6
};
// "LATITUDE,LONGITUDE" or "LATITUDE,LONGITUDE,HEIGHT". Fails with kInvalidArgument.
core::Result<GeoPlace> parse_geo_place(const std::string& text);

// Options for writing.
struct TilesetOptions {
  unsigned threads = 1;
  // Called in the calling thread with the finished fraction, 0 … 1.
  std::function<void(double)> progress;
  const std::atomic<bool>* stop = nullptr;  // true: stop after the tiles in progress
  // The place of the tileset's origin, whose axes then point east, north and up. None: the origin
  // is the Earth's centre.
  std::optional<GeoPlace> at_geo = {};
};

// The result of writing.
struct TilesetReport {
  std::uint64_t contents = 0;   // tiles with a file
  std::uint64_t triangles = 0;  // of all tiles, skirts included
  std::uint64_t bytes = 0;      // of all files
  std::uint64_t subtrees = 0;
};

// Writes the tileset. The folder is created; existing files are replaced, each as a whole, and
// tileset.json is written last. `registry` must have the world's species. Fails with kIo,
// kInterrupted and like TileMaker::document().
core::Result<TilesetReport> write_tileset(const world::World& world,
                                          const models::Registry& registry, const TileTree& tree,
                                          const std::filesystem::path& folder,
                                          const TilesetOptions& options);

}  // namespace psygen::tiles
