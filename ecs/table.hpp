// All entities with the same set of components: one contiguous column per component and one of
// handles, each at an address that never changes. Rows [0, rows()) are filled without holes; their
// order has no meaning. Untyped: the world above knows the component types. Not a map: EntitySlots
// finds entities. Only the world's thread changes it.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ecs/component.hpp"
#include "ecs/entity.hpp"
#include "ecs/reserved_memory.hpp"
#include "ecs/row_directory.hpp"

namespace psygen::ecs::detail {

// The number of a component type in one world, in the order of registration.
using ComponentId = std::uint16_t;
inline constexpr std::size_t kMaxComponents = 256;
inline constexpr ComponentId kNoComponent = UINT16_MAX;

// A set of component types of one world: the columns of a table, or those that a query needs. Four
// words; ids are below kMaxComponents. A plain value; every operation is O(1).
class Signature {
 public:
  // Adds an id to the set, or tests for it.
  void insert(ComponentId id) { ids_[id] = true; }
  bool contains(ComponentId id) const { return ids_[id]; }
  // True if this set has every id of `other`; true if the two sets share an id.
  bool includes(const Signature& other) const { return (other.ids_ & ~ids_).none(); }
  bool intersects(const Signature& other) const { return (other.ids_ & ids_).any(); }
  // Returns this set plus all of `added`, then minus all of `removed`.
  Signature changed(const Signature& added, const Signature& removed) const {
    Signature result;
    result.ids_ = (ids_ | added.ids_) & ~removed.ids_;
    return result;
  }
  friend bool operator==(const Signature&, const Signature&) = default;
  // For unordered containers.
  struct Hash {
    std::size_t operator()(const Signature& set) const { return std::hash<Ids>{}(set.ids_); }
  };

 private:
  using Ids = std::bitset<kMaxComponents>;
  Ids ids_;
};

// One component's values: row i is at memory.data() + i * info->size_bytes.
struct Column {
  const ComponentInfo* info = nullptr;
  ComponentId id = kNoComponent;
  ReservedMemory memory;
};

// Its functions are steps of Storage's verbs, which call them in order. The table owns columns and
// handles; the caller updates slots and change bits.
class Table {
 public:
  // `columns` match `signature`, each with address space for `max_rows` rows. Throws std::bad_alloc
  // if there is no address space for the handles.
  Table(std::uint32_t id, const Signature& signature, std::vector<Column> columns,
        std::size_t max_rows);
  // Destroys the objects of all rows.
  ~Table();
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  // The table's number in the world (0 for a sparse set), its components, its number of filled
  // rows.
  std::uint32_t id() const { return id_; }
  const Signature& signature() const { return signature_; }
  std::uint32_t rows() const { return rows_; }
  // The handles of rows [0, rows()). The address never changes.
  Entity* entities() const { return reinterpret_cast<Entity*>(entities_.data()); }
  // One column per component of the signature. Valid as long as the table.
  std::span<Column> columns() { return columns_; }
  std::span<const Column> columns() const { return columns_; }
  // Row 0 of a component's column; null if the table lacks it. `id` is below kMaxComponents.
  std::byte* column_data(ComponentId id) const {
    const std::uint16_t at = column_of_[id];
    return at == kNoColumn ? nullptr : columns_[at].memory.data();
  }

  // Returns the location of a row that is filled or was named by name_rows.
  std::uint32_t location(std::uint32_t row) const {
    return chunks_[row / kChunkRows] + row % kChunkRows;
  }

  // The most rows that this table may have.
  std::size_t max_rows() const { return max_rows_; }

  // Commits memory for `count` more rows, without objects in them. Throws std::bad_alloc if memory
  // ends; ends the program beyond max_rows(). Amortised O(1) system calls.
  void reserve_more(std::size_t count);
  // Gives locations to rows up to rows() + count.
  void name_rows(std::size_t count, RowDirectory& directory);
  // Builds rows [rows(), rows() + count) of the columns that are not in `except`. If a constructor
  // throws, everything built here is destroyed again.
  void construct_new_rows(std::size_t count, const Signature& except);
  // Declares the `count` rows after the last one filled; returns the first of them.
  std::uint32_t add_rows(std::size_t count);

  // Destroys the objects of these rows in the columns of `which`.
  void destroy_rows(std::span<const std::uint32_t> leaving, const Signature& which);
  // Fills the holes of `leaving` (distinct rows without objects) with rows from the end of the
  // table, which becomes shorter. `moves` receives the moves. Moves columns and handles; the caller
  // updates everything else. O(leaving).
  void close_holes(std::span<const std::uint32_t> leaving, std::vector<RowMove>& moves);

  // Committed bytes of handles and columns.
  std::size_t committed_bytes() const;

  // Rows that the current batch verb removes; empty between verbs.
  std::vector<std::uint32_t> leaving;

 private:
  static constexpr std::uint16_t kNoColumn = UINT16_MAX;
  void plan_moves(std::span<const std::uint32_t> leaving_rows, std::vector<RowMove>& moves);

  std::uint32_t id_;
  std::uint32_t rows_ = 0;
  std::uint32_t used_rows_ = 0;  // rows from here on were never written: their memory is zero
  std::size_t capacity_ = 0;
  std::size_t max_rows_;
  Signature signature_;
  std::vector<Column> columns_;
  ReservedMemory entities_;
  std::vector<std::uint32_t> chunks_;  // the location of every 4096th row
  std::vector<std::uint64_t> dead_;    // scratch: bits of the last rows that are leaving
  std::array<std::uint16_t, kMaxComponents> column_of_;
};

}  // namespace psygen::ecs::detail
