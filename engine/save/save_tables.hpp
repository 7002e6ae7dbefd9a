// The tables of a save: one edit, value or fact at a time, with its checksum. SaveGame keeps
// unsaved changes; save_file.hpp handles the file as a whole. Private to engine/save. One thread at
// a time.
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/core/error.hpp"
#include "engine/save/bound_value.hpp"
#include "engine/save/save_game.hpp"

namespace psygen::save {

// Edits by block; a block without a value is to be erased.
using UnsavedEdits =
    std::unordered_map<core::BlockCoord, std::optional<BlockEdits>, core::BlockCoordHash>;

// Edits of a block that did not fit into a later world, and the world that they were made in.
struct KeptEdits {
  core::BlockCoord block;
  WorldIdentity world;  // without its name
  BlockEdits edits;
};

// All functions fail with kParse if the file is damaged, else like Database::error().
class SaveTables {
 public:
  // Owns a file of open_file(). Call prepare() before all other functions.
  explicit SaveTables(Database opened) : database_(std::move(opened)) {}
  // Releases the lock.
  ~SaveTables();
  SaveTables(const SaveTables&) = delete;
  SaveTables& operator=(const SaveTables&) = delete;

  // The file; and the preparation of all statements.
  Database& database() { return database_; }
  core::Result<void> prepare();

  // Values in the file; nothing, std::monostate or false if it has none.
  core::Result<std::optional<BlockEdits>> edits(core::BlockCoord block);
  core::Result<void> for_each_edits(const EditVisitor& visit);
  core::Result<Value> value(std::string_view name);
  core::Result<Value> fact(std::string_view name);
  // Calls use() with the bytes of a fact, which are valid during the call.
  core::Result<bool> with_fact(
      std::string_view name,
      const std::function<core::Result<bool>(std::span<const std::byte>)>& use);
  // The hash of the surface of a block when its edits were saved (adaptation.hpp); files of format
  // 1 have none.
  core::Result<std::optional<std::uint64_t>> surface(core::BlockCoord block);
  core::Result<std::vector<KeptEdits>> kept();

  // Call inside a transaction. std::nullopt and std::monostate erase.
  core::Result<void> upgrade();  // to the newest format, before other changes
  core::Result<void> put_edits(core::BlockCoord block, const std::optional<BlockEdits>& edits);
  core::Result<void> put_value(std::string_view name, const Value& value);
  core::Result<void> put_fact(std::string_view name, const Value& value);
  core::Result<void> put_blob(std::string_view name, std::span<const std::byte> bytes);  // a fact
  core::Result<void> put_surface(core::BlockCoord block, std::optional<std::uint64_t> hash);
  core::Result<void> forget_surfaces();
  core::Result<void> replace_kept(const std::vector<KeptEdits>& all);

 private:
  struct Prepared {
    Statement& statement;
    const char* sql;
  };
  core::Result<void> prepare(std::initializer_list<Prepared> all);
  core::Result<void> prepare_newest();
  core::Result<void> finish(Statement& statement);
  tl::unexpected<core::Error> damaged(std::string_view what) const;
  core::Result<core::BlockCoord> block_of(std::int64_t x, std::int64_t z) const;
  core::Result<void> check_row(const Statement& row, core::BlockCoord block) const;

  Database database_;
  Statement put_edits_, erase_edits_, get_edits_, each_edits_, put_value_, erase_value_, get_value_,
      put_fact_, get_fact_;
  // Of format 2, null in files of format 1:
  Statement put_surface_, erase_surface_, erase_surfaces_, get_surface_, put_kept_, erase_kept_,
      each_kept_;
};

}  // namespace psygen::save
