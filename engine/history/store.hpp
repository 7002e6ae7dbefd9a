// The file of a history: an SQLite database of jobs and their figures. Several processes may add at
// once: each waits for the others up to a minute. A failure, a crash or a full disk leaves the file
// as it was. Judges nothing. One thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/history/entry.hpp"
#include "engine/sqlite/database.hpp"

namespace psygen::history {

// Version of the file's format. Files of other versions are refused.
inline constexpr int kStoreFormat = 1;
// Most bytes of each text of an entry.
inline constexpr std::size_t kMaxTextBytes = 4096;

class Store {
 public:
  // Opens a history to add to it, and makes it if it does not exist or is empty. Fails with kIo for
  // files that cannot be read or written, with kParse for damaged files, other files, and histories
  // of other versions.
  static core::Result<Store> open(const std::filesystem::path& file);
  // Opens an existing history to read it. Fails like open().
  static core::Result<Store> open_to_read(const std::filesystem::path& file);

  // Adds entries, all or none. Their orders are replaced: entries with different orders become
  // different jobs, after all jobs of the file, in the order of their first entries. Returns the
  // first new order. Fails with kInvalidArgument for empty tests and figures, for texts of over
  // kMaxTextBytes, and for two values of one figure in a job.
  core::Result<std::int64_t> add(std::span<const Entry> entries);
  // All entries, in the order of adding. Fails with kIo and kParse.
  core::Result<std::vector<Entry>> read() const;
  // Gives a test a new name; returns its number of jobs. Fails with kInvalidArgument if there is no
  // such test, and with a suggestion.
  core::Result<std::int64_t> rename(const std::string& test, const std::string& name);

 private:
  explicit Store(sqlite::Database database) : database_(std::move(database)) {}
  core::Result<void> make_tables();
  core::Result<void> check_format();
  core::Result<std::int64_t> id_of(const char* table_sql, const char* find_sql,
                                   std::span<const std::string> texts);
  core::Result<void> add_all(std::span<const Entry> entries, std::int64_t first);
  core::Result<std::int64_t> number(const char* sql) const;

  sqlite::Database database_;
};

}  // namespace psygen::history
