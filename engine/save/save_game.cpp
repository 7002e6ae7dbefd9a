#include "engine/save/save_game.hpp"

#include <fmt/format.h>

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

// Blocks with nothing in place of edits are to be erased.
using UnsavedEdits =
    std::unordered_map<core::BlockCoord, std::optional<BlockEdits>, core::BlockCoordHash>;

}  // namespace

struct SaveGame::State {
  Database database;
  Statement put_edits, erase_edits, get_edits, each_edits, put_value, erase_value, get_value,
      put_fact, get_fact;
  // What save() will write.
  UnsavedEdits edits;
  std::unordered_map<std::string, Value> values;
  std::optional<Bytes> entities;
  GameTables tables;

  explicit State(Database opened) : database(std::move(opened)) {}
  ~State() {
    for (Statement* s : {&put_edits, &erase_edits, &get_edits, &each_edits, &put_value,
                         &erase_value, &get_value, &put_fact, &get_fact})
      *s = Statement();
    close_file(database);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  core::Result<void> prepare();
  core::Result<void> finish(Statement& statement);
  core::Result<void> write_edits();
  core::Result<void> write_values();
  core::Result<void> write_all();
  tl::unexpected<core::Error> damaged(std::string_view what) const;
  core::Result<void> check_row(const Statement& row, core::BlockCoord block, int first) const;
};

namespace {

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

core::Result<void> SaveGame::State::prepare() {
  const std::pair<Statement*, const char*> all[] = {
      {&put_edits, "INSERT OR REPLACE INTO psygen_edits VALUES(?, ?, ?, ?, ?)"},
      {&erase_edits, "DELETE FROM psygen_edits WHERE x = ? AND z = ?"},
      {&get_edits, "SELECT version, checksum, bytes FROM psygen_edits WHERE x = ? AND z = ?"},
      {&each_edits, "SELECT version, checksum, bytes, x, z FROM psygen_edits"},
      {&put_value, "INSERT OR REPLACE INTO psygen_values VALUES(?, ?, ?)"},
      {&erase_value, "DELETE FROM psygen_values WHERE name = ?"},
      {&get_value, "SELECT checksum, value FROM psygen_values WHERE name = ?"},
      {&put_fact, "INSERT OR REPLACE INTO psygen_facts VALUES(?, ?)"},
      {&get_fact, "SELECT value FROM psygen_facts WHERE name = ?"}};
  for (const auto& [statement, sql] : all) {
    auto prepared = database.prepare(sql, "cannot be read");
    if (!prepared) return tl::unexpected(prepared.error());
    *statement = std::move(*prepared);
  }
  return {};
}

// Runs a statement without rows.
core::Result<void> SaveGame::State::finish(Statement& statement) {
  const int code = statement.step();
  core::Result<void> result;
  if (code != SQLITE_DONE) result = database.error("cannot be saved");
  statement.reset();
  return result;
}

tl::unexpected<core::Error> SaveGame::State::damaged(std::string_view what) const {
  return core::fail(ErrorCode::kParse,
                    fmt::format("{}: {}; the file is damaged", database.file().string(), what));
}

// A row of edits whose columns version, checksum and bytes begin at `first`.
core::Result<void> SaveGame::State::check_row(const Statement& row, core::BlockCoord block,
                                              int first) const {
  const std::int64_t version = row.integer(first);
  const auto bytes = row.bytes(first + 2);
  if (version >= 0 && version <= UINT32_MAX && bytes.size() <= kMaxEditBytes &&
      checksum_of(block, static_cast<std::uint32_t>(version), bytes) == row.integer(first + 1))
    return {};
  return damaged(
      fmt::format("the edits of block ({}, {}) do not match their checksum", block.x, block.z));
}

core::Result<void> SaveGame::State::write_edits() {
  for (const auto& [block, content] : edits) {
    Statement& statement = content ? put_edits : erase_edits;
    statement.bind(1, std::int64_t{block.x});
    statement.bind(2, std::int64_t{block.z});
    if (content) {
      statement.bind(3, std::int64_t{content->version});
      statement.bind(4, checksum_of(block, content->version, content->bytes));
      statement.bind(5, std::span<const std::byte>(content->bytes));
    }
    if (auto ok = finish(statement); !ok) return ok;
  }
  return {};
}

core::Result<void> SaveGame::State::write_values() {
  for (const auto& [name, content] : values) {
    const bool erased = std::holds_alternative<std::monostate>(content);
    Statement& statement = erased ? erase_value : put_value;
    statement.bind(1, std::string_view(name));
    if (!erased) {
      statement.bind(2, checksum_of(name, content));
      statement.bind(3, content);
    }
    if (auto ok = finish(statement); !ok) return ok;
  }
  return {};
}

core::Result<void> SaveGame::State::write_all() {
  if (auto ok = tables.begin(database); !ok) return ok;
  if (auto ok = write_edits(); !ok) return ok;
  if (auto ok = write_values(); !ok) return ok;
  if (entities) {
    put_fact.bind(1, std::string_view("entities"));
    put_fact.bind(2, std::span<const std::byte>(*entities));
    if (auto ok = finish(put_fact); !ok) return ok;
  }
  return database.run("COMMIT", "cannot be saved");
}

core::Result<SaveGame> SaveGame::open(const std::filesystem::path& file, const WorldIdentity& world,
                                      OpenMode mode) {
  std::error_code error;
  const bool exists = std::filesystem::exists(std::filesystem::symlink_status(file, error));
  if (exists && mode == OpenMode::kCreateNew)
    return core::fail(ErrorCode::kIo, fmt::format("{}: is already there", file.string()));
  if (!exists && mode != OpenMode::kOpenExisting) {
    if (auto made = create_file(file, world); !made) return tl::unexpected(made.error());
  }
  auto database = open_file(file);
  if (!database) return tl::unexpected(database.error());
  auto state = std::make_unique<State>(std::move(*database));
  const auto found = read_world(state->database);
  if (!found) return tl::unexpected(found.error());
  if (*found != world)
    return core::fail(
        ErrorCode::kInvalidArgument,
        fmt::format(
            "{}: belongs to the world '{}' with hash {:016x}, not to '{}' with hash {:016x}",
            file.string(), core::shown(found->name, 80), found->hash, core::shown(world.name, 80),
            world.hash));
  if (auto ok = state->prepare(); !ok) return tl::unexpected(ok.error());
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
  const Reset reset(s.get_edits);
  s.get_edits.bind(1, std::int64_t{block.x});
  s.get_edits.bind(2, std::int64_t{block.z});
  const int code = s.get_edits.step();
  if (code == SQLITE_DONE) return std::optional<BlockEdits>();
  if (code != SQLITE_ROW) return s.database.error("cannot be read");
  if (auto ok = s.check_row(s.get_edits, block, 0); !ok) return tl::unexpected(ok.error());
  const auto bytes = s.get_edits.bytes(2);
  return BlockEdits{static_cast<std::uint32_t>(s.get_edits.integer(0)),
                    Bytes(bytes.begin(), bytes.end())};
}

core::Result<void> SaveGame::for_each_edits(const EditVisitor& visit) const {
  State& s = *state_;
  {
    const Reset reset(s.each_edits);
    int code = s.each_edits.step();
    for (; code == SQLITE_ROW; code = s.each_edits.step()) {
      const std::int64_t x = s.each_edits.integer(3), z = s.each_edits.integer(4);
      const core::BlockCoord block{static_cast<std::int32_t>(x), static_cast<std::int32_t>(z)};
      if (x != block.x || z != block.z) return s.damaged("has edits outside of any block");
      if (auto ok = s.check_row(s.each_edits, block, 0); !ok) return ok;
      if (!s.edits.contains(block))
        visit(block, static_cast<std::uint32_t>(s.each_edits.integer(0)), s.each_edits.bytes(2));
    }
    if (code != SQLITE_DONE) return s.database.error("cannot be read");
  }
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
  const auto tell = [&](const ecs::SnapshotResult& loaded) -> core::Result<bool> {
    if (loaded) return true;
    return core::fail(ErrorCode::kParse, fmt::format("{}: the entities cannot be loaded: {}",
                                                     file().string(), loaded.sentence));
  };
  if (s.entities) return tell(load(*s.entities));
  const Reset reset(s.get_fact);
  s.get_fact.bind(1, std::string_view("entities"));
  const int code = s.get_fact.step();
  if (code == SQLITE_DONE) return false;
  if (code != SQLITE_ROW) return s.database.error("cannot be read");
  if (!s.get_fact.is(0, SQLITE_BLOB)) return s.damaged("the entities are not bytes");
  return tell(load(s.get_fact.bytes(0)));
}

core::Result<void> SaveGame::put_value(std::string_view name, Value value) {
  if (name.empty() || name.size() > kMaxNameBytes)
    return core::fail(ErrorCode::kInvalidArgument,
                      fmt::format("the name of a value has {} bytes; 1 to {} are allowed",
                                  name.size(), kMaxNameBytes));
  if (auto ok = check_value(value, fmt::format("value '{}'", core::shown(name))); !ok) return ok;
  state_->values.insert_or_assign(std::string(name), std::move(value));
  return {};
}

core::Result<Value> SaveGame::value(std::string_view name) const {
  State& s = *state_;
  if (const auto unsaved = s.values.find(std::string(name)); unsaved != s.values.end())
    return unsaved->second;
  const Reset reset(s.get_value);
  s.get_value.bind(1, name);
  const int code = s.get_value.step();
  if (code == SQLITE_DONE) return Value();
  if (code != SQLITE_ROW) return s.database.error("cannot be read");
  Value found = s.get_value.value(1);
  if (checksum_of(name, found) != s.get_value.integer(0))
    return s.damaged(fmt::format("the value '{}' does not match its checksum", core::shown(name)));
  return found;
}

core::Result<void> SaveGame::execute(std::string_view sql, const std::vector<Value>& values) {
  return state_->tables.execute(state_->database, sql, values);
}

core::Result<Rows> SaveGame::query(std::string_view sql, const std::vector<Value>& values) const {
  return state_->tables.query(state_->database, sql, values);
}

core::Result<void> SaveGame::save() {
  if (!has_unsaved()) return {};
  State& s = *state_;
  if (auto written = s.write_all(); !written) {
    if (s.database.in_transaction()) (void)s.database.run("ROLLBACK", "cannot be saved");
    written.error().message += "; the file holds the last save, and nothing unsaved is lost";
    return written;
  }
  s.tables.forget();
  discard();
  return {};
}

void SaveGame::discard() {
  State& s = *state_;
  if (s.database.in_transaction()) (void)s.database.run("ROLLBACK", "cannot be changed");
  s.edits.clear();
  s.values.clear();
  s.entities.reset();
  s.tables.forget();
}

bool SaveGame::has_unsaved() const {
  const State& s = *state_;
  return !s.edits.empty() || !s.values.empty() || s.entities || s.tables.has_changes();
}

const std::filesystem::path& SaveGame::file() const {
  return state_->database.file();
}

core::Result<WorldIdentity> world_of(const std::filesystem::path& file) {
  auto database = open_file(file);
  if (!database) return tl::unexpected(database.error());
  auto world = read_world(*database);
  close_file(*database);
  return world;
}

}  // namespace psygen::save
