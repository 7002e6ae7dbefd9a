// Keeps values of any type by bytes, for many threads. A value must be a function of its key, so
// the cache changes no answer, whatever it drops. Nobody waits for a value: a thread that misses
// makes it, and the first to publish wins. Shards by key, each with a mutex that is never held
// while a value is made; the least recently used values go first. Any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <utility>

#include "engine/core/hash.hpp"

namespace psygen::core {

class ValueCache {
 public:
  using Key = std::array<std::uint64_t, 4>;
  using Value = std::shared_ptr<const void>;

  // Each of eight shards keeps an eighth of the bytes; 0 keeps nothing.
  explicit ValueCache(std::size_t bytes) : shard_bytes_(bytes / kShards) {}
  ValueCache(const ValueCache&) = delete;
  ValueCache& operator=(const ValueCache&) = delete;

  // Returns a value, or null.
  Value find(const Key& key);
  // Keeps a value of this size, unless it is too large; returns the value that another thread
  // published first, or this one.
  Value publish(const Key& key, Value value, std::size_t bytes);
  // True if a value is kept. It may be dropped at once.
  bool has(const Key& key) const;
  // Bytes of all values kept.
  std::size_t bytes() const;

  // Returns the value of a key, found or made. V has bytes().
  template <class V, class Make>
  std::shared_ptr<const V> get(const Key& key, const Make& make) {
    if (Value found = find(key)) return std::static_pointer_cast<const V>(std::move(found));
    auto made = std::make_shared<const V>(make());
    const std::size_t bytes = made->bytes();
    return std::static_pointer_cast<const V>(publish(key, std::move(made), bytes));
  }

 private:
  static constexpr std::size_t kShards = 8;
  struct Entry {
    Key key;
    Value value;
    std::size_t bytes = 0;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const {
      return combine(combine(combine(key[0], key[1]), key[2]), key[3]);
    }
  };
  struct Shard {
    mutable std::mutex mutex;
    std::list<Entry> entries;  // the most recently used first
    std::unordered_map<Key, std::list<Entry>::iterator, Hash> places;
    std::size_t bytes = 0;
  };

  Shard& shard(const Key& key) { return shards_[(Hash{}(key) >> 7) % kShards]; }
  const Shard& shard(const Key& key) const { return shards_[(Hash{}(key) >> 7) % kShards]; }

  std::size_t shard_bytes_;
  std::array<Shard, kShards> shards_;
};

}  // namespace psygen::core
