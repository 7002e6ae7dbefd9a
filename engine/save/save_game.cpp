#include "engine/save/save_game.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "ecs/snapshot.hpp"
#include "engine/core/utf8.hpp"
#include "engine/save/adaptation.hpp"
#include "engine/save/game_tables.hpp"
#include "engine/save/save_file.hpp"
#include "engine/save/save_tables.hpp"

namespace psygen::save {
namespace {

using core::ErrorCode;

constexpr std::string_view kEntities = "entities";  // a fact

tl::unexpected<core::Error> already_there(const std::filesystem::path& file) {
  return core::fail(ErrorCode::kIo, fmt::format("{}: already exists", file.string()));
}

// The parts of the world before scatters and species were added at its end, if it then had this
// hash; else none. For saves of format 1. O(scatters · species · size of the world).
std::vector<WorldPart> parts_before_growth(world::World world, const models::Registry& registry,
                                           std::uint64_t hash) {
  for (const std::vector<models::Species> species = world.species;; world.scatter.pop_back()) {
    world.species = species;
    for (;; world.species.pop_back()) {
      WorldIdentity earlier = identity_of(world, registry);
      if (earlier.hash == hash) return std::move(earlier.parts);
      if (world.species.empty()) break;
    }
    if (world.scatter.empty()) return {};
  }
}

}  // namespace

struct SaveGame::State {
  SaveTables tables;
  CurrentWorld world;
  // The changes for the next save().
  struct Unsaved {
    UnsavedEdits edits;
    std::unordered_map<std::string, Value> values;
    std::optional<Bytes> entities;
    std::optional<std::vector<KeptEdits>> kept;
    std::optional<std::uint32_t> version;
    bool world = false;     // its identity
    bool surfaces = false;  // of all blocks with edits, where `world` is set
    bool empty() const {
      return edits.empty() && values.empty() && !entities && !kept && !version && !world;
    }
  } unsaved, opened;  // `opened`: those of open(), which discard() keeps
  GameTables game;
  std::vector<PartChange> changes;
  std::vector<Misfit> misfits;

