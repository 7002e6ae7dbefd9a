// Keeps root tiles and patches of river networks, by bytes (core/value_cache.hpp). A value is a
// function of its key, so a store changes no bit of any answer, whatever it drops. Any thread.
#pragma once

#include <cstddef>
#include <memory>

#include "engine/core/value_cache.hpp"
#include "engine/models/network/patch.hpp"
#include "engine/models/network/root.hpp"

namespace psygen::models {

class NetworkStore {
 public:
  // Names a value: the identity of the network, and the tile. Root tiles have level −1, nodes of
  // level k have −2 − k.
  struct Key {
    std::uint64_t network = 0;
    network::TileKey tile;
  };

  // Root tiles take 2 KiB each, patches about 115 KiB, nodes 400 KiB; 0 bytes keep nothing.
  explicit NetworkStore(std::size_t bytes = std::size_t{56} << 20) : cache_(bytes) {}

  // True if a value is kept. It may be dropped at once.
  bool has(const Key& key) const { return cache_.has(packed(key)); }
  // Bytes of all values kept.
  std::size_t bytes() const { return cache_.bytes(); }
  // Returns the value of a key, found or made. V is network::RootTile, Patch or NodePatch.
  template <class V, class Make>
  std::shared_ptr<const V> get(const Key& key, const Make& make) {
    return cache_.get<V>(packed(key), make);
  }

 private:
  static core::ValueCache::Key packed(const Key& key) {
    return {key.network, static_cast<std::uint64_t>(key.tile.level),
            static_cast<std::uint64_t>(key.tile.i), static_cast<std::uint64_t>(key.tile.j)};
  }

  core::ValueCache cache_;
};

}  // namespace psygen::models
