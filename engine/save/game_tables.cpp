#include "engine/save/game_tables.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/utf8.hpp"
#include "engine/save/save_file.hpp"

namespace psygen::save {
namespace {

using core::ErrorCode;

// Compares names as SQLite does.
bool starts_with(std::string_view name, std::string_view prefix) {
  return name.size() >= prefix.size() &&
         sqlite3_strnicmp(name.data(), prefix.data(), static_cast<int>(prefix.size())) == 0;
}

// Decides which SQL the game may run. SQLite calls it for each part of a statement that it
// prepares.
int authorise(void* names_changed, int action, const char* first, const char* second,
              const char* /*schema*/, const char* /*trigger*/) {
  const auto game = [](const char* name) { return name != nullptr && is_game_table(name); };
  const auto decide = [](bool ok) { return ok ? SQLITE_OK : SQLITE_DENY; };
  switch (action) {
    case SQLITE_SELECT:
    case SQLITE_FUNCTION:
    case SQLITE_RECURSIVE:
      return SQLITE_OK;
    case SQLITE_READ:  // also reads while creating a table, and tables without a name
      return decide(first == nullptr || !starts_with(first, "psygen_"));
    case SQLITE_INSERT:
    case SQLITE_UPDATE:
    case SQLITE_DELETE:  // creating writes to the list of tables; direct writes are impossible
      return decide(game(first) || starts_with(first, "sqlite_"));
    case SQLITE_CREATE_TABLE:  // AUTOINCREMENT makes a table of SQLite's own
    case SQLITE_DROP_TABLE:
      return decide(game(first) || starts_with(first, "sqlite_"));
    case SQLITE_ALTER_TABLE:  // perhaps to a foreign name, which the statement does not tell here
      *static_cast<bool*>(names_changed) = true;
      return decide(game(second));
    case SQLITE_CREATE_INDEX:
    case SQLITE_DROP_INDEX:  // an index that a constraint makes has a name of SQLite's
      return decide(game(second) && (game(first) || starts_with(first, "sqlite_")));
    case SQLITE_REINDEX:
      return decide(game(first));
    default:  // transactions, pragmas, other files, views, triggers, virtual tables
      return SQLITE_DENY;
  }
}

// Restricts statements that are prepared during its lifetime.
class Restriction {
 public:
  explicit Restriction(const Database& database) : database_(database.get()) {
    sqlite3_set_authorizer(database_, authorise, &names_changed_);
  }
  ~Restriction() { sqlite3_set_authorizer(database_, nullptr, nullptr); }
  Restriction(const Restriction&) = delete;
  Restriction& operator=(const Restriction&) = delete;
  // True if a statement may have renamed something.
  bool names_changed() const { return names_changed_; }

 private:
  sqlite3* database_;
  bool names_changed_ = false;
};

tl::unexpected<core::Error> refuse(std::string_view sql, std::string_view reason) {
  return core::fail(ErrorCode::kInvalidArgument,
                    fmt::format("SQL \"{}\": {}", core::shown(sql, 120), reason));
}

core::Result<Statement> prepare(Database& database, std::string_view sql,
                                const std::vector<Value>& values) {
  if (sql.size() > std::size_t{1} << 20) return refuse(sql, "is longer than 1 MiB");
  sqlite3_stmt* raw = nullptr;
  const char* rest = nullptr;
  const int code =
      sqlite3_prepare_v2(database.get(), sql.data(), static_cast<int>(sql.size()), &raw, &rest);
  Statement statement(raw);
  if (code == SQLITE_AUTH)
    return refuse(sql, "only tables and indices whose names begin with game_ may be used (" +
                           core::shown(sqlite3_errmsg(database.get()), 120) + ")");
  if (code != SQLITE_OK) return refuse(sql, core::shown(sqlite3_errmsg(database.get()), 200));
  if (!statement) return refuse(sql, "is empty");
  const std::string_view left(rest, static_cast<std::size_t>(sql.data() + sql.size() - rest));
  if (left.find_first_not_of(" \t\r\n;") != std::string_view::npos)
    return refuse(sql, "has more than one statement");
  if (static_cast<std::size_t>(sqlite3_bind_parameter_count(raw)) != values.size())
    return refuse(sql, fmt::format("has {} parameters but was given {} values",
                                   sqlite3_bind_parameter_count(raw), values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (auto ok = check_value(values[i], "SQL"); !ok) return tl::unexpected(ok.error());
    bind_value(statement, static_cast<int>(i) + 1, values[i]);
  }
  return statement;
}

// A failed step: an error of the file or of the statement.
tl::unexpected<core::Error> step_error(const Database& database, std::string_view sql) {
  switch (sqlite3_errcode(database.get()) & 0xFF) {
    case SQLITE_FULL:
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
    case SQLITE_CORRUPT:
    case SQLITE_NOMEM:
      return database.error("a statement of the game failed");
    default:
      return refuse(sql, core::shown(sqlite3_errmsg(database.get()), 200));
  }
}

core::Result<void> run_one(Database& database, std::string_view sql,
                           const std::vector<Value>& values) {
  const Restriction restriction(database);
  auto statement = prepare(database, sql, values);
  if (!statement) return tl::unexpected(statement.error());
  int code = SQLITE_ROW;
  while (code == SQLITE_ROW)
    code = statement->step();
  if (code != SQLITE_DONE) return step_error(database, sql);
  if (restriction.names_changed() && !check_tables(database))
    return refuse(sql, "gives a name that does not begin with game_");
  return {};
}

}  // namespace

bool is_game_table(std::string_view name) {
  return starts_with(name, "game_");
}

core::Result<void> GameTables::begin(Database& database) const {
  if (database.in_transaction()) return {};
  if (auto ok = database.run("BEGIN IMMEDIATE", "cannot be changed"); !ok) return ok;
  for (const Change& change : log_) {
    if (auto ok = run_one(database, change.sql, change.values); !ok) {
      (void)database.run("ROLLBACK", "cannot be changed");
      return ok;
    }
  }
  return {};
}

core::Result<void> GameTables::execute(Database& database, std::string_view sql,
                                       const std::vector<Value>& values) {
  if (auto ok = begin(database); !ok) return ok;
  if (auto ok = database.run("SAVEPOINT statement", "cannot be changed"); !ok) return ok;
  if (auto done = run_one(database, sql, values); !done) {
    if (database.in_transaction())
      (void)database.run("ROLLBACK TO statement; RELEASE statement", "cannot be changed");
    return done;
  }
  log_.push_back({std::string(sql), values});
  return database.run("RELEASE statement", "cannot be changed");
}

core::Result<Rows> GameTables::query(Database& database, std::string_view sql,
                                     const std::vector<Value>& values) const {
  if (has_changes()) {
    if (auto ok = begin(database); !ok) return tl::unexpected(ok.error());
  }
  const Restriction restriction(database);
  auto statement = prepare(database, sql, values);
  if (!statement) return tl::unexpected(statement.error());
  if (sqlite3_stmt_readonly(statement->get()) == 0)
    return refuse(sql, "changes the save; pass it to execute()");
  Rows result;
  const int columns = sqlite3_column_count(statement->get());
  for (int c = 0; c < columns; ++c)
    result.columns.emplace_back(sqlite3_column_name(statement->get(), c));
  int code = statement->step();
  for (; code == SQLITE_ROW; code = statement->step()) {
    std::vector<Value>& row = result.rows.emplace_back();
    for (int c = 0; c < columns; ++c)
      row.push_back(value_of(*statement, c));
  }
  if (code != SQLITE_DONE) return step_error(database, sql);
  return result;
}

}  // namespace psygen::save
