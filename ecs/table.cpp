#include "ecs/table.hpp"

#include <algorithm>
#include <utility>

#include "ecs/check.hpp"

namespace psygen::ecs::detail {
namespace {

constexpr std::size_t kFirstRows = 64;

}  // namespace

Table::Table(std::uint32_t id, const Signature& signature, std::vector<Column> columns,
             std::size_t max_rows)
    : id_(id),
      max_rows_(std::min<std::size_t>(max_rows, UINT32_MAX - 1)),
      signature_(signature),
      columns_(std::move(columns)),
      entities_(max_rows * sizeof(Entity)) {
  column_of_.fill(kNoColumn);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    column_of_[columns_[i].id] = static_cast<std::uint16_t>(i);
  }
}

Table::~Table() {
  for (const Column& column : columns_) {
    if (column.info->destroy_range != nullptr) {
      column.info->destroy_range(column.memory.data(), 0, rows_);
    }
  }
}

void Table::name_rows(std::size_t count, RowDirectory& directory) {
  while (chunks_.size() * kChunkRows < rows_ + count) {
    const auto first_row = static_cast<std::uint32_t>(chunks_.size() * kChunkRows);
    chunks_.push_back(directory.add_chunk(id_, first_row));
  }
}

void Table::reserve_more(std::size_t count) {
  if (count > max_rows_ - rows_) {
    give_up("more rows of one archetype than WorldLimits::max_rows_per_table");
  }
  const std::size_t need = rows_ + count;
  if (need <= capacity_) return;
  std::size_t capacity = std::min(std::max({need, capacity_ * 2, kFirstRows}), max_rows_);
  const auto commit = [&](ReservedMemory& memory, std::size_t row_bytes) {
    const std::size_t ahead = std::min(capacity * row_bytes, memory.capacity_bytes());
    memory.commit(std::max(need * row_bytes, ahead));
    capacity = std::min(capacity, memory.committed_bytes() / row_bytes);
  };
  commit(entities_, sizeof(Entity));
  for (Column& column : columns_)
    commit(column.memory, column.info->size_bytes);
  capacity_ = capacity;
}

void Table::construct_new_rows(std::size_t count, const Signature& except) {
  const bool fresh = rows_ == used_rows_;
  std::vector<const Column*> built;
  built.reserve(columns_.size());
  try {
    for (const Column& column : columns_) {
      if (except.contains(column.id)) continue;
      column.info->construct(column.memory.data(), rows_, count, fresh);
      built.push_back(&column);
    }
  } catch (...) {
    for (const Column* column : built) {
      if (column->info->destroy_range != nullptr)
        column->info->destroy_range(column->memory.data(), rows_, count);
    }
    throw;
  }
}

std::uint32_t Table::add_rows(std::size_t count) {
  const std::uint32_t first = rows_;
  rows_ += static_cast<std::uint32_t>(count);
  used_rows_ = std::max(used_rows_, rows_);
  return first;
}

void Table::destroy_rows(std::span<const std::uint32_t> rows, const Signature& which) {
  for (const Column& column : columns_) {
    if (column.info->destroy_rows != nullptr && which.contains(column.id)) {
      column.info->destroy_rows(column.memory.data(), rows.data(), rows.size());
    }
  }
}

void Table::plan_moves(std::span<const std::uint32_t> leaving_rows, std::vector<RowMove>& moves) {
  const auto count = static_cast<std::uint32_t>(leaving_rows.size());
  const std::uint32_t new_rows = rows_ - count;
  moves.clear();
  dead_.assign((count + 63) / 64, 0);
  for (const std::uint32_t row : leaving_rows) {
    if (row < new_rows) {
      moves.push_back({row, 0});
    } else {
      dead_[(row - new_rows) / 64] |= std::uint64_t{1} << ((row - new_rows) % 64);
    }
  }
  std::uint32_t filler = new_rows;  // as many of the last rows live as there are holes before them
  for (RowMove& move : moves) {
    while (((dead_[(filler - new_rows) / 64] >> ((filler - new_rows) % 64)) & 1) != 0)
      ++filler;
    move.from = filler++;
  }
}

void Table::close_holes(std::span<const std::uint32_t> leaving_rows, std::vector<RowMove>& moves) {
  plan_moves(leaving_rows, moves);
  for (const Column& column : columns_) {
    column.info->relocate_within(column.memory.data(), moves.data(), moves.size());
  }
  relocate_within_column<Entity>(entities_.data(), moves.data(), moves.size());
  rows_ -= static_cast<std::uint32_t>(leaving_rows.size());
}

std::size_t Table::committed_bytes() const {
  std::size_t bytes = entities_.committed_bytes();
  for (const Column& column : columns_)
    bytes += column.memory.committed_bytes();
  return bytes;
}

}  // namespace psygen::ecs::detail
