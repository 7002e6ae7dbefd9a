// Values of a save as parameters and columns of SQLite's statements. Private to engine/save.
#pragma once

#include "engine/save/value.hpp"
#include "engine/sqlite/database.hpp"

namespace psygen::save {

// Saves use these by their plain names.
using sqlite::absolute_path;
using sqlite::Database;
using sqlite::Statement;

// Binds a value to a parameter. Texts and bytes are not copied and must live until the next
// reset().
void bind_value(Statement& statement, int index, const Value& value);
// The content of a column, with its type.
Value value_of(const Statement& statement, int column);

}  // namespace psygen::save
