// A saved game: one SQLite file with the edits of a world, the game's entities, and values of the
// game. Changes are collected in memory; save() writes all of them at once. It does not store the
// world, which has its own file. It interprets edits only when the world has changed since.
//
// Safety. save() is one transaction with a rollback journal: the old contents of changed pages are
// copied to FILE-journal and flushed (fsync) before the first page is overwritten; the new pages
// are flushed; then the journal is invalidated and flushed. If the process is killed or the machine
// loses power at any moment, the file has the old state or the new one. Unlike a write-ahead log, a
// journal leaves a single file when the save is closed. After a crash FILE-journal belongs to the
// file until it is opened again. Every blob has a checksum.
//
// A save is locked while it is open. One thread at a time, not always the same one. save() waits
// for the disk: a game that must not miss a frame calls it when a pause is acceptable.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ecs/snapshot.hpp"
#include "ecs/world.hpp"
#include "engine/core/coordinates.hpp"
#include "engine/core/error.hpp"
#include "engine/save/value.hpp"
#include "engine/save/world_identity.hpp"
#include "engine/world/edits/edit_bytes.hpp"

namespace psygen::save {

// Version of the file format. Files of format 1, which name no parts of their world, are read too;
// the next save() makes them files of this format.
inline constexpr std::uint32_t kSaveFormat = 2;
inline constexpr std::size_t kMaxEditBytes = std::size_t{16} << 20;  // edits of one block
inline constexpr std::size_t kMaxSnapshotBytes = std::size_t{900}
                                                 << 20;  // snapshot of the entities
inline constexpr std::size_t kMaxNameBytes = 256;        // name of a value

// Determines whether open() accepts existing and missing files.
enum class OpenMode : std::uint8_t { kOpenOrCreate, kOpenExisting, kCreateNew };

// The encoded edits of one block. `version` is the version of the encoding.
struct BlockEdits {
  std::uint32_t version = 0;
  Bytes bytes;
};

// The worlds in which open() accepts a save whose edits depend on parts that have changed since.
enum class Accept : std::uint8_t {
  kSameWorld,     // none: changes that touch edits are an error
  kChangedWorld,  // the same seed
  kAnyWorld
};

// Edits of one block that do not fit into the world, for one reason.
struct Misfit {
  core::BlockCoord block;
  std::optional<world::EditKind> kind;  // nothing: a block that this program cannot read
  std::uint32_t count = 1;
  std::string reason;
};

class SaveGame;
struct CurrentWorld;  // private (adaptation.hpp)

// Changes entities, values and tables of an older version of the game, which it gets, into those of
// this version. An error is the error of open().
using Migration = std::function<core::Result<void>(SaveGame&, std::uint32_t)>;

struct OpenOptions {
  OpenMode mode = OpenMode::kOpenOrCreate;
  Accept accept = Accept::kSameWorld;
  std::uint32_t version = 0;  // of the game's own data; new saves get it
  Migration migrate = {};     // called if the save has an older version
};

// Called with a block, the version of its encoding, and its bytes, which are valid during the call.
using EditVisitor =
    std::function<void(core::BlockCoord, std::uint32_t, std::span<const std::byte>)>;

class SaveGame {
 public:
  // Opens a save of this world, or creates an empty one. Rolls back an unfinished transaction after
  // a crash, and checks the whole file. A world may have changed in parts on which no edit in the
  // file depends (docs/saves.md): the next save() stores its new identity. Fails with a message and
  // leaves the file unchanged: kParse (not a save, damaged, or of a newer version),
  // kInvalidArgument (other changes, which it names), kIo (missing folder or file, read-only, in
  // use by another process, already existing with kCreateNew), kOutOfMemory. O(bytes of the file).
  //
  // OpenOptions::accept allows the other changes. Edits that do not fit are then listed in
  // misfits() and taken out of edits(); the next save() keeps them aside in the file. When a later
  // world has what they need, open() returns them to their blocks. Placed models of missing types
  // stay in edits(), because world::load_block() keeps them hidden.
  //
  // A save has the version of the options with which it was last saved, or 0. open() fails with
  // kParse for a newer one.
  static core::Result<SaveGame> open(const std::filesystem::path& file, const world::World& world,
                                     const models::Registry& registry, OpenOptions options = {});
  // The same for edits that the engine does not read, or without a world: judges ground, water
  // and extent as a whole, accepts no changes that touch edits, and ignores versions.
  static core::Result<SaveGame> open(const std::filesystem::path& file, const WorldIdentity& world,
                                     OpenMode mode = OpenMode::kOpenOrCreate);
  // Releases the lock. Unsaved changes are lost.
  ~SaveGame();
  SaveGame(SaveGame&&) noexcept;
  SaveGame& operator=(SaveGame&&) noexcept;

