// Where river networks look for root tiles and patches before they make them. A value is a function
// of its key, so a store changes no bit of any answer, whatever it drops. Nobody waits for a value:
// a thread that misses makes it, and the first to publish wins. synthesis/network_store.hpp
// implements it, because models know no threads. Any thread.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "engine/models/ground/network/patch.hpp"
#include "engine/models/ground/network/root.hpp"

namespace psygen::models {

class NetworkStore {
 public:
  // Names a value: the identity of the network, and the tile. Root tiles have level −1.
  struct Key {
    std::uint64_t network = 0;
    network::TileKey tile;
    friend bool operator==(const Key&, const Key&) = default;
    std::uint64_t hash() const { return core::combine(network, network::TileKeyHash{}(tile)); }
  };
  using Value = std::shared_ptr<const void>;

  virtual ~NetworkStore() = default;
  NetworkStore() = default;
  NetworkStore(const NetworkStore&) = delete;
  NetworkStore& operator=(const NetworkStore&) = delete;

  // Returns a value, or null.
  virtual Value find(const Key& key) = 0;
  // Keeps a value of this size, or not; returns the value that another thread published first, or
  // this one.
  virtual Value publish(const Key& key, Value value, std::size_t bytes) = 0;
  // True if a value is kept. It may be dropped at once.
  virtual bool has(const Key& key) const = 0;

  // Returns the value of a key, found or made. V is network::RootTile or network::Patch.
  template <class V, class Make>
  std::shared_ptr<const V> get(const Key& key, const Make& make) {
    if (Value found = find(key)) return std::static_pointer_cast<const V>(std::move(found));
    auto made = std::make_shared<const V>(make());
    const std::size_t bytes = made->bytes();
    return std::static_pointer_cast<const V>(publish(key, std::move(made), bytes));
  }
};

}  // namespace psygen::models
