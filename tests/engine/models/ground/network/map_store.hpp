// A store that drops nothing, for one thread.
#pragma once

#include <unordered_map>

#include "engine/models/ground/network/store.hpp"

namespace psygen::models::test {

class MapStore final : public NetworkStore {
 public:
  Value find(const Key& key) override {
    const auto it = values_.find(key);
    return it == values_.end() ? nullptr : it->second;
  }
  Value publish(const Key& key, Value value, std::size_t) override {
    return values_.emplace(key, std::move(value)).first->second;
  }
  bool has(const Key& key) const override { return values_.contains(key); }

 private:
  struct Hash {
    std::size_t operator()(const Key& key) const { return key.hash(); }
  };
  std::unordered_map<Key, Value, Hash> values_;
};

}  // namespace psygen::models::test
