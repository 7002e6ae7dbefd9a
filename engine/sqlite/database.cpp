#include "engine/sqlite/database.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "engine/core/utf8.hpp"

namespace psygen::sqlite {

void Statement::bind(int index, std::string_view text) {
  sqlite3_bind_text64(get(), index, text.data() == nullptr ? "" : text.data(), text.size(),
                      SQLITE_STATIC, SQLITE_UTF8);
}

void Statement::bind(int index, std::span<const std::byte> bytes) {
  if (bytes.empty()) {
    sqlite3_bind_zeroblob(get(), index, 0);  // a null pointer would bind NULL
  } else {
    sqlite3_bind_blob64(get(), index, bytes.data(), bytes.size(), SQLITE_STATIC);
  }
}

void Statement::reset() {
  sqlite3_reset(get());
  sqlite3_clear_bindings(get());
}

std::string_view Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(get(), column));
  if (text == nullptr) return {};
  return {text, static_cast<std::size_t>(sqlite3_column_bytes(get(), column))};
}

std::span<const std::byte> Statement::bytes(int column) const {
  const auto* bytes = static_cast<const std::byte*>(sqlite3_column_blob(get(), column));
  if (bytes == nullptr) return {};
  return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(get(), column))};
}

core::Result<std::filesystem::path> absolute_path(const std::filesystem::path& file) {
  if (file.empty()) return core::fail(core::ErrorCode::kIo, "the file name is empty");
  std::error_code error;
  std::filesystem::path path = std::filesystem::absolute(file, error);
  if (!error) return path;
  return core::fail(core::ErrorCode::kIo, fmt::format("{}: {}", file.string(), error.message()));
}

core::Result<Database> Database::open(const std::filesystem::path& file) {
  auto database = open_to_read(file);
  if (database && sqlite3_db_readonly(database->get(), "main") != 0)
    return core::fail(core::ErrorCode::kIo,
                      fmt::format("{}: the file is read-only", file.string()));
  return database;
}

core::Result<Database> Database::open_to_read(const std::filesystem::path& file) {
  sqlite3* raw = nullptr;
  // An absolute path, because SQLite takes names that begin with "file:" for URIs.
  const auto name = absolute_path(file);
  if (!name) return tl::unexpected(name.error());
  const int code =
      sqlite3_open_v2(name->c_str(), &raw,
                      SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE, nullptr);
  Database database(file, raw);
  if (code != SQLITE_OK) return database.error("cannot be opened");
  return database;
}

core::Result<Database> Database::open_unlocked(const std::filesystem::path& file) {
  const auto path = absolute_path(file);
  if (!path) return tl::unexpected(path.error());
  std::string name = "file:";
  for (const char c : path->string()) {
    if (c == '%' || c == '?' || c == '#')
      name += fmt::format("%{:02X}", static_cast<unsigned>(c));
    else
      name += c;
  }
  name += "?immutable=1";  // https://www.sqlite.org/uri.html
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(
      name.c_str(), &raw,
      SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE,
      nullptr);
  Database database(file, raw);
  if (code != SQLITE_OK) return database.error("cannot be opened");
  return database;
}

core::Result<Database> Database::in_memory() {
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(
      ":memory:", &raw,
      SQLITE_OPEN_READWRITE | SQLITE_OPEN_MEMORY | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE,
      nullptr);
  Database database("memory", raw);
  if (code != SQLITE_OK) return database.error("cannot be opened");
  return database;
}

core::Result<void> Database::run(const char* sql, std::string_view action) {
  if (sqlite3_exec(get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) return error(action);
  return {};
}

core::Result<Statement> Database::prepare(std::string_view sql, std::string_view action) const {
  sqlite3_stmt* raw = nullptr;
  const int code =
      sqlite3_prepare_v2(get(), sql.data(), static_cast<int>(sql.size()), &raw, nullptr);
  Statement statement(raw);
  if (code != SQLITE_OK) return error(action);
  return statement;
}

// The system's error code after a failed call on the file or its journal; 0: none.
int Database::system_error() const {
  int code = 0;
  sqlite3_file_control(get(), "main", SQLITE_FCNTL_LAST_ERRNO, &code);
  sqlite3_file* journal = nullptr;
  sqlite3_file_control(get(), "main", SQLITE_FCNTL_JOURNAL_POINTER, &journal);
  if (code == 0 && journal != nullptr && journal->pMethods != nullptr)
    journal->pMethods->xFileControl(journal, SQLITE_FCNTL_LAST_ERRNO, &code);
  return code != 0 ? code : sqlite3_system_errno(get());
}

tl::unexpected<core::Error> Database::error(std::string_view action) const {
  using enum core::ErrorCode;
  const int code = get() == nullptr ? SQLITE_NOMEM : sqlite3_extended_errcode(get());
  const int system = get() == nullptr ? 0 : system_error();
  const auto sentence = [&](core::ErrorCode kind, std::string_view reason) {
    return core::fail(kind, fmt::format("{}: {}: {}", file_.string(), action, reason));
  };
  switch (code & 0xFF) {
    case SQLITE_NOMEM:
      return sentence(kOutOfMemory, "there is not enough memory");
    case SQLITE_FULL:
      return sentence(kIo, "the disk is full");
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return sentence(kParse, "the file is damaged");
    case SQLITE_BUSY:
      return sentence(kIo, "another process uses the file");
    case SQLITE_CANTOPEN: {
      std::error_code ignored;
      // SQLite hides the reason by another try, without making the file.
      if (system == ENOENT && std::filesystem::exists(file_, ignored))
        return sentence(kIo,
                        "no file can be made beside it: the disk is full, or the folder is "
                        "read-only");
      [[fallthrough]];
    }
    case SQLITE_IOERR:
      if (system != 0) return sentence(kIo, std::strerror(system));
      [[fallthrough]];
    default:
      return sentence(kIo, core::shown(sqlite3_errmsg(get()), 200));
  }
}

void distrust(const Database& database) {
  sqlite3* raw = database.get();
  sqlite3_db_config(raw, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  for (const int unsafe :
       {SQLITE_DBCONFIG_TRUSTED_SCHEMA, SQLITE_DBCONFIG_ENABLE_TRIGGER, SQLITE_DBCONFIG_ENABLE_VIEW,
        SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, SQLITE_DBCONFIG_DQS_DDL, SQLITE_DBCONFIG_DQS_DML})
    sqlite3_db_config(raw, unsafe, 0, nullptr);
  sqlite3_limit(raw, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_limit(raw, SQLITE_LIMIT_SQL_LENGTH, 1 << 20);
}

// The tables' own CHECK constraints stay out of it: their expressions may take hours.
core::Result<void> check_pages(Database& database) {
  if (auto ok = database.run("PRAGMA ignore_check_constraints=ON", "cannot be read"); !ok)
    return ok;
  auto check = database.prepare("PRAGMA quick_check(1)", "cannot be read");
  if (!check) return tl::unexpected(check.error());
  if (check->step() != SQLITE_ROW) return database.error("cannot be read");
  if (check->text(0) != "ok")
    return core::fail(core::ErrorCode::kParse,
                      fmt::format("{}: the file is damaged: its pages contradict each other",
                                  database.file().string()));
  check->reset();
  return database.run("PRAGMA ignore_check_constraints=OFF", "cannot be read");
}

}  // namespace psygen::sqlite
