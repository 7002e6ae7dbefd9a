// Changes one value or table of a TOML text and leaves everything else as it is, byte for byte:
// comments, order, indentation. It does not know what a world may contain (world_file.hpp reads the
// result), only the usual order of sections. Safe for hostile texts: whatever is returned parses.
// Pure functions, any thread; linear in the text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/world/files/text_path.hpp"

namespace psygen::world {

// All functions fail with kParse where `text` is not TOML, naming its line, and with
// kInvalidArgument where the path or what is written there does not fit, naming the path.

// The text with another value at `path`, written as TOML (toml_values.hpp). A key that is not there
// is added at the end of its table, and a missing table in the usual order of sections. A comment
// behind the value stays. Tables written with headers are not values.
core::Result<std::string> with_value(std::string_view text, const TextPath& path,
                                     std::string_view toml_value);
// The text without a value: its lines, with the comment behind it, or its place in an array or
// inline table. Where there is no value at `path`, the text itself.
core::Result<std::string> without_value(std::string_view text, const TextPath& path);
// The value as it is written, or nothing where there is none.
std::optional<std::string> value_text(std::string_view text, const TextPath& path);

// The text with one more table at the end of an array of tables ("scatter", or species[0].kind).
// `table_text` is lines "key = value", or a whole table with its headers as table_text() returns
// it.
core::Result<std::string> with_table_appended(std::string_view text, const TextPath& array,
                                              std::string_view table_text);
// The text without a table and the tables in it, and without the comment lines directly above.
// Where there is no table at `path`, the text itself.
core::Result<std::string> without_table(std::string_view text, const TextPath& path);
// The text with a copy of an item of an array of tables directly behind it.
core::Result<std::string> with_table_duplicated(std::string_view text, const TextPath& item);
// The text with an item of an array of tables moved to another index of the same array.
core::Result<std::string> with_table_moved(std::string_view text, const TextPath& item,
                                           std::size_t to);
// The text with all values of `keys`, lines "key = value" of one table without headers, set in the
// table at `path`. Other keys of the table stay.
core::Result<std::string> with_values(std::string_view text, const TextPath& path,
                                      std::string_view keys);
// A table with the tables in it and the comments between, or nothing where there is no header of
// this path.
std::optional<std::string> table_text(std::string_view text, const TextPath& path);
// How many items the array at `path` has; 0 where there is none.
std::size_t item_count(std::string_view text, const TextPath& path);

}  // namespace psygen::world
