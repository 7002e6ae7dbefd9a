// SQLite as values: a connection to one file, and prepared statements. The only header of the
// project that includes SQLite. Private to the engine: saves and histories are files of SQLite. Not
// a query builder. One thread at a time.
#pragma once

#include <sqlite3.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::sqlite {

// A prepared statement. Indices of parameters start at 1, those of columns at 0.
class Statement {
 public:
  Statement() = default;
  explicit Statement(sqlite3_stmt* statement) : statement_(statement, &sqlite3_finalize) {}
  explicit operator bool() const { return statement_ != nullptr; }
  sqlite3_stmt* get() const { return statement_.get(); }

  // Texts and bytes are not copied and must live until the next reset().
  void bind(int index, std::int64_t value) { sqlite3_bind_int64(get(), index, value); }
  void bind(int index, std::string_view text);
  void bind(int index, std::span<const std::byte> bytes);
  void bind(int index, double value) { sqlite3_bind_double(get(), index, value); }
  void bind_null(int index) { sqlite3_bind_null(get(), index); }
  // Runs up to the next row: SQLITE_ROW, SQLITE_DONE or an error code.
  int step() { return sqlite3_step(get()); }
  // Ends the run and clears the parameters, so that the statement can run again.
  void reset();

  // The type of a column's content (SQLITE_INTEGER, ...), a test of it, and the content.
  int type(int column) const { return sqlite3_column_type(get(), column); }
  bool is(int column, int type) const { return this->type(column) == type; }
  std::int64_t integer(int column) const { return sqlite3_column_int64(get(), column); }
  double real(int column) const { return sqlite3_column_double(get(), column); }
  std::string_view text(int column) const;
  std::span<const std::byte> bytes(int column) const;

 private:
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement_{nullptr, &sqlite3_finalize};
};

// The absolute path of a file that need not exist. Fails with kIo for an empty name and if the
// working folder no longer exists.
core::Result<std::filesystem::path> absolute_path(const std::filesystem::path& file);

// An open file. Holds no lock until it is used.
class Database {
 public:
  // Opens an existing file for reading and writing, without reading it. Fails with kIo.
  static core::Result<Database> open(const std::filesystem::path& file);
  // Opens an existing file, also a read-only one, to read it while others write. If it may, it
  // rolls back what a crashed writer has left. Fails with kIo.
  static core::Result<Database> open_to_read(const std::filesystem::path& file);
  // Opens an existing file read-only and as immutable: takes no lock and keeps the locks of this
  // process. Fails with kIo.
  static core::Result<Database> open_unlocked(const std::filesystem::path& file);
  // A database in memory.
  static core::Result<Database> in_memory();

  // Runs statements without parameters and rows. Fails like error().
  core::Result<void> run(const char* sql, std::string_view action);
  // Prepares a statement. Fails like error().
  core::Result<Statement> prepare(std::string_view sql, std::string_view action) const;
  // The latest failure as a message with file, action and reason. kIo, kParse for damaged files, or
  // kOutOfMemory.
  tl::unexpected<core::Error> error(std::string_view action) const;
  // True if a transaction is open.
  bool in_transaction() const { return sqlite3_get_autocommit(get()) == 0; }

  // The connection of SQLite, and the path of the file.
  sqlite3* get() const { return database_.get(); }
  const std::filesystem::path& file() const { return file_; }

 private:
  Database(std::filesystem::path file, sqlite3* database)
      : file_(std::move(file)), database_(database, &sqlite3_close_v2) {}
  int system_error() const;

  std::filesystem::path file_;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database_;
};

// Sets SQLite up for a file that somebody else may have written: without triggers, views, attached
// files and functions of its schema.
void distrust(const Database& database);
// Fails with kParse if the pages contradict each other, and like Database::error(). Reads the whole
// file.
core::Result<void> check_pages(Database& database);

}  // namespace psygen::sqlite
