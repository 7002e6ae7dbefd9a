// SQL of the game on its own tables in the save file. Names of these tables and indices begin with
// "game_"; other tables are out of reach. Changes belong to the open transaction and are logged, so
// that they can be repeated after a failed save. Private to engine/save. One thread at a time.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/save/bound_value.hpp"
#include "engine/save/value.hpp"

namespace psygen::save {

// True if a table or index of this name belongs to the game.
bool is_game_table(std::string_view name);

class GameTables {
 public:
  // Runs one statement that changes tables or their rows, completely or not at all. Fails with
  // kInvalidArgument for wrong SQL, forbidden names and wrong numbers of values.
  core::Result<void> execute(Database& database, std::string_view sql,
                             const std::vector<Value>& values);
  // Runs one statement that only reads. Fails like execute().
  core::Result<Rows> query(Database& database, std::string_view sql,
                           const std::vector<Value>& values) const;
  // Opens a transaction, unless one is open, and repeats in it everything executed since forget().
  core::Result<void> begin(Database& database) const;
  // Keeps everything executed so far at rewind(), which forgets what was executed later.
  void keep() { kept_ = log_.size(); }
  void rewind() { log_.resize(kept_); }
  // True if anything was executed since forget().
  bool has_changes() const { return !log_.empty(); }
  // Clears the log, after the changes were saved or discarded.
  void forget() {
    log_.clear();
    kept_ = 0;
  }

 private:
  struct Change {
    std::string sql;
    std::vector<Value> values;
  };
  std::vector<Change> log_;
  std::size_t kept_ = 0;
};

}  // namespace psygen::save
