#include "engine/save/save_game.hpp"

#include <fmt/format.h>

#include <type_traits>
#include <unordered_map>

#include "ecs/snapshot.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/utf8.hpp"
#include "engine/save/database.hpp"
#include "engine/save/game_tables.hpp"
#include "engine/save/save_file.hpp"

namespace psygen::save {
namespace {

using core::ErrorCode;

constexpr std::string_view kEntities = "entities";

// A block without a value is to be erased.
using UnsavedEdits =
    std::unordered_map<core::BlockCoord, std::optional<BlockEdits>, core::BlockCoordHash>;

tl::unexpected<core::Error> already_there(const std::filesystem::path& file) {
  return core::fail(ErrorCode::kIo, fmt::format("{}: already exists", file.string()));
}

std::int64_t checksum_of(core::BlockCoord block, std::uint32_t version,
                         std::span<const std::byte> bytes) {
  const std::uint64_t place = core::BlockCoordHash{}(block);
  return static_cast<std::int64_t>(core::hash_bytes(bytes, core::combine(place, version)));
}

std::int64_t checksum_of(std::string_view name, const Value& value) {
  const std::uint64_t seed =
      core::combine(core::hash_bytes(std::as_bytes(std::span(name))), value.index());
  const auto hash = [&](const auto& content) -> std::uint64_t {
    using Content = std::decay_t<decltype(content)>;
    if constexpr (std::is_same_v<Content, std::string> || std::is_same_v<Content, Bytes>) {
      return core::hash_bytes(std::as_bytes(std::span(content)), seed);
    } else {
      return core::hash_bytes(std::as_bytes(std::span(&content, 1)), seed);
    }
  };
  return static_cast<std::int64_t>(std::visit(hash, value));
}

// Resets a statement at the end of a scope.
class Reset {
 public:
  explicit Reset(Statement& statement) : statement_(statement) {}
  ~Reset() { statement_.reset(); }
  Reset(const Reset&) = delete;
  Reset& operator=(const Reset&) = delete;

 private:
  Statement& statement_;
};

}  // namespace

// The tables of a save: one edit, value or fact at a time, with its checksum. SaveGame keeps
// unsaved changes; save_file.hpp handles the file as a whole.
class SaveTables {
 public:
  // Owns a file of open_file(). Call prepare() before all other functions.
  explicit SaveTables(Database opened) : database_(std::move(opened)) {}
  // Releases the lock.
  ~SaveTables() {
    for (Statement* s : {&put_edits_, &erase_edits_, &get_edits_, &each_edits_, &put_value_,
                         &erase_value_, &get_value_, &put_fact_, &get_fact_})
      *s = Statement();
    close_file(database_);
  }

  SaveTables(const SaveTables&) = delete;
  SaveTables& operator=(const SaveTables&) = delete;
  Database& database() { return database_; }

  // All functions fail with kParse if the file is damaged, else like Database::error().
  core::Result<void> prepare() {
    const std::pair<Statement*, const char*> all[] = {
        {&put_edits_, "INSERT OR REPLACE INTO psygen_edits VALUES(?, ?, ?, ?, ?)"},
        {&erase_edits_, "DELETE FROM psygen_edits WHERE x = ? AND z = ?"},
        {&get_edits_, "SELECT version, checksum, bytes FROM psygen_edits WHERE x = ? AND z = ?"},
        {&each_edits_, "SELECT version, checksum, bytes, x, z FROM psygen_edits"},
        {&put_value_, "INSERT OR REPLACE INTO psygen_values VALUES(?, ?, ?)"},
        {&erase_value_, "DELETE FROM psygen_values WHERE name = ?"},
        {&get_value_, "SELECT checksum, value FROM psygen_values WHERE name = ?"},
        {&put_fact_, "INSERT OR REPLACE INTO psygen_facts VALUES(?, ?)"},
        {&get_fact_, "SELECT value FROM psygen_facts WHERE name = ?"}};
    for (const auto& [statement, sql] : all) {
      auto prepared = database_.prepare(sql, "cannot be read");
      if (!prepared) return tl::unexpected(prepared.error());
      *statement = std::move(*prepared);
    }
    return {};
  }

