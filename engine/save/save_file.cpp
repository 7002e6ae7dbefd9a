#include "engine/save/save_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>

#include "engine/core/bytes.hpp"
#include "engine/core/data_file.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/core/utf8.hpp"
#include "engine/save/game_tables.hpp"
#include "engine/save/journal.hpp"
#include "engine/save/lock_holder.hpp"
#include "engine/save/save_game.hpp"

namespace psygen::save {
namespace {

struct Table {
  std::string_view name;
  std::string_view sql;  // exactly as in sqlite_schema
  std::uint32_t since_format = 1;
};
constexpr std::array kTables{
    Table{"psygen_facts", "CREATE TABLE psygen_facts(name TEXT PRIMARY KEY, value ANY) STRICT"},
    Table{"psygen_edits",
          "CREATE TABLE psygen_edits(x INTEGER NOT NULL, z INTEGER NOT NULL, version INTEGER NOT "
          "NULL, checksum INTEGER NOT NULL, bytes BLOB NOT NULL, PRIMARY KEY(x, z)) STRICT, "
          "WITHOUT ROWID"},
    Table{"psygen_values",
          "CREATE TABLE psygen_values(name TEXT PRIMARY KEY, checksum INTEGER NOT NULL, value ANY "
          "NOT NULL) STRICT, WITHOUT ROWID"},
    Table{"psygen_surfaces",
          "CREATE TABLE psygen_surfaces(x INTEGER NOT NULL, z INTEGER NOT NULL, hash INTEGER NOT "
          "NULL, PRIMARY KEY(x, z)) STRICT, WITHOUT ROWID",
          2},
    Table{"psygen_kept",
          "CREATE TABLE psygen_kept(x INTEGER NOT NULL, z INTEGER NOT NULL, world INTEGER NOT "
          "NULL, parts BLOB NOT NULL, version INTEGER NOT NULL, checksum INTEGER NOT NULL, bytes "
          "BLOB NOT NULL) STRICT",
          2},
};
constexpr std::size_t kMaxParts = 4096;

tl::unexpected<core::Error> refuse(const std::filesystem::path& file, std::string_view reason) {
  return core::fail(core::ErrorCode::kParse, fmt::format("{}: {}", file.string(), reason));
}

core::Result<void> put_fact(Database& database, std::string_view name, const Value& value) {
  auto insert = database.prepare("INSERT INTO psygen_facts VALUES(?, ?)", "cannot be made");
  if (!insert) return tl::unexpected(insert.error());
  insert->bind(1, name);
  bind_value(*insert, 2, value);
  if (insert->step() != SQLITE_DONE) return database.error("cannot be made");
  return {};
}

// The bytes of an empty save.
core::Result<std::string> empty_save(const WorldIdentity& world, std::uint32_t version) {
  auto database = Database::in_memory();
  if (!database) return tl::unexpected(database.error());
  std::string sql = fmt::format("PRAGMA application_id={}; PRAGMA user_version={}; BEGIN;",
                                kApplicationId, kSaveFormat);
  for (const Table& table : kTables)
    sql += fmt::format("{};", table.sql);
  sql += "COMMIT;";
  auto made = database->run(sql.c_str(), "cannot be made");
  if (made) made = put_fact(*database, "world name", Value(world.name));
  const auto hash = static_cast<std::int64_t>(world.hash);
  if (made) made = put_fact(*database, "world hash", Value(hash));
  if (made) made = put_fact(*database, "world parts", Value(encode_parts(world.parts)));
  if (made) made = put_fact(*database, kVersionFact, Value(std::int64_t{version}));
  if (!made) return tl::unexpected(made.error());
  sqlite3_int64 size = 0;
  const std::unique_ptr<unsigned char, void (*)(void*)> bytes(
      sqlite3_serialize(database->get(), "main", &size, 0), &sqlite3_free);
  if (bytes == nullptr) return database->error("cannot be made");
  return std::string(reinterpret_cast<const char*>(bytes.get()), static_cast<std::size_t>(size));
}

// The first bytes of a database.
// https://www.sqlite.org/fileformat2.html#the_database_header
using Header = std::array<unsigned char, 100>;

// SQLite's own file. A second descriptor must not be opened: closing it drops all locks that this
// process has on the file. Null if there is none.
sqlite3_file* file_of(const Database& database) {
  sqlite3_file* raw = nullptr;
  sqlite3_file_control(database.get(), "main", SQLITE_FCNTL_FILE_POINTER, &raw);
  return raw == nullptr || raw->pMethods == nullptr ? nullptr : raw;
}

// SQLITE_OK, or the error code of reading the header.
int read_header(const Database& database, Header& header) {
  sqlite3_file* raw = file_of(database);
  return raw == nullptr
             ? SQLITE_IOERR
             : raw->pMethods->xRead(raw, header.data(), static_cast<int>(header.size()), 0);
}

std::int64_t page_bytes(const Header& header) {
  return header[16] == 0 && header[17] == 1 ? 65536 : header[16] << 8 | header[17];
}

// Checks the first bytes before SQLite acts on them.
core::Result<void> check_header(const Database& database) {
  Header header{};
  const int read = read_header(database, header);
  const std::filesystem::path& file = database.file();
  if (read != SQLITE_OK && read != SQLITE_IOERR_SHORT_READ)
    return core::fail(core::ErrorCode::kIo, fmt::format("{}: cannot be read", file.string()));
  if (read != SQLITE_OK || std::memcmp(header.data(), "SQLite format 3", 16) != 0 ||
      big_endian(&header[68]) != kApplicationId)
    return refuse(file, "is not a saved game of psygen; it was not changed");
  if (const std::uint32_t format = big_endian(&header[60]); format > kSaveFormat)
    return refuse(file, fmt::format("has format {} of a newer version; psygen {} reads up to "
                                    "format {}",
                                    format, core::version(), kSaveFormat));
  else if (format == 0)
    return refuse(file, "has no format number; the file is damaged");
  // 1: rollback journal. 2 would be a write-ahead log, which this program never makes.
  if (header[18] != 1 || header[19] != 1)
    return refuse(file, "was changed by another program (its journal mode is not \"delete\")");
  return {};
}

// Takes the lock, which also rolls back the unfinished transaction of a killed process. Checks the
// files that take part in it first, and the header that it has restored afterwards.
core::Result<void> lock(Database& database) {
  Header header{};
  if (read_header(database, header) != SQLITE_OK) return database.error("cannot be read");
  if (auto sound = check_journal(database.file(), page_bytes(header)); !sound) return sound;
  const int code =
      sqlite3_exec(database.get(), "PRAGMA locking_mode=EXCLUSIVE; BEGIN EXCLUSIVE; COMMIT",
                   nullptr, nullptr, nullptr);
  if ((code & 0xFF) == SQLITE_BUSY)
    return core::fail(
        core::ErrorCode::kIo,
        fmt::format("{}: is in use by {}", database.file().string(), lock_holder(database.file())));
  if (code != SQLITE_OK) return database.error("cannot be opened");
  return check_header(database);
}

// Call it after lock(), which may have restored the size. SQLite treats missing bytes at the end of
// the last page as zeros.
core::Result<void> check_size(const Database& database) {
  Header header{};
  sqlite3_file* raw = file_of(database);
  sqlite3_int64 bytes = 0;
  if (raw == nullptr || read_header(database, header) != SQLITE_OK ||
      raw->pMethods->xFileSize(raw, &bytes) != SQLITE_OK)
    return database.error("cannot be read");
  const std::int64_t needed = page_bytes(header) * std::int64_t{big_endian(&header[28])};
  // Other programs may have left an old page count (bytes 24 and 92 differ then).
  if (bytes >= needed || std::memcmp(&header[24], &header[92], 4) != 0) return {};
  return refuse(database.file(),
                fmt::format("the file is cut short: it has {} of its {} bytes", bytes, needed));
}

// Call it after lock(): most of these pragmas read the file. The journal persists and is
// invalidated by zeros in its header, which is faster than removing it at every save.
core::Result<void> configure(Database& database) {
  return database.run(
      "PRAGMA synchronous=FULL; PRAGMA temp_store=MEMORY; PRAGMA cache_spill=OFF;"
      "PRAGMA cache_size=-16384; PRAGMA secure_delete=OFF; PRAGMA cell_size_check=ON;"
      "PRAGMA mmap_size=0; PRAGMA journal_mode=PERSIST; PRAGMA journal_size_limit=16777216;",
      "cannot be opened");
}

core::Result<void> check_regular(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (std::filesystem::is_regular_file(status)) return {};
  return core::fail(core::ErrorCode::kIo,
                    fmt::format("{}: {}", file.string(),
                                std::filesystem::exists(status) ? "is not a regular file"
                                                                : "the file does not exist"));
}

core::Result<void> check_folder(const std::filesystem::path& file,
                                const std::filesystem::path& folder) {
  std::error_code error;
  const auto status = std::filesystem::status(folder, error);
  if (std::filesystem::is_directory(status)) return {};
  const bool missing = status.type() == std::filesystem::file_type::not_found;
  if (!error || missing)
    return core::fail(core::ErrorCode::kIo, fmt::format("{}: the folder {} does not exist",
                                                        file.string(), folder.string()));
  return core::fail(core::ErrorCode::kIo, fmt::format("{}: {}", file.string(), error.message()));
}

core::Result<void> check_writable(const std::filesystem::path& file) {
  const auto say = [&](std::string_view what) {
    return core::fail(core::ErrorCode::kIo, fmt::format("{}: {}", file.string(), what));
  };
  if (access(file.c_str(), W_OK) != 0) return say("the file is read-only");
  const auto path = absolute_path(file);
  if (!path) return tl::unexpected(path.error());
  const std::filesystem::path folder = path->parent_path();
  if (access(folder.c_str(), W_OK) != 0) return say("its folder is read-only");
  return {};
}

// Renames a file unless the new name is taken. 0 or an error number.
int rename_without_replacing(const char* from, const char* to) {
  if (renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
  // The file system or the kernel does not support this call.
  if (link(from, to) != 0) return errno;
  unlink(from);
  return 0;
}

}  // namespace

core::Result<bool> create_file(const std::filesystem::path& file, const WorldIdentity& world,
                               std::uint32_t version) {
  const auto path = absolute_path(file);
  if (!path) return tl::unexpected(path.error());
  const std::filesystem::path folder = path->parent_path();
  if (auto ok = check_folder(file, folder); !ok) return tl::unexpected(ok.error());
  core::remove_stale_partials(folder);
  const auto bytes = empty_save(world, version);
  if (!bytes) return tl::unexpected(bytes.error());
  const std::filesystem::path fresh =
      folder / fmt::format(".{}.{}-new.partial", file.filename().string(), getpid());
  if (auto written = core::replace_file(fresh, *bytes); !written) {
    std::string& message = written.error().message;  // begins with the name of `fresh`
    message.replace(0, fresh.string().size(), file.string());
    return tl::unexpected(written.error());
  }
  // The save gets its name only if no other process has created the file in the meantime.
  const int reason = rename_without_replacing(fresh.c_str(), file.c_str());
  if (reason == 0) return true;
  unlink(fresh.c_str());
  if (reason == EEXIST) return false;
  return core::fail(core::ErrorCode::kIo,
                    fmt::format("{}: cannot be made: {}", file.string(), std::strerror(reason)));
}

core::Result<Database> open_file(const std::filesystem::path& file) {
  auto ok = check_regular(file);
  if (ok) ok = check_writable(file);
  if (!ok) return tl::unexpected(ok.error());
  auto database = Database::open(file);
  if (!database) return database;
  distrust(*database);
  ok = check_header(*database);
  if (ok) ok = lock(*database);
  if (ok) ok = check_size(*database);
  if (!ok) return tl::unexpected(ok.error());  // the file may be another program's
  ok = configure(*database);
  if (ok) ok = check_pages(*database);
  if (ok) ok = check_tables(*database);
  if (ok) return database;
  close_file(*database);
  return tl::unexpected(ok.error());
}

core::Result<Database> open_to_look(const std::filesystem::path& file) {
  if (auto ok = check_regular(file); !ok) return tl::unexpected(ok.error());
  auto database = Database::open_unlocked(file);
  if (!database) return database;
  auto ok = check_header(*database);
  if (!ok) return tl::unexpected(ok.error());
  distrust(*database);
  ok = database->run("PRAGMA cell_size_check=ON; PRAGMA mmap_size=0", "cannot be read");
  if (ok) ok = check_tables(*database);
  if (!ok) return tl::unexpected(ok.error());
  return database;
}

void close_file(Database& database) {
  if (database.get() == nullptr) return;
  if (database.in_transaction()) (void)database.run("ROLLBACK", "cannot be closed");
  (void)database.run(
      "PRAGMA locking_mode=NORMAL; SELECT 1 FROM sqlite_schema; PRAGMA journal_mode=DELETE",
      "cannot be closed");
}

std::uint32_t format_of(const Database& database) {
  Header header{};
  return read_header(database, header) == SQLITE_OK ? big_endian(&header[60]) : 0;
}

core::Result<void> upgrade_format(Database& database) {
  const std::uint32_t format = format_of(database);
  std::string sql = fmt::format("PRAGMA user_version={};", kSaveFormat);
  for (const Table& table : kTables)
    if (table.since_format > format) sql += fmt::format("{};", table.sql);
  return database.run(sql.c_str(), "cannot be saved");
}

core::Result<void> check_tables(const Database& database) {
  const std::uint32_t format = format_of(database);
  auto list =
      database.prepare("SELECT type, tbl_name, name, sql FROM sqlite_schema", "cannot be read");
  if (!list) return tl::unexpected(list.error());
  std::size_t found = 0;
  int code = list->step();
  for (; code == SQLITE_ROW; code = list->step()) {
    const std::string_view type = list->text(0), table = list->text(1), name = list->text(2);
    bool known = (type == "table" || type == "index") && is_game_table(table) &&
                 (is_game_table(name) || name.starts_with("sqlite_")) &&
                 !list->text(3).starts_with("CREATE VIRTUAL");
    if (type == "table" && name == "sqlite_sequence") known = true;
    if (type == "index" && name.starts_with("sqlite_autoindex_psygen_facts")) known = true;
    for (const Table& own : kTables) {
      if (type != "table" || name != own.name || own.since_format > format) continue;
      known = list->text(3) == own.sql;
      found += known ? 1 : 0;
    }
    if (!known)
      return refuse(database.file(), fmt::format("has a {} '{}' that this program did not make",
                                                 core::shown(type, 20), core::shown(name, 60)));
  }
  if (code != SQLITE_DONE) return database.error("cannot be read");
  const auto needed =
      std::ranges::count_if(kTables, [&](const Table& own) { return own.since_format <= format; });
  if (found != static_cast<std::size_t>(needed))
    return refuse(database.file(), "lacks a table; the file is damaged");
  return {};
}

core::Result<WorldIdentity> read_world(const Database& database) {
  auto select = database.prepare(
      "SELECT (SELECT value FROM psygen_facts WHERE name = 'world name'),"
      "(SELECT value FROM psygen_facts WHERE name = 'world hash'),"
      "(SELECT value FROM psygen_facts WHERE name = 'world parts')",
      "cannot be read");
  if (!select) return tl::unexpected(select.error());
  if (select->step() != SQLITE_ROW) return database.error("cannot be read");
  if (!select->is(0, SQLITE_TEXT) || !select->is(1, SQLITE_INTEGER))
    return refuse(database.file(), "does not name its world; the file is damaged");
  WorldIdentity world{std::string(select->text(0)), static_cast<std::uint64_t>(select->integer(1))};
  if (select->is(2, SQLITE_NULL)) return world;  // of format 1
  auto parts = decode_parts(select->bytes(2));
  if (!parts) return refuse(database.file(), parts.error().message);
  world.parts = std::move(*parts);
  return world;
}

Bytes encode_parts(const std::vector<WorldPart>& parts) {
  Bytes out;
  core::put(out, static_cast<std::uint32_t>(parts.size()));
  for (const WorldPart& part : parts) {
    core::put(out, part.kind, part.hash, part.count, static_cast<std::uint32_t>(part.name.size()));
    core::put_all(out, std::span<const char>(part.name));
  }
  core::put(out, core::hash_bytes(out));
  return out;
}

core::Result<std::vector<WorldPart>> decode_parts(std::span<const std::byte> bytes) {
  const auto broken = [](std::string_view why) {
    return core::fail(
        core::ErrorCode::kParse,
        fmt::format("the parts of its world cannot be read: {}; the file is damaged", why));
  };
  if (bytes.size() < 12) return broken("they end too early");
  const auto content = bytes.first(bytes.size() - 8);
  if (core::ByteReader(bytes.subspan(content.size())).get<std::uint64_t>() !=
      core::hash_bytes(content))
    return broken("they do not match their checksum");
  core::ByteReader in(content);
  const std::size_t count = in.get_count(17);
  if (count > kMaxParts)
    return broken(fmt::format("they are {}; at most {} are allowed", count, kMaxParts));
  std::vector<WorldPart> parts(count);
  for (WorldPart& part : parts) {
    in.read(part.kind, part.hash, part.count);
    part.name = in.get_text(in.get_count(1));
    if (part.kind > PartKind::kLooks)
      return core::fail(core::ErrorCode::kParse,
                        fmt::format("its world has a part of a kind that psygen {} does not know",
                                    core::version()));
  }
  if (in.failed()) return broken("they end too early");
  if (in.left() > 0) return broken("there are extra bytes at the end");
  return parts;
}

}  // namespace psygen::save