  // Replaces the edits of a block at the next save(). Empty bytes count as edits. Fails with
  // kOverBudget above kMaxEditBytes. O(bytes), without access to the file.
  core::Result<void> put_edits(core::BlockCoord block, std::uint32_t version,
                               std::span<const std::byte> bytes);
  // Removes the edits of a block, at the next save(). O(1).
  void erase_edits(core::BlockCoord block);
  // The latest edits of a block, saved or not; empty if it has none. Fails with kParse if the file
  // is damaged, and with kIo. O(bytes).
  core::Result<std::optional<BlockEdits>> edits(core::BlockCoord block) const;
  // Visits all blocks with edits, in no particular order. The visitor must not use this object.
  // Fails like edits(), perhaps after some visits.
  core::Result<void> for_each_edits(const EditVisitor& visit) const;

  // All edits, in memory. Fails like for_each_edits() and world::load_block().
  core::Result<world::Edits> load_edits(const world::World& world,
                                        const models::Registry& registry) const;
  // Puts the edits of the blocks in which `now` differs from `before`. Fails like put_edits().
  core::Result<void> put_changes(const world::Edits& before, const world::Edits& now);

  // The parts in which the world differs from that of the last save, also harmless ones; and the
  // edits that do not fit into it. As open() found them.
  const std::vector<PartChange>& world_changes() const;
  const std::vector<Misfit>& misfits() const;
  // The blocks with edits that are kept aside, in no particular order. Fails like edits().
  core::Result<std::vector<core::BlockCoord>> kept_blocks() const;
  // Removes all edits that are kept aside, at the next save().
  void forget_kept();

  // Takes a snapshot of the world's entities (ecs/snapshot.hpp) for the next save(). Fails with
  // kOverBudget above kMaxSnapshotBytes.
  core::Result<void> put_entities(const ecs::World& entities);
  // The same for the entities that have C only: those of the game in the world of a scene.
  template <ecs::Component C>
  core::Result<void> put_entities_with(const ecs::World& entities) {
    return put_snapshot(ecs::save_snapshot_of<C>(entities));
  }
  // Fills a world that never had an entity. Returns false if the save has no entities. Fails with
  // kParse and the message of load_snapshot() if the snapshot does not fit; the world is then
  // unchanged.
  core::Result<bool> load_entities(ecs::World& entities) const;
  // The same for a world that may have entities; the loaded ones get new handles
  // (append_snapshot()).
  core::Result<bool> append_entities(ecs::World& entities) const;

  // Stores a value under a name of 1 to kMaxNameBytes bytes at the next save(). std::monostate
  // removes the name. Fails with kInvalidArgument (name, NaN) or kOverBudget (kMaxValueBytes).
  core::Result<void> put_value(std::string_view name, Value value);
  // The latest value; std::monostate if there is none. Fails like edits().
  core::Result<Value> value(std::string_view name) const;

  // Runs one SQL statement that changes the game's own tables, whose names begin with "game_";
  // `values` replace its question marks. query() sees the change at once; the file has it after the
  // next save(). After a failed save the statements run again, so one that uses the time or a
  // random number may then give another result. Fails with kInvalidArgument (SQL, another table),
  // kIo or kParse. https://www.sqlite.org/lang.html. The game's own tables have no checksums.
  core::Result<void> execute(std::string_view sql, const std::vector<Value>& values = {});
  // Runs one SELECT on the game's own tables. Fails like execute().
  core::Result<Rows> query(std::string_view sql, const std::vector<Value>& values = {}) const;

  // Writes everything since the last save() in one transaction, and waits for the disk. After an
  // error the file has the last save, no unsaved change is lost, and save() may be called again.
  // Fails with kIo (such as a full disk), kParse or kOutOfMemory. O(changes).
  core::Result<void> save();
  // Discards everything since the last save(), or since open().
  void discard();
  // True if there is anything to save.
  bool has_unsaved() const;

  // The file, as given to open().
  const std::filesystem::path& file() const;

 private:
  struct State;
  explicit SaveGame(std::unique_ptr<State> state);
  static core::Result<SaveGame> open(const std::filesystem::path& file, CurrentWorld world,
                                     const OpenOptions& options);
  core::Result<void> put_snapshot(Bytes bytes);
  // Calls f with the snapshot, if there is one.
  core::Result<bool> with_snapshot(
      const std::function<ecs::SnapshotResult(std::span<const std::byte>)>& load) const;
  std::unique_ptr<State> state_;
};

// The world of a save, for lists of saves. Reads a few pages without a lock, so it also works while
// the save is open, in this process or another, and for read-only files. It does not check the rest
// of the file. Fails with kParse (not a save, of a newer version, damaged, or being written) and
// kIo. O(1).
core::Result<WorldIdentity> world_of(const std::filesystem::path& file);

}  // namespace psygen::save