  // Values in the file; nothing, std::monostate or false if it has none.
  core::Result<std::optional<BlockEdits>> edits(core::BlockCoord block) {
    const Reset reset(get_edits_);
    get_edits_.bind(1, std::int64_t{block.x});
    get_edits_.bind(2, std::int64_t{block.z});
    const int code = get_edits_.step();
    if (code == SQLITE_DONE) return std::optional<BlockEdits>();
    if (code != SQLITE_ROW) return database_.error("cannot be read");
    if (auto ok = check_row(get_edits_, block); !ok) return tl::unexpected(ok.error());
    const auto bytes = get_edits_.bytes(2);
    return BlockEdits{static_cast<std::uint32_t>(get_edits_.integer(0)),
                      Bytes(bytes.begin(), bytes.end())};
  }

  core::Result<void> for_each_edits(const EditVisitor& visit) {
    const Reset reset(each_edits_);
    int code = each_edits_.step();
    for (; code == SQLITE_ROW; code = each_edits_.step()) {
      const std::int64_t x = each_edits_.integer(3), z = each_edits_.integer(4);
      const core::BlockCoord block{static_cast<std::int32_t>(x), static_cast<std::int32_t>(z)};
      if (x != block.x || z != block.z) return damaged("has edits outside of any block");
      if (auto ok = check_row(each_edits_, block); !ok) return ok;
      visit(block, static_cast<std::uint32_t>(each_edits_.integer(0)), each_edits_.bytes(2));
    }
    if (code != SQLITE_DONE) return database_.error("cannot be read");
    return {};
  }

  core::Result<Value> value(std::string_view name) {
    const Reset reset(get_value_);
    get_value_.bind(1, name);
    const int code = get_value_.step();
    if (code == SQLITE_DONE) return Value();
    if (code != SQLITE_ROW) return database_.error("cannot be read");
    Value found = get_value_.value(1);
    if (checksum_of(name, found) != get_value_.integer(0))
      return damaged(fmt::format("the value '{}' does not match its checksum", core::shown(name)));
    return found;
  }

  // Calls use() with the bytes of a fact, which are valid during the call.
  core::Result<bool> with_fact(
      std::string_view name,
      const std::function<core::Result<bool>(std::span<const std::byte>)>& use) {
    const Reset reset(get_fact_);
    get_fact_.bind(1, name);
    const int code = get_fact_.step();
    if (code == SQLITE_DONE) return false;
    if (code != SQLITE_ROW) return database_.error("cannot be read");
    if (!get_fact_.is(0, SQLITE_BLOB)) return damaged(fmt::format("the {} are not bytes", name));
    return use(get_fact_.bytes(0));
  }

  // Call inside a transaction. std::nullopt and std::monostate erase.
  core::Result<void> put_edits(core::BlockCoord block, const std::optional<BlockEdits>& edits) {
    Statement& statement = edits ? put_edits_ : erase_edits_;
    statement.bind(1, std::int64_t{block.x});
    statement.bind(2, std::int64_t{block.z});
    if (edits) {
      statement.bind(3, std::int64_t{edits->version});
      statement.bind(4, checksum_of(block, edits->version, edits->bytes));
      statement.bind(5, std::span<const std::byte>(edits->bytes));
    }
    return finish(statement);
  }

  core::Result<void> put_value(std::string_view name, const Value& value) {
    const bool erased = std::holds_alternative<std::monostate>(value);
    Statement& statement = erased ? erase_value_ : put_value_;
    statement.bind(1, name);
    if (!erased) {
      statement.bind(2, checksum_of(name, value));
      statement.bind(3, value);
    }
    return finish(statement);
  }

  core::Result<void> put_fact(std::string_view name, std::span<const std::byte> bytes) {
    put_fact_.bind(1, name);
    put_fact_.bind(2, bytes);
    return finish(put_fact_);
  }

 private:
  // Runs a statement without rows.
  core::Result<void> finish(Statement& statement) {
    const int code = statement.step();
    core::Result<void> result;
    if (code != SQLITE_DONE) result = database_.error("cannot be saved");
    statement.reset();
    return result;
  }

  tl::unexpected<core::Error> damaged(std::string_view what) const {
    return core::fail(core::ErrorCode::kParse,
                      fmt::format("{}: {}; the file is damaged", database_.file().string(), what));
  }

