// A saved game: one SQLite file with the edits of a world, the game's entities, and what the game
// keeps itself. Changes are collected in memory; save() writes all of them at once. Not the edits'
// meaning (that is whoever encodes them) and not the world, which stays in its own file.
//
// Safety. save() is one transaction with a rollback journal: the pages that change are copied to
// FILE-journal and flushed (fsync) before the first of them is overwritten; the new pages are
// flushed; then the journal is made invalid and flushed. A process that is killed, or a machine
// that loses power, at any moment leaves the old state or the new one. A journal, unlike a
// write-ahead log, leaves a single file when the save is closed. After a crash FILE-journal belongs
// to the file until it is opened again. Every blob has a checksum.
//
// A save is locked while it is open. One thread at a time; it may be another one each time. save()
// waits for the disk: a game that must not miss a frame calls it where a pause is allowed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "ecs/snapshot.hpp"
#include "ecs/world.hpp"
#include "engine/core/coordinates.hpp"
#include "engine/core/error.hpp"
#include "engine/save/value.hpp"
#include "engine/save/world_identity.hpp"

namespace psygen::save {

inline constexpr std::uint32_t kSaveFormat = 1;                      // version of the file format
inline constexpr std::size_t kMaxEditBytes = std::size_t{16} << 20;  // of one block
inline constexpr std::size_t kMaxSnapshotBytes = std::size_t{900} << 20;  // of the entities
inline constexpr std::size_t kMaxNameBytes = 256;                         // of a value

// What open() does with files that exist and that do not.
enum class OpenMode : std::uint8_t { kOpenOrCreate, kOpenExisting, kCreateNew };

// The edits of one block, encoded by the owner of the edits. `version` is the encoding's.
struct BlockEdits {
  std::uint32_t version = 0;
  Bytes bytes;
};

// Called with a block, the version of its encoding, and its bytes, which live until it returns.
using EditVisitor =
    std::function<void(core::BlockCoord, std::uint32_t, std::span<const std::byte>)>;

class SaveGame {
 public:
  // Opens a save of this world, or makes an empty one. Rolls back what a crash left unfinished, and
  // checks the whole file. Fails with a sentence and leaves the file as it was: kParse (not a save,
  // damaged, or of a newer version), kInvalidArgument (of another world), kIo (missing folder or
  // file, read-only, in use by another process, already there with kCreateNew), kOutOfMemory.
  // O(bytes of the file).
  static core::Result<SaveGame> open(const std::filesystem::path& file, const WorldIdentity& world,
                                     OpenMode mode = OpenMode::kOpenOrCreate);
  // Gives the lock back. What was not saved is lost.
  ~SaveGame();
  SaveGame(SaveGame&&) noexcept;
  SaveGame& operator=(SaveGame&&) noexcept;

  // Replaces the edits of a block, at the next save(). No bytes are edits too. Fails with
  // kOverBudget above kMaxEditBytes. O(bytes), without touching the file.
  core::Result<void> put_edits(core::BlockCoord block, std::uint32_t version,
                               std::span<const std::byte> bytes);
  // Removes the edits of a block, at the next save(). O(1).
  void erase_edits(core::BlockCoord block);
  // The edits of a block as put last, saved or not; empty if it has none. Fails with kParse where
  // the file is damaged, and with kIo. O(bytes).
  core::Result<std::optional<BlockEdits>> edits(core::BlockCoord block) const;
  // Visits all blocks with edits, in no particular order. The visitor must not use this object.
  // Fails as edits(), perhaps after some visits.
  core::Result<void> for_each_edits(const EditVisitor& visit) const;

  // Takes a snapshot of the world's entities (ecs/snapshot.hpp) for the next save(). Fails with
  // kOverBudget above kMaxSnapshotBytes.
  core::Result<void> put_entities(const ecs::World& entities);
  // The same of the entities that have C alone: those of the game in the world of a scene.
  template <ecs::Component C>
  core::Result<void> put_entities_with(const ecs::World& entities) {
    return put_snapshot(ecs::save_snapshot_of<C>(entities));
  }
  // Fills a world that never had an entity. False if the save has no entities. Fails with kParse,
  // and the sentence of load_snapshot(), where the snapshot does not fit; the world is then as it
  // was.
  core::Result<bool> load_entities(ecs::World& entities) const;
  // The same for a world that may have others; the entities get new handles (append_snapshot()).
  core::Result<bool> append_entities(ecs::World& entities) const;

  // Stores a value under a name of 1 to kMaxNameBytes bytes, at the next save(). No value removes
  // the name. Fails with kInvalidArgument (name, NaN) or kOverBudget (kMaxValueBytes).
  core::Result<void> put_value(std::string_view name, Value value);
  // The value as put last; std::monostate if there is none. Fails as edits().
  core::Result<Value> value(std::string_view name) const;

  // Runs one SQL statement that changes the game's own tables, whose names begin with "game_";
  // `values` stand for its question marks. The change is visible to query() at once and in the file
  // from the next save() on. Statements that failed saves have taken back run again, so one that
  // asks for the time or a random number may then give another. Fails with kInvalidArgument (SQL,
  // another table), kIo or kParse. https://www.sqlite.org/lang.html. The game's own tables have no
  // checksums.
  core::Result<void> execute(std::string_view sql, const std::vector<Value>& values = {});
  // Runs one SELECT on the game's own tables. Fails as execute().
  core::Result<Rows> query(std::string_view sql, const std::vector<Value>& values = {}) const;

  // Writes everything since the last save() in one transaction, and waits for the disk. After an
  // error the file holds the last save, nothing unsaved is lost, and save() may be tried again.
  // Fails with kIo (a full disk among others), kParse or kOutOfMemory. O(changes).
  core::Result<void> save();
  // Forgets everything since the last save().
  void discard();
  // Whether there is anything to save.
  bool has_unsaved() const;

  // The file, as given to open().
  const std::filesystem::path& file() const;

 private:
  struct State;
  explicit SaveGame(std::unique_ptr<State> state);
  core::Result<void> put_snapshot(Bytes bytes);
  // Calls f with the snapshot, if there is one.
  core::Result<bool> with_snapshot(
      const std::function<ecs::SnapshotResult(std::span<const std::byte>)>& load) const;
  std::unique_ptr<State> state_;
};

// Which world a save belongs to, for lists of saves. Fails as SaveGame::open().
core::Result<WorldIdentity> world_of(const std::filesystem::path& file);

}  // namespace psygen::save
