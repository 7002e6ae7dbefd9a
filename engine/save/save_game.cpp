#include "engine/save/save_game.hpp"

#include <fmt/format.h>

#include <unordered_map>

#include "ecs/snapshot.hpp"
#include "engine/core/utf8.hpp"
#include "engine/save/game_tables.hpp"
#include "engine/save/save_file.hpp"
#include "engine/save/save_tables.hpp"

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

}  // namespace

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
