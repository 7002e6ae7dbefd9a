// Names every row of every table with one 32-bit location, so a slot needs no more. Rows are named
// in chunks of 4096: the upper 20 bits of a location choose a chunk, which belongs to one table,
// and the lower 12 bits a row in it. Location 0 and the rest of chunk 0 are nowhere. The directory
// only grows. Lookups are O(1); only the world's thread adds chunks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ecs/check.hpp"

namespace psygen::ecs::detail {

// Rows per chunk.
inline constexpr std::uint32_t kChunkRows = 4096;
inline constexpr std::uint32_t kNowhere = 0;             // the location of a free slot
inline constexpr std::uint32_t kInTransit = UINT32_MAX;  // the location of an entity during a move

// A table by its id and a row in it.
struct RowPlace {
  std::uint32_t table;
  std::uint32_t row;
};

// The chunks of one world, in the order of their creation.
class RowDirectory {
 public:
  // Starts with chunk 0, which is nowhere.
  RowDirectory() : chunks_{{0, 0}} {}

  // Names rows [first_row, first_row + 4096) of a table and returns the location of the first. Ends
  // the program when it runs out of locations, at about four billion rows.
  std::uint32_t add_chunk(std::uint32_t table, std::uint32_t first_row) {
    if (chunks_.size() == kMaxChunks) give_up("more than four billion rows in one world");
    chunks_.push_back({table, first_row});
    return static_cast<std::uint32_t>(chunks_.size() - 1) * kChunkRows;
  }

  // Number of chunks, chunk 0 included.
  std::size_t chunk_count() const { return chunks_.size(); }

  // Returns the row at a location. Nowhere gives table 0, which no table has. Not for kInTransit.
  RowPlace place_of(std::uint32_t location) const {
    const RowPlace chunk = chunks_[location / kChunkRows];
    return {chunk.table, chunk.row + location % kChunkRows};
  }

 private:
  static constexpr std::size_t kMaxChunks = UINT32_MAX / kChunkRows;
  std::vector<RowPlace> chunks_;  // table and first row
};

}  // namespace psygen::ecs::detail
