// A sparse map from squares of the quadtree to values, as an immutable tree: copies are O(1), and
// changing a copy does not change the others. Every square stores the hash and the summary of its
// whole content, so large areas are compared and counted without a visit to their values. The shape
// of the tree and its hashes depend on values and positions alone, not on the order of changes.
// Squares without values are omitted: the tree has less than two nodes a value, and a path at most
// 33. Any thread may read a map that no thread changes; different copies may be used at the same
//     time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "engine/core/coordinates.hpp"
#include "engine/core/hash.hpp"

namespace psygen::models {

// A square of 2^level × 2^level blocks, in squares of its level counted from block −2^31.
struct QuadCoord {
  static constexpr std::uint32_t kMaxLevel = 32;
  std::uint32_t level = 0;
  std::uint64_t x = 0, z = 0;

  // Returns the square of `level` < kMaxLevel, counted in squares of that level from block 0. Wraps
  // like blocks do.
  static constexpr QuadCoord of(core::BlockCoord at, std::uint32_t level = 0) {
    const auto from_origin = [level](std::int32_t index) {
      const std::uint32_t block = static_cast<std::uint32_t>(index) << level;
      return std::uint64_t{block ^ 0x80000000U} >> level;
    };
    return {level, from_origin(at.x), from_origin(at.z)};
  }
  // The block at the square's corner.
  constexpr core::BlockCoord corner() const {
    const auto block = [this](std::uint64_t index) {
      return static_cast<std::int32_t>(static_cast<std::uint32_t>(index << level) ^ 0x80000000U);
    };
    return {block(x), block(z)};
  }
  // True if `other` is this square or inside it.
  constexpr bool covers(const QuadCoord& other) const {
    return other.level <= level && other.x >> (level - other.level) == x &&
           other.z >> (level - other.level) == z;
  }
  // The quarter of this square that contains the smaller square `other`: x in bit 0, z in bit 1.
  constexpr std::size_t quarter_of(const QuadCoord& other) const {
    const std::uint32_t down = level - 1 - other.level;
    return static_cast<std::size_t>(((other.x >> down) & 1) | (((other.z >> down) & 1) << 1));
  }
  constexpr QuadCoord quarter(std::size_t q) const {
    return {level - 1, 2 * x + (q & 1), 2 * z + (q >> 1)};
  }
  constexpr QuadCoord parent() const { return {level + 1, x >> 1, z >> 1}; }
  friend bool operator==(const QuadCoord&, const QuadCoord&) = default;
};

// V has bool empty() const, std::uint64_t hash() const (not 0 unless empty), and a type Summary,
// which by default has no content, with add(const Summary&); V::summary() returns the value's own.
template <class V>
class QuadMap {
 public:
  using Summary = typename V::Summary;

  // A square that has a value or at least two quarters that are not empty.
  struct Cell {
    QuadCoord place;
    std::shared_ptr<const V> value;  // null: none
    std::array<std::shared_ptr<const Cell>, 4> quarters;
    std::uint64_t hash = 0;  // of all values in the square, and of their positions; never 0
    Summary summary;         // of all values in the square
  };

  bool empty() const { return root_ == nullptr; }
  // The smallest square around all values, or null.
  const Cell* root() const { return root_.get(); }

  // Returns the value of a square; null if it has none. O(path).
  const V* find(const QuadCoord& place) const {
    const Cell* cell = at_or_below(place);
    return cell != nullptr && cell->place == place ? cell->value.get() : nullptr;
  }
  // Returns the largest cell in the square, with the hash and summary of its content; null if the
  // square is empty.
  const Cell* at_or_below(const QuadCoord& place) const {
    const Cell* cell = root_.get();
    while (cell != nullptr && !place.covers(cell->place)) {
      if (!cell->place.covers(place)) return nullptr;
      cell = cell->quarters[cell->place.quarter_of(place)].get();
    }
    return cell;
  }

  // Sets the value of a square; an empty value removes it. O(path).
  void set(const QuadCoord& place, V value) {
    root_ =
        with(root_, place, value.empty() ? nullptr : std::make_shared<const V>(std::move(value)));
  }

  // Calls visit(place, before, after) for each square whose value is not the same object in both
  // maps; null for no value. O(differences · path).
  template <class Visit>
  static void each_difference(const QuadMap& before, const QuadMap& after, const Visit& visit) {
    difference(before.root_.get(), after.root_.get(), visit);
  }

