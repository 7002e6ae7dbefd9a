// MeshKey → slot, by open addressing with linear probing and backward-shift deletion. Holds hashes
// and slots only; the keys themselves stay in the cache's records, which the caller compares.
// Expected O(1); grows by doubling at 60 % load. Main thread only.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/synthesis/mesh_key.hpp"

namespace psygen::synthesis {

// Empty at first.
class KeyIndex {
 public:
  KeyIndex() : entries_(64) {}
  // Number of keys.
  std::size_t size() const { return size_; }

  // The slot with this hash for which same_key(slot) holds, or kNoSlot.
  template <class SameKey>
  Slot find(std::uint64_t hash, SameKey&& same_key) const {
    for (std::size_t i = hash & mask();; i = (i + 1) & mask()) {
      const Entry& e = entries_[i];
      if (e.slot == kNoSlot) return kNoSlot;
      if (e.hash == hash && same_key(e.slot)) return e.slot;
    }
  }

  // Requires that the key is absent.
  void insert(std::uint64_t hash, Slot slot) {
    if ((size_ + 1) * 5 > entries_.size() * 3) grow();
    place({hash, slot});
    ++size_;
  }

  // Requires that (hash, slot) is present.
  void erase(std::uint64_t hash, Slot slot) {
    std::size_t hole = hash & mask();
    while (entries_[hole].slot != slot || entries_[hole].hash != hash)
      hole = (hole + 1) & mask();
    for (std::size_t i = (hole + 1) & mask(); entries_[i].slot != kNoSlot; i = (i + 1) & mask()) {
      const std::size_t home = entries_[i].hash & mask();
      if (((i - home) & mask()) >= ((i - hole) & mask())) {
        entries_[hole] = entries_[i];
        hole = i;
      }
    }
    entries_[hole] = {};
    --size_;
  }

 private:
  struct Entry {
    std::uint64_t hash = 0;
    Slot slot = kNoSlot;
  };
  std::size_t mask() const { return entries_.size() - 1; }
  void place(Entry entry) {
    std::size_t i = entry.hash & mask();
    while (entries_[i].slot != kNoSlot)
      i = (i + 1) & mask();
    entries_[i] = entry;
  }
  void grow() {
    std::vector<Entry> old = std::exchange(entries_, std::vector<Entry>(entries_.size() * 2));
    for (const Entry& e : old) {
      if (e.slot != kNoSlot) place(e);
    }
  }

  std::vector<Entry> entries_;
  std::size_t size_ = 0;
};

}  // namespace psygen::synthesis
