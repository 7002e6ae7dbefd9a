// Changes one value or table of a TOML text and keeps everything else byte for byte: comments,
// order, indentation. It knows only the usual order of sections, not their contents (world_file.hpp
// reads the result). Safe for hostile texts: every returned text parses. Pure functions, any
// thread; linear in the text.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/world/files/text_path.hpp"

namespace psygen::world {

// All functions fail with kParse, naming the line, if `text` is not TOML, and with
// kInvalidArgument, naming the path, if the path or the new text does not fit.

// The text with another value at `path`, written as TOML (toml_values.hpp). A missing key is added
// at the end of its table, and a missing table in the usual order of sections. A comment behind the
// value stays. Tables with headers are not values.
core::Result<std::string> with_value(std::string_view text, const TextPath& path,
                                     std::string_view toml_value);
// The text with this value at every path that `which` accepts and that has a value. Reads the text
// once, however many paths there are.
core::Result<std::string> with_each_value(std::string_view text,
                                          const std::function<bool(const TextPath&)>& which,
                                          std::string_view toml_value);
// The text without a value: removes its lines and the comment behind it, or its entry in an array
// or inline table. Returns the text unchanged if there is no value at `path`.
core::Result<std::string> without_value(std::string_view text, const TextPath& path);
// The value as the text writes it, or nothing if it is missing.
std::optional<std::string> value_text(std::string_view text, const TextPath& path);

// The text with one more table at the end of an array of tables ("scatter", or species[0].kind).
// `table_text` has lines "key = value", or is a whole table with headers as table_text() returns
// it.
core::Result<std::string> with_table_appended(std::string_view text, const TextPath& array,
                                              std::string_view table_text);
// The text without a table, the tables in it and the comment lines directly above. Returns the text
// unchanged if there is no table at `path`.
core::Result<std::string> without_table(std::string_view text, const TextPath& path);
// The text with a copy of an item of an array of tables directly behind it.
core::Result<std::string> with_table_duplicated(std::string_view text, const TextPath& item);
// The text with an item of an array of tables moved to another index of the same array.
core::Result<std::string> with_table_moved(std::string_view text, const TextPath& item,
                                           std::size_t to);
// A table with the tables in it and the comments between them, or nothing if no header has this
// path.
std::optional<std::string> table_text(std::string_view text, const TextPath& path);
// The number of items of the array at `path`; 0 if there is no such array.
std::size_t item_count(std::string_view text, const TextPath& path);

}  // namespace psygen::world
