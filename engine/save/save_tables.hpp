// The tables of a save: one edit, value or fact at a time, with its checksum. SaveGame keeps
// unsaved changes; save_file.hpp handles the file as a whole. Private to engine/save. One thread.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "engine/save/database.hpp"
#include "engine/save/save_game.hpp"

namespace psygen::save {

class SaveTables {
 public:
  // Owns a file of open_file(). Call prepare() before all other functions.
  explicit SaveTables(Database opened) : database_(std::move(opened)) {}
  // Releases the lock.
  ~SaveTables();
  SaveTables(const SaveTables&) = delete;
  SaveTables& operator=(const SaveTables&) = delete;

  Database& database() { return database_; }
  // All functions fail with kParse if the file is damaged, else like Database::error().
  core::Result<void> prepare();

  // Values in the file; nothing, std::monostate or false if it has none.
  core::Result<std::optional<BlockEdits>> edits(core::BlockCoord block);
  core::Result<void> for_each_edits(const EditVisitor& visit);
  core::Result<Value> value(std::string_view name);
  // Calls use() with the bytes of a fact, which are valid during the call.
  core::Result<bool> with_fact(
      std::string_view name,
      const std::function<core::Result<bool>(std::span<const std::byte>)>& use);

  // Call inside a transaction. std::nullopt and std::monostate erase.
  core::Result<void> put_edits(core::BlockCoord block, const std::optional<BlockEdits>& edits);
  core::Result<void> put_value(std::string_view name, const Value& value);
  core::Result<void> put_fact(std::string_view name, std::span<const std::byte> bytes);

 private:
  core::Result<void> finish(Statement& statement);
  core::Result<void> check_row(const Statement& row, core::BlockCoord block) const;
  tl::unexpected<core::Error> damaged(std::string_view what) const;

  Database database_;
  Statement put_edits_, erase_edits_, get_edits_, each_edits_, put_value_, erase_value_, get_value_,
      put_fact_, get_fact_;
};

}  // namespace psygen::save
