#include "engine/core/value_cache.hpp"

#include <iterator>
#include <utility>

namespace psygen::core {

ValueCache::Value ValueCache::find(const Key& key) {
  Shard& s = shard(key);
  const std::lock_guard lock(s.mutex);
  const auto it = s.places.find(key);
  if (it == s.places.end()) return nullptr;
  s.entries.splice(s.entries.begin(), s.entries, it->second);
  return it->second->value;
}

ValueCache::Value ValueCache::publish(const Key& key, Value value, std::size_t bytes) {
  if (bytes > shard_bytes_) return value;
  std::list<Entry> dropped;  // freed after the lock
  Shard& s = shard(key);
  const std::lock_guard lock(s.mutex);
  if (const auto it = s.places.find(key); it != s.places.end()) return it->second->value;
  while (s.bytes + bytes > shard_bytes_) {
    const auto last = std::prev(s.entries.end());
    s.bytes -= last->bytes;
    s.places.erase(last->key);
    dropped.splice(dropped.begin(), s.entries, last);
  }
  s.entries.push_front({key, value, bytes});
  s.places.emplace(key, s.entries.begin());
  s.bytes += bytes;
  return value;
}

bool ValueCache::has(const Key& key) const {
  const Shard& s = shard(key);
  const std::lock_guard lock(s.mutex);
  return s.places.contains(key);
}

std::size_t ValueCache::bytes() const {
  std::size_t sum = 0;
  for (const Shard& s : shards_) {
    const std::lock_guard lock(s.mutex);
    sum += s.bytes;
  }
  return sum;
}

}  // namespace psygen::core
