#include "engine/history/store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "engine/core/nearest_word.hpp"
#include "engine/core/utf8.hpp"

namespace psygen::history {
namespace {

using core::ErrorCode;
using sqlite::Database;
using sqlite::Statement;

constexpr int kApplicationId = 0x70737968;  // "psyh"
constexpr int kPatienceMs = 60'000;
constexpr const char* kTables =
    "CREATE TABLE jobs(id INTEGER PRIMARY KEY, test TEXT NOT NULL, revision TEXT NOT NULL, "
    "time INTEGER NOT NULL, work REAL, report TEXT NOT NULL) STRICT;"
    "CREATE TABLE figures(id INTEGER PRIMARY KEY, name TEXT NOT NULL, unit TEXT NOT NULL, "
    "UNIQUE(name, unit)) STRICT;"
    "CREATE TABLE fingerprints(id INTEGER PRIMARY KEY, text TEXT NOT NULL UNIQUE) STRICT;"
    "CREATE TABLE entries(job INTEGER NOT NULL REFERENCES jobs(id), figure INTEGER NOT NULL "
    "REFERENCES figures(id), fingerprint INTEGER NOT NULL REFERENCES fingerprints(id), value REAL, "
    "reference REAL, PRIMARY KEY(job, figure)) STRICT, WITHOUT ROWID;";
constexpr const char* kCountTables = "SELECT count(*) FROM sqlite_schema";
constexpr const char* kRead = "cannot be read";
constexpr const char* kAdd = "cannot be added to";

void bind(Statement& statement, int index, const std::optional<double>& value) {
  if (value && std::isfinite(*value))
    statement.bind(index, *value);
  else
    statement.bind_null(index);
}

std::optional<double> real_at(const Statement& row, int column) {
  if (row.is(column, SQLITE_NULL)) return std::nullopt;
  return row.real(column);
}

core::Result<void> check_entry(const Entry& entry) {
  if (entry.test.empty() || entry.figure.empty())
    return core::invalid_argument("an entry needs a test and a figure");
  for (const std::string* text : {&entry.test, &entry.figure, &entry.unit, &entry.revision,
                                  &entry.fingerprint, &entry.report})
    if (text->size() > kMaxTextBytes)
      return core::invalid_argument(
          fmt::format("'{}': a text of an entry has {} bytes; at most {} are allowed",
                      core::shown(*text, 60), text->size(), kMaxTextBytes));
  return {};
}

core::Result<void> check_entries(std::span<const Entry> entries) {
  std::set<std::tuple<std::int64_t, std::string_view>> seen;
  for (const Entry& entry : entries) {
    if (auto ok = check_entry(entry); !ok) return ok;
    if (!seen.emplace(entry.order, entry.figure).second)
      return core::invalid_argument(fmt::format("{}: two values of {} in one job",
                                                core::shown(entry.test, 200),
                                                core::shown(entry.figure, 200)));
  }
  return {};
}

// Makes an empty file, which is an empty database.
core::Result<void> make_file(const std::filesystem::path& file) {
  const int made = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (made < 0)
    return core::fail(ErrorCode::kIo, fmt::format("{}: {}", file.string(), std::strerror(errno)));
  close(made);
  return {};
}

core::Result<void> configure(Database& database) {
  sqlite3_busy_timeout(database.get(), kPatienceMs);
  sqlite::distrust(database);
  return database.run("PRAGMA cell_size_check=ON", kRead);
}

}  // namespace

core::Result<std::int64_t> Store::number(const char* sql) const {
  auto statement = database_.prepare(sql, kRead);
  if (!statement) return tl::unexpected(statement.error());
  if (statement->step() != SQLITE_ROW) return database_.error(kRead);
  return statement->integer(0);
}

core::Result<void> Store::check_format() {
  const auto id = number("PRAGMA application_id"), format = number("PRAGMA user_version");
  if (!id || !format) return tl::unexpected((id ? format : id).error());
  const std::string name = database_.file().string();
  if (*id != kApplicationId)
    return core::fail(ErrorCode::kParse, name + ": the file is not a history of psygen");
  if (*format != kStoreFormat)
    return core::fail(ErrorCode::kParse,
                      fmt::format("{}: the history has format {}; this version of psygen reads "
                                  "format {}",
                                  name, *format, kStoreFormat));
  const auto pages = number("PRAGMA page_count"), bytes = number("PRAGMA page_size");
  if (!pages || !bytes) return tl::unexpected((pages ? bytes : pages).error());
  std::error_code error;
  const auto size = std::filesystem::file_size(database_.file(), error);
  if (!error && size < static_cast<std::uintmax_t>(*pages * *bytes))
    return core::fail(ErrorCode::kParse, name + ": the file is damaged: its end is missing");
  return sqlite::check_pages(database_);
}

core::Result<void> Store::make_tables() {
  if (auto ok = database_.run("BEGIN IMMEDIATE", "cannot be made"); !ok) return ok;
  const auto tables = number(kCountTables);
  auto made = core::Result<void>();
  if (!tables)
    made = tl::unexpected(tables.error());
  else if (*tables == 0)  // else another process has made them
    made = database_.run(fmt::format("PRAGMA application_id={}; PRAGMA user_version={}; {}",
                                     kApplicationId, kStoreFormat, kTables)
                             .c_str(),
                         "cannot be made");
  if (made) made = database_.run("COMMIT", "cannot be made");
  if (!made && database_.in_transaction()) (void)database_.run("ROLLBACK", "cannot be made");
  return made;
}

core::Result<Store> Store::open(const std::filesystem::path& file) {
  std::error_code error;
  if (!file.empty() && !std::filesystem::exists(file, error))
    if (auto ok = make_file(file); !ok) return tl::unexpected(ok.error());
  auto database = Database::open(file);
  if (!database) return tl::unexpected(database.error());
  if (auto ok = configure(*database); !ok) return tl::unexpected(ok.error());
  Store store(std::move(*database));
  const auto tables = store.number(kCountTables);
  if (!tables) return tl::unexpected(tables.error());
  if (*tables == 0)
    if (auto ok = store.make_tables(); !ok) return tl::unexpected(ok.error());
  if (auto ok = store.check_format(); !ok) return tl::unexpected(ok.error());
  return store;
}

core::Result<Store> Store::open_to_read(const std::filesystem::path& file) {
  auto database = Database::open_to_read(file);
  if (!database) return tl::unexpected(database.error());
  if (auto ok = configure(*database); !ok) return tl::unexpected(ok.error());
  Store store(std::move(*database));
  if (auto ok = store.check_format(); !ok) return tl::unexpected(ok.error());
  return store;
}

// The row of a table with these texts, which is added if there is none.
core::Result<std::int64_t> Store::id_of(const char* table_sql, const char* find_sql,
                                        std::span<const std::string> texts) {
  for (const char* sql : {table_sql, find_sql}) {
    auto statement = database_.prepare(sql, kAdd);
    if (!statement) return tl::unexpected(statement.error());
    for (std::size_t i = 0; i < texts.size(); ++i)
      statement->bind(static_cast<int>(i) + 1, std::string_view(texts[i]));
    const int code = statement->step();
    if (code == SQLITE_ROW) return statement->integer(0);
    if (code != SQLITE_DONE) return database_.error(kAdd);
  }
  return database_.error(kAdd);
}

core::Result<void> Store::add_all(std::span<const Entry> entries, std::int64_t first) {
  auto job = database_.prepare("INSERT INTO jobs VALUES(?, ?, ?, ?, ?, ?)", kAdd);
  auto row = database_.prepare("INSERT INTO entries VALUES(?, ?, ?, ?, ?)", kAdd);
  if (!job || !row) return tl::unexpected((job ? row : job).error());
  std::map<std::int64_t, std::int64_t> orders;
  std::map<std::array<std::string, 2>, std::int64_t> figures;
  std::map<std::string, std::int64_t> fingerprints;
  for (const Entry& entry : entries) {
    const auto [order, is_new] =
        orders.try_emplace(entry.order, first + static_cast<std::int64_t>(orders.size()));
    if (is_new) {
      job->bind(1, order->second);
      job->bind(2, entry.test);
      job->bind(3, entry.revision);
      job->bind(4, entry.time);
      bind(*job, 5, entry.work);
      job->bind(6, entry.report);
      if (job->step() != SQLITE_DONE) return database_.error(kAdd);
      job->reset();
    }
    const std::array<std::string, 2> figure = {entry.figure, entry.unit};
    if (!figures.contains(figure)) {
      const auto id = id_of("INSERT OR IGNORE INTO figures(name, unit) VALUES(?, ?)",
                            "SELECT id FROM figures WHERE name=? AND unit=?", figure);
      if (!id) return tl::unexpected(id.error());
      figures[figure] = *id;
    }
    if (!fingerprints.contains(entry.fingerprint)) {
      const auto id =
          id_of("INSERT OR IGNORE INTO fingerprints(text) VALUES(?)",
                "SELECT id FROM fingerprints WHERE text=?", std::span(&entry.fingerprint, 1));
      if (!id) return tl::unexpected(id.error());
      fingerprints[entry.fingerprint] = *id;
    }
    row->bind(1, order->second);
    row->bind(2, figures[figure]);
    row->bind(3, fingerprints[entry.fingerprint]);
    bind(*row, 4, entry.value);
    bind(*row, 5, entry.reference);
    if (row->step() != SQLITE_DONE) return database_.error(kAdd);
    row->reset();
  }
  return {};
}

core::Result<std::int64_t> Store::add(std::span<const Entry> entries) {
  if (auto ok = check_entries(entries); !ok) return tl::unexpected(ok.error());
  if (auto ok = database_.run("BEGIN IMMEDIATE", kAdd); !ok) return tl::unexpected(ok.error());
  const auto last = number("SELECT coalesce(max(id), 0) FROM jobs");
  auto added =
      last ? add_all(entries, *last + 1) : core::Result<void>(tl::unexpected(last.error()));
  if (added) added = database_.run("COMMIT", kAdd);
  if (added) return *last + 1;
  if (database_.in_transaction()) (void)database_.run("ROLLBACK", kAdd);
  return tl::unexpected(added.error());
}

core::Result<std::vector<Entry>> Store::read() const {
  auto row = database_.prepare(
      "SELECT jobs.id, test, figures.name, unit, value, reference, revision, fingerprints.text, "
      "time, work, report FROM entries JOIN jobs ON jobs.id=job JOIN figures ON "
      "figures.id=entries.figure JOIN fingerprints ON fingerprints.id=fingerprint ORDER BY job, "
      "entries.figure",
      kRead);
  if (!row) return tl::unexpected(row.error());
  std::vector<Entry> entries;
  int code = 0;
  while ((code = row->step()) == SQLITE_ROW) {
    entries.push_back({.order = row->integer(0),
                       .test = std::string(row->text(1)),
                       .figure = std::string(row->text(2)),
                       .unit = std::string(row->text(3)),
                       .value = real_at(*row, 4),
                       .reference = real_at(*row, 5),
                       .revision = std::string(row->text(6)),
                       .fingerprint = std::string(row->text(7)),
                       .time = row->integer(8),
                       .work = real_at(*row, 9),
                       .report = std::string(row->text(10))});
  }
  if (code != SQLITE_DONE) return database_.error(kRead);
  return entries;
}

core::Result<std::int64_t> Store::rename(const std::string& test, const std::string& name) {
  if (name.empty() || name.size() > kMaxTextBytes)
    return core::invalid_argument(
        fmt::format("the new name must have 1 to {} bytes", kMaxTextBytes));
  auto update = database_.prepare("UPDATE jobs SET test=? WHERE test=?", kAdd);
  if (!update) return tl::unexpected(update.error());
  update->bind(1, name);
  update->bind(2, test);
  if (update->step() != SQLITE_DONE) return database_.error(kAdd);
  if (const std::int64_t count = sqlite3_changes64(database_.get()); count > 0) return count;
  auto names = database_.prepare("SELECT DISTINCT test FROM jobs", kRead);
  if (!names) return tl::unexpected(names.error());
  std::vector<std::string> known;
  while (names->step() == SQLITE_ROW)
    known.emplace_back(names->text(0));
  return core::invalid_argument(fmt::format("{}: the history has no test '{}'{}",
                                            database_.file().string(), core::shown(test, 200),
                                            core::suggestion(test, known)));
}

}  // namespace psygen::history