 private:
  using CellPtr = std::shared_ptr<const Cell>;
  using ValuePtr = std::shared_ptr<const V>;

  static CellPtr make(const QuadCoord& place, ValuePtr value, std::array<CellPtr, 4> quarters) {
    auto cell = std::make_shared<Cell>();
    // The hash includes the position, because equal values at other positions must differ.
    std::uint64_t hash = core::combine(core::combine(core::mix64(place.level), place.x), place.z);
    if (value) {
      hash = core::combine(hash, value->hash());
      cell->summary = value->summary();
    }
    for (const CellPtr& quarter : quarters) {
      if (!quarter) continue;
      hash = core::combine(hash, quarter->hash);
      cell->summary.add(quarter->summary);
    }
    cell->place = place;
    cell->value = std::move(value);
    cell->quarters = std::move(quarters);
    cell->hash = hash == 0 ? 1 : hash;
    return cell;
  }

  // Makes a cell, or returns the only quarter if the cell is not needed.
  static CellPtr tidy(const QuadCoord& place, ValuePtr value, std::array<CellPtr, 4> quarters) {
    if (value) return make(place, std::move(value), std::move(quarters));
    const CellPtr* only = nullptr;
    std::size_t count = 0;
    for (const CellPtr& quarter : quarters) {
      if (!quarter) continue;
      only = &quarter;
      ++count;
    }
    if (count == 0) return nullptr;
    return count == 1 ? *only : make(place, nullptr, std::move(quarters));
  }

  static CellPtr with(const CellPtr& cell, const QuadCoord& target, ValuePtr value) {
    if (!cell) return value ? make(target, std::move(value), {}) : nullptr;
    if (cell->place == target) return tidy(target, std::move(value), cell->quarters);
    if (cell->place.covers(target)) {
      const std::size_t q = cell->place.quarter_of(target);
      CellPtr quarter = with(cell->quarters[q], target, std::move(value));
      if (quarter == cell->quarters[q]) return cell;
      std::array<CellPtr, 4> quarters = cell->quarters;
      quarters[q] = std::move(quarter);
      return tidy(cell->place, cell->value, std::move(quarters));
    }
    if (!value) return cell;
    if (target.covers(cell->place)) {
      std::array<CellPtr, 4> quarters;
      quarters[target.quarter_of(cell->place)] = cell;
      return make(target, std::move(value), std::move(quarters));
    }
    QuadCoord both = cell->place.parent();
    while (!both.covers(target))
      both = both.parent();
    std::array<CellPtr, 4> quarters;
    quarters[both.quarter_of(cell->place)] = cell;
    quarters[both.quarter_of(target)] = make(target, std::move(value), {});
    return make(both, nullptr, std::move(quarters));
  }

  template <class Visit>
  static void each_in(const Cell* cell, const Visit& visit) {
    if (cell == nullptr) return;
    if (cell->value) visit(cell->place, *cell->value);
    for (const CellPtr& quarter : cell->quarters)
      each_in(quarter.get(), visit);
  }

  template <class Visit>
  static void difference(const Cell* before, const Cell* after, const Visit& visit) {
    if (before == after) return;
    if (before == nullptr || after == nullptr ||
        (!before->place.covers(after->place) && !after->place.covers(before->place))) {
      each_in(before, [&](const QuadCoord& at, const V& v) { visit(at, &v, nullptr); });
      each_in(after, [&](const QuadCoord& at, const V& v) { visit(at, nullptr, &v); });
      return;
    }
    if (before->place == after->place) {
      if (before->value != after->value)
        visit(before->place, before->value.get(), after->value.get());
      for (std::size_t q = 0; q < 4; ++q)
        difference(before->quarters[q].get(), after->quarters[q].get(), visit);
      return;
    }
    // The larger one has the smaller one in one of its quarters.
    const bool grown = after->place.covers(before->place);
    const Cell* large = grown ? after : before;
    const Cell* small = grown ? before : after;
    if (large->value)
      visit(large->place, grown ? nullptr : large->value.get(),
            grown ? large->value.get() : nullptr);
    for (std::size_t q = 0; q < 4; ++q) {
      const Cell* part = large->place.quarter_of(small->place) == q ? small : nullptr;
      const Cell* quarter = large->quarters[q].get();
      grown ? difference(part, quarter, visit) : difference(quarter, part, visit);
    }
  }

  CellPtr root_;
};

}  // namespace psygen::models