  // Checks a row that begins with version, checksum and bytes.
  core::Result<void> check_row(const Statement& row, core::BlockCoord block) const {
    const std::int64_t version = row.integer(0);
    const auto bytes = row.bytes(2);
    if (version >= 0 && version <= UINT32_MAX && bytes.size() <= kMaxEditBytes &&
        checksum_of(block, static_cast<std::uint32_t>(version), bytes) == row.integer(1))
      return {};
    return damaged(
        fmt::format("the edits of block ({}, {}) do not match their checksum", block.x, block.z));
  }

  Database database_;
  Statement put_edits_, erase_edits_, get_edits_, each_edits_, put_value_, erase_value_, get_value_,
      put_fact_, get_fact_;
};

struct SaveGame::State {
  SaveTables tables;
  // The changes for the next save().
  UnsavedEdits edits;
  std::unordered_map<std::string, Value> values;
  std::optional<Bytes> entities;
  GameTables game;

  explicit State(Database opened) : tables(std::move(opened)) {}
  core::Result<void> write_all();
};

core::Result<void> SaveGame::State::write_all() {
  if (auto ok = game.begin(tables.database()); !ok) return ok;
  for (const auto& [block, content] : edits)
    if (auto ok = tables.put_edits(block, content); !ok) return ok;
  for (const auto& [name, content] : values)
    if (auto ok = tables.put_value(name, content); !ok) return ok;
  if (entities)
    if (auto ok = tables.put_fact(kEntities, *entities); !ok) return ok;
  return tables.database().run("COMMIT", "cannot be saved");
}

core::Result<SaveGame> SaveGame::open(const std::filesystem::path& file, const WorldIdentity& world,
                                      OpenMode mode) {
  std::error_code error;
  const bool exists = std::filesystem::exists(std::filesystem::symlink_status(file, error));
  if (exists && mode == OpenMode::kCreateNew) return already_there(file);
  if (!exists && mode != OpenMode::kOpenExisting) {
    const auto made = create_file(file, world);
    if (!made) return tl::unexpected(made.error());
    if (!*made && mode == OpenMode::kCreateNew) return already_there(file);
  }
  auto database = open_file(file);
  if (!database) return tl::unexpected(database.error());
  auto state = std::make_unique<State>(std::move(*database));
  const auto found = read_world(state->tables.database());
  if (!found) return tl::unexpected(found.error());
  if (found->hash != world.hash)
    return core::fail(
        ErrorCode::kInvalidArgument,
        fmt::format(
            "{}: belongs to the world '{}' with hash {:016x}, not to '{}' with hash {:016x}",
            file.string(), core::shown(found->name, 80), found->hash, core::shown(world.name, 80),
            world.hash));
  if (auto ok = state->tables.prepare(); !ok) return tl::unexpected(ok.error());
  return SaveGame(std::move(state));
}

SaveGame::SaveGame(std::unique_ptr<State> state) : state_(std::move(state)) {}
SaveGame::~SaveGame() = default;
SaveGame::SaveGame(SaveGame&&) noexcept = default;
SaveGame& SaveGame::operator=(SaveGame&&) noexcept = default;

core::Result<void> SaveGame::put_edits(core::BlockCoord block, std::uint32_t version,
                                       std::span<const std::byte> bytes) {
  if (bytes.size() > kMaxEditBytes)
    return core::fail(
        ErrorCode::kOverBudget,
        fmt::format("the edits of block ({}, {}) have {} bytes; at most {} are allowed", block.x,
                    block.z, bytes.size(), kMaxEditBytes));
  state_->edits.insert_or_assign(block, BlockEdits{version, Bytes(bytes.begin(), bytes.end())});
  return {};
}

void SaveGame::erase_edits(core::BlockCoord block) {
  state_->edits.insert_or_assign(block, std::nullopt);
}

core::Result<std::optional<BlockEdits>> SaveGame::edits(core::BlockCoord block) const {
  State& s = *state_;
  if (const auto unsaved = s.edits.find(block); unsaved != s.edits.end()) return unsaved->second;
  return s.tables.edits(block);
}

core::Result<void> SaveGame::for_each_edits(const EditVisitor& visit) const {
  State& s = *state_;
  const auto saved = [&](core::BlockCoord block, std::uint32_t version, auto bytes) {
    if (!s.edits.contains(block)) visit(block, version, bytes);
  };
  if (auto ok = s.tables.for_each_edits(saved); !ok) return ok;
  for (const auto& [block, content] : s.edits)
    if (content) visit(block, content->version, content->bytes);
  return {};
}

core::Result<void> SaveGame::put_entities(const ecs::World& entities) {
  return put_snapshot(ecs::save_snapshot(entities));
}

core::Result<void> SaveGame::put_snapshot(Bytes bytes) {
  if (bytes.size() > kMaxSnapshotBytes)
    return core::fail(ErrorCode::kOverBudget,
                      fmt::format("the entities have {} bytes; at most {} are allowed",
                                  bytes.size(), kMaxSnapshotBytes));
  state_->entities = std::move(bytes);
  return {};
}

core::Result<bool> SaveGame::load_entities(ecs::World& entities) const {
  return with_snapshot([&](auto bytes) { return ecs::load_snapshot(bytes, entities); });
}

core::Result<bool> SaveGame::append_entities(ecs::World& entities) const {
  return with_snapshot([&](auto bytes) { return ecs::append_snapshot(bytes, entities); });
}

core::Result<bool> SaveGame::with_snapshot(
    const std::function<ecs::SnapshotResult(std::span<const std::byte>)>& load) const {
  State& s = *state_;
  const auto use = [&](std::span<const std::byte> bytes) -> core::Result<bool> {
    const ecs::SnapshotResult loaded = load(bytes);
    if (loaded) return true;
    return core::fail(ErrorCode::kParse, fmt::format("{}: the entities cannot be loaded: {}",
                                                     file().string(), loaded.sentence));
  };
  return s.entities ? use(*s.entities) : s.tables.with_fact(kEntities, use);
}

core::Result<void> SaveGame::put_value(std::string_view name, Value value) {
  if (name.empty() || name.size() > kMaxNameBytes)
    return core::fail(ErrorCode::kInvalidArgument,
                      fmt::format("the name of a value has {} bytes; it must have 1 to {}",
                                  name.size(), kMaxNameBytes));
  if (auto ok = check_value(value, fmt::format("value '{}'", core::shown(name))); !ok) return ok;
  state_->values.insert_or_assign(std::string(name), std::move(value));
  return {};
}

core::Result<Value> SaveGame::value(std::string_view name) const {
  State& s = *state_;
  if (const auto unsaved = s.values.find(std::string(name)); unsaved != s.values.end())
    return unsaved->second;
  return s.tables.value(name);
}

core::Result<void> SaveGame::execute(std::string_view sql, const std::vector<Value>& values) {
  return state_->game.execute(state_->tables.database(), sql, values);
}

core::Result<Rows> SaveGame::query(std::string_view sql, const std::vector<Value>& values) const {
  return state_->game.query(state_->tables.database(), sql, values);
}

core::Result<void> SaveGame::save() {
  if (!has_unsaved()) return {};
  State& s = *state_;
  if (auto written = s.write_all(); !written) {
    Database& database = s.tables.database();
    if (database.in_transaction()) (void)database.run("ROLLBACK", "cannot be saved");
    written.error().message += "; the file keeps the last save";
    return written;
  }
  discard();
  return {};
}

void SaveGame::discard() {
  State& s = *state_;
  Database& database = s.tables.database();
  if (database.in_transaction()) (void)database.run("ROLLBACK", "cannot be changed");
  s.edits.clear();
  s.values.clear();
  s.entities.reset();
  s.game.forget();
}

bool SaveGame::has_unsaved() const {
  const State& s = *state_;
  return !s.edits.empty() || !s.values.empty() || s.entities || s.game.has_changes();
}

const std::filesystem::path& SaveGame::file() const {
  return state_->tables.database().file();
}

core::Result<WorldIdentity> world_of(const std::filesystem::path& file) {
  const auto database = open_to_look(file);
  if (!database) return tl::unexpected(database.error());
  return read_world(*database);
}

}  // namespace psygen::save
