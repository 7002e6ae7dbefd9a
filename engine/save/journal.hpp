// The files beside a save that SQLite reads, rolls back, or removes when it opens the save. Reads
// their bytes before SQLite does. https://www.sqlite.org/fileformat2.html#the_rollback_journal
#pragma once

#include <cstdint>
#include <filesystem>

#include "engine/core/error.hpp"

namespace psygen::save {

// Reads four bytes, the highest first.
inline std::uint32_t big_endian(const unsigned char* bytes) {
  return (std::uint32_t{bytes[0]} << 24) | (std::uint32_t{bytes[1]} << 16) |
         (std::uint32_t{bytes[2]} << 8) | bytes[3];
}

// Succeeds if the journal beside `file` is absent, empty, invalidated, or one that this program can
// have left when it was killed. kParse: the journal names another file, which SQLite would remove;
// it has another page size; it would restore more bytes than save and journal hold; it is not a
// regular file; or there is a write-ahead log. kIo: it cannot be read. Changes nothing.
core::Result<void> check_journal(const std::filesystem::path& file, std::int64_t page_bytes);

}  // namespace psygen::save