  State(Database file, CurrentWorld current) : tables(std::move(file)), world(std::move(current)) {}
  core::Result<void> adapt_to_world(Accept accept);
  core::Result<std::uint32_t> version();
  core::Result<void> write_world();
  core::Result<void> write_all();
};

// Notes the changes of the world since the last save.
core::Result<void> SaveGame::State::adapt_to_world(Accept accept) {
  auto found = read_world(tables.database());
  if (!found) return tl::unexpected(found.error());
  WorldIdentity& now = world.identity;
  if (now.hash == found->hash && now.parts.empty()) now.parts = found->parts;
  if (*found == now) return {};
  const bool has_surfaces = !found->parts.empty();
  if (!has_surfaces && world.world)
    found->parts = parts_before_growth(*world.world, *world.registry, found->hash);
  changes = changes_between(*found, now);
  unsaved.world = true;
  const auto moves_ground = [](const PartChange& change) {
    using enum PartKind;
    return change.kind == kSeed || change.kind == kBlockSize || change.kind == kExtent ||
           change.kind == kGround || change.kind == kWater;
  };
  unsaved.surfaces = !has_surfaces || std::ranges::any_of(changes, moves_ground);
  if (found->hash == now.hash) return {};
  auto adapted = adapt(tables, *found, world, accept);
  if (!adapted) return tl::unexpected(adapted.error());
  unsaved.edits = std::move(adapted->edits);
  unsaved.kept = std::move(adapted->kept);
  misfits = std::move(adapted->misfits);
  return {};
}

// The version of the game's data in the file.
core::Result<std::uint32_t> SaveGame::State::version() {
  const auto found = tables.fact(kVersionFact);
  if (!found) return tl::unexpected(found.error());
  if (std::holds_alternative<std::monostate>(*found)) return 0;
  const auto* const number = std::get_if<std::int64_t>(&*found);
  if (number != nullptr && *number >= 0 && *number <= UINT32_MAX)
    return static_cast<std::uint32_t>(*number);
  return core::fail(ErrorCode::kParse,
                    fmt::format("{}: the version of the game's data is not a number; the file is "
                                "damaged",
                                tables.database().file().string()));
}

// Stores the identity of the world, and if the ground may have changed, the surfaces of all blocks
// that the file has edits of.
core::Result<void> SaveGame::State::write_world() {
  const WorldIdentity& identity = world.identity;
  auto ok = tables.put_fact("world name", Value(identity.name));
  if (ok) ok = tables.put_fact("world hash", Value(static_cast<std::int64_t>(identity.hash)));
  if (ok) ok = tables.put_blob("world parts", encode_parts(identity.parts));
  const bool has_changed = unsaved.surfaces || !world.world;
  if (ok && has_changed) ok = tables.forget_surfaces();
  if (!ok || !has_changed || !world.world) return ok;
  std::vector<core::BlockCoord> blocks;
  ok = tables.for_each_edits(
      [&](core::BlockCoord block, std::uint32_t, auto) { blocks.push_back(block); });
  for (const core::BlockCoord block : blocks) {
    if (ok && !unsaved.edits.contains(block) && world.world->contains(block))
      ok = tables.put_surface(block, surface_hash(*world.world, block));
  }
  return ok;
}

core::Result<void> SaveGame::State::write_all() {
  auto ok = game.begin(tables.database());
  if (ok) ok = tables.upgrade();
  if (ok && unsaved.world) ok = write_world();
  if (ok && unsaved.kept) ok = tables.replace_kept(*unsaved.kept);
  if (ok && unsaved.version)
    ok = tables.put_fact(kVersionFact, Value(std::int64_t{*unsaved.version}));
  for (const auto& [block, content] : unsaved.edits) {
    if (ok) ok = tables.put_edits(block, content);
    const bool known = content && world.world && world.world->contains(block);
    if (ok && known) ok = tables.put_surface(block, surface_hash(*world.world, block));
    if (ok && !content) ok = tables.put_surface(block, std::nullopt);
  }
  for (const auto& [name, content] : unsaved.values)
    if (ok) ok = tables.put_value(name, content);
  if (ok && unsaved.entities) ok = tables.put_blob(kEntities, *unsaved.entities);
  return ok ? tables.database().run("COMMIT", "cannot be saved") : ok;
}

core::Result<SaveGame> SaveGame::open(const std::filesystem::path& file, const WorldIdentity& world,
                                      OpenMode mode) {
  return open(file, {world}, {.mode = mode});
}

core::Result<SaveGame> SaveGame::open(const std::filesystem::path& file, const world::World& world,
                                      const models::Registry& registry, OpenOptions options) {
  world::World unedited = world;
  world::set_edits(unedited, nullptr);
  return open(file, {identity_of(world, registry), std::move(unedited), &registry}, options);
}

core::Result<SaveGame> SaveGame::open(const std::filesystem::path& file, CurrentWorld world,
                                      const OpenOptions& options) {
  std::error_code error;
  const bool exists = std::filesystem::exists(std::filesystem::symlink_status(file, error));
  if (exists && options.mode == OpenMode::kCreateNew) return already_there(file);
  if (!exists && options.mode != OpenMode::kOpenExisting) {
    const auto made = create_file(file, world.identity, options.version);
    if (!made) return tl::unexpected(made.error());
    if (!*made && options.mode == OpenMode::kCreateNew) return already_there(file);
  }
  auto database = open_file(file);
  if (!database) return tl::unexpected(database.error());
  SaveGame save(std::make_unique<State>(std::move(*database), std::move(world)));
  State& s = *save.state_;
  auto ok = s.tables.prepare();
  if (ok) ok = s.adapt_to_world(options.accept);
  s.world.registry = nullptr;  // the caller's
  if (!ok) return tl::unexpected(ok.error());
  const auto version = s.version();
  if (!version) return tl::unexpected(version.error());
  const bool has_version = s.world.world.has_value();
  if (has_version && *version > options.version)
    return core::fail(ErrorCode::kParse,
                      fmt::format("{}: a newer version of the game saved it: its data has version "
                                  "{}, this game reads up to {}",
                                  file.string(), *version, options.version));
  if (has_version && *version < options.version) {
    s.unsaved.version = options.version;
    if (options.migrate) ok = options.migrate(save, *version);
    if (!ok) return tl::unexpected(ok.error());
  }
  s.opened = s.unsaved;
  s.game.keep();
  return save;
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
  state_->unsaved.edits.insert_or_assign(block,
                                         BlockEdits{version, Bytes(bytes.begin(), bytes.end())});
  return {};
}

void SaveGame::erase_edits(core::BlockCoord block) {
  state_->unsaved.edits.insert_or_assign(block, std::nullopt);
}

core::Result<std::optional<BlockEdits>> SaveGame::edits(core::BlockCoord block) const {
  State& s = *state_;
  if (const auto unsaved = s.unsaved.edits.find(block); unsaved != s.unsaved.edits.end())
    return unsaved->second;
  return s.tables.edits(block);
}

core::Result<void> SaveGame::for_each_edits(const EditVisitor& visit) const {
  State& s = *state_;
  const auto saved = [&](core::BlockCoord block, std::uint32_t version, auto bytes) {
    if (!s.unsaved.edits.contains(block)) visit(block, version, bytes);
  };
  if (auto ok = s.tables.for_each_edits(saved); !ok) return ok;
  for (const auto& [block, content] : s.unsaved.edits)
    if (content) visit(block, content->version, content->bytes);
  return {};
}

core::Result<world::Edits> SaveGame::load_edits(const world::World& world,
                                                const models::Registry& registry) const {
  world::Edits edits;
  core::Result<void> loaded;
  auto visited = for_each_edits([&](core::BlockCoord block, std::uint32_t, auto bytes) {
    if (loaded) loaded = world::load_block(edits, world, registry, block, bytes);
  });
  if (visited && !loaded) loaded.error().message.insert(0, file().string() + ": ");
  if (visited) visited = loaded;
  if (!visited) return tl::unexpected(visited.error());
  return edits;
}

core::Result<void> SaveGame::put_changes(const world::Edits& before, const world::Edits& now) {
  for (const core::BlockCoord block : world::changed_blocks(before, now)) {
    const models::BlockEdits* const edits = now.layer() ? now.layer()->block(block) : nullptr;
    if (edits == nullptr) {
      erase_edits(block);
    } else if (auto ok = put_edits(block, world::kEditFormat, world::encode_block(*edits)); !ok) {
      return ok;
    }
  }
  return {};
}

const std::vector<PartChange>& SaveGame::world_changes() const {
  return state_->changes;
}

const std::vector<Misfit>& SaveGame::misfits() const {
  return state_->misfits;
}

core::Result<std::vector<core::BlockCoord>> SaveGame::kept_blocks() const {
  std::vector<core::BlockCoord> blocks;
  State& s = *state_;
  auto kept =
      s.unsaved.kept ? core::Result<std::vector<KeptEdits>>(*s.unsaved.kept) : s.tables.kept();
  if (!kept) return tl::unexpected(kept.error());
  for (const KeptEdits& edits : *kept)
    blocks.push_back(edits.block);
  return blocks;
}

void SaveGame::forget_kept() {
  state_->unsaved.kept.emplace();
}

core::Result<void> SaveGame::put_entities(const ecs::World& entities) {
  return put_snapshot(ecs::save_snapshot(entities));
}

core::Result<void> SaveGame::put_snapshot(Bytes bytes) {
  if (bytes.size() > kMaxSnapshotBytes)
    return core::fail(ErrorCode::kOverBudget,
                      fmt::format("the entities have {} bytes; at most {} are allowed",
                                  bytes.size(), kMaxSnapshotBytes));
  state_->unsaved.entities = std::move(bytes);
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
  return s.unsaved.entities ? use(*s.unsaved.entities) : s.tables.with_fact(kEntities, use);
}

core::Result<void> SaveGame::put_value(std::string_view name, Value value) {
  if (name.empty() || name.size() > kMaxNameBytes)
    return core::fail(ErrorCode::kInvalidArgument,
                      fmt::format("the name of a value has {} bytes; it must have 1 to {}",
                                  name.size(), kMaxNameBytes));
  if (auto ok = check_value(value, fmt::format("value '{}'", core::shown(name))); !ok) return ok;
  state_->unsaved.values.insert_or_assign(std::string(name), std::move(value));
  return {};
}

core::Result<Value> SaveGame::value(std::string_view name) const {
  State& s = *state_;
  if (const auto unsaved = s.unsaved.values.find(std::string(name));
      unsaved != s.unsaved.values.end())
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
  s.unsaved = s.opened = {};
  s.game.forget();
  return {};
}

void SaveGame::discard() {
  State& s = *state_;
  Database& database = s.tables.database();
  if (database.in_transaction()) (void)database.run("ROLLBACK", "cannot be changed");
  s.unsaved = s.opened;
  s.game.rewind();
}

bool SaveGame::has_unsaved() const {
  return !state_->unsaved.empty() || state_->game.has_changes();
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
