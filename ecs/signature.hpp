// A set of component types of one world: the columns of a table, or those that a query needs. Four
// words; at most 256 component types per world. A plain value; every operation is O(1).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace psygen::ecs::detail {

// The number of a component type in one world, in the order of registration.
using ComponentId = std::uint16_t;
inline constexpr std::size_t kMaxComponents = 256;
inline constexpr ComponentId kNoComponent = UINT16_MAX;

// Ids must be below kMaxComponents.
class Signature {
 public:
  // Adds an id to the set, or tests for it.
  void insert(ComponentId id) { words_[id / 64] |= bit(id); }
  bool contains(ComponentId id) const { return (words_[id / 64] & bit(id)) != 0; }
  // True if this set has every id of `other`.
  bool includes(const Signature& other) const {
    std::uint64_t missing = 0;
    for (std::size_t i = 0; i < words_.size(); ++i)
      missing |= other.words_[i] & ~words_[i];
    return missing == 0;
  }
  // True if the two sets share an id.
  bool intersects(const Signature& other) const {
    std::uint64_t shared = 0;
    for (std::size_t i = 0; i < words_.size(); ++i)
      shared |= other.words_[i] & words_[i];
    return shared != 0;
  }
  // Returns this set plus all of `added`, then minus all of `removed`.
  Signature changed(const Signature& added, const Signature& removed) const {
    Signature result;
    for (std::size_t i = 0; i < words_.size(); ++i) {
      result.words_[i] = (words_[i] | added.words_[i]) & ~removed.words_[i];
    }
    return result;
  }
  // Equal sets have equal hashes.
  std::uint64_t hash() const {
    std::uint64_t h = 0;
    for (const std::uint64_t word : words_) {
      h = (h ^ word) * 0x9E3779B97F4A7C15ull;
      h ^= h >> 32;
    }
    return h;
  }
  friend bool operator==(const Signature&, const Signature&) = default;

 private:
  static std::uint64_t bit(ComponentId id) { return std::uint64_t{1} << (id % 64); }
  std::array<std::uint64_t, kMaxComponents / 64> words_{};
};

}  // namespace psygen::ecs::detail
