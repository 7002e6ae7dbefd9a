// All entities with the same set of components: one contiguous column per component and one of
// handles, each at an address that never changes. Rows [0, rows()) are filled without holes; their
// order is not meaningful. Untyped: the world above knows the component types.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ecs/component.hpp"
#include "ecs/entity.hpp"
#include "ecs/reserved_memory.hpp"
#include "ecs/row_directory.hpp"
#include "ecs/signature.hpp"

namespace psygen::ecs::detail {

struct Column {
  const ComponentInfo* info = nullptr;
  ComponentId id = kNoComponent;
  ReservedMemory memory;
};

class Table {
 public:
  Table(std::uint32_t id, const Signature& signature, std::vector<Column> columns,
        std::size_t max_rows);
  ~Table();
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  std::uint32_t id() const { return id_; }
  const Signature& signature() const { return signature_; }
  std::uint32_t rows() const { return rows_; }
  Entity* entities() const { return reinterpret_cast<Entity*>(entities_.data()); }
  std::span<Column> columns() { return columns_; }
  std::span<const Column> columns() const { return columns_; }
  // The column of a component, null where the table has none.
  std::byte* column_data(ComponentId id) const {
    const std::uint16_t at = column_of_[id];
    return at == kNoColumn ? nullptr : columns_[at].memory.data();
  }

  // The name of a row, filled or to be filled within the last name_rows.
  std::uint32_t location(std::uint32_t row) const {
    return chunks_[row / kChunkRows] + row % kChunkRows;
  }

  std::size_t max_rows() const { return max_rows_; }

  // Makes room for `count` more rows, without objects in them.
  void reserve_more(std::size_t count);
  // Names rows up to rows() + count.
  void name_rows(std::size_t count, RowDirectory& directory);
  // Builds rows [rows(), rows() + count) of the columns that are not in `except`. When a
  // constructor throws, everything built here is destroyed again.
  void construct_new_rows(std::size_t count, const Signature& except);
  // The `count` rows after the last one count as filled from now on; returns the first of them.
  std::uint32_t add_rows(std::size_t count);

  // Ends the objects in these rows, in the columns of `which`.
  void destroy_rows(std::span<const std::uint32_t> leaving, const Signature& which);
  // Closes the holes that `leaving` (distinct rows, holding no objects any more) make: rows from
  // the end of the table fill them and the table gets shorter. `moves` receives what went where;
  // columns and handles are moved here, everything else is the caller's.
  void close_holes(std::span<const std::uint32_t> leaving, std::vector<RowMove>& moves);

  std::size_t committed_bytes() const;

  // Rows that a batch verb in progress takes away; empty between verbs.
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
  std::vector<std::uint32_t> chunks_;  // location of every 4096th row
  std::vector<std::uint64_t> dead_;    // scratch: which of the last rows are leaving
  std::array<std::uint16_t, kMaxComponents> column_of_;
};

}  // namespace psygen::ecs::detail
