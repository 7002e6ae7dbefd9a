// Keeps root tiles and patches of river networks, by bytes. Shards by key, each with a mutex that
// is never held while a value is made; the least recently used values go first. A store belongs to
// a scene or a tool, and its bytes lie outside the geometry budget. Any thread.
#pragma once

#include <array>
#include <list>
#include <mutex>
#include <unordered_map>

#include "engine/models/ground/network/store.hpp"

namespace psygen::synthesis {

class NetworkCache final : public models::NetworkStore {
 public:
  // Root tiles take 2 KiB each, patches about 100 KiB. Each of eight shards keeps an eighth of the
  // bytes; 0 keeps nothing.
  explicit NetworkCache(std::size_t bytes = std::size_t{56} << 20)
      : shard_bytes_(bytes / kShards) {}

  Value find(const Key& key) override;
  Value publish(const Key& key, Value value, std::size_t bytes) override;
  bool has(const Key& key) const override;
  // Bytes of all values kept.
  std::size_t bytes() const;

 private:
  static constexpr std::size_t kShards = 8;
  struct Entry {
    Key key;
    Value value;
    std::size_t bytes = 0;
  };
  struct Hash {
    std::size_t operator()(const Key& key) const { return key.hash(); }
  };
  struct Shard {
    mutable std::mutex mutex;
    std::list<Entry> entries;  // the most recently used first
    std::unordered_map<Key, std::list<Entry>::iterator, Hash> places;
    std::size_t bytes = 0;
  };

  Shard& shard(const Key& key) { return shards_[(key.hash() >> 7) % kShards]; }
  const Shard& shard(const Key& key) const { return shards_[(key.hash() >> 7) % kShards]; }

  std::size_t shard_bytes_;
  std::array<Shard, kShards> shards_;
};

}  // namespace psygen::synthesis
