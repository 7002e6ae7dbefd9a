// Copies parts of world files between places and files: values and sections on the clipboard, and
// presets in files. A snippet is TOML with the header of its table, as table_text() returns it:
// "[sky]\nexposure = 2\n". It does not know the meaning of values (world_file.hpp reads the
// result). Pure functions, any thread.
#pragma once

#include <string>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/world/files/text_path.hpp"

namespace psygen::world {

inline constexpr int kPresetFormat = 1;  // version of preset files

// The value, table or item at `path` as a snippet. Fails with kInvalidArgument if the text has
// none: a default value cannot be copied.
core::Result<std::string> copied_snippet(std::string_view text, const TextPath& path);

// The text with the keys of a snippet in the table at `path`; other keys of that table stay. Arrays
// of tables in the snippet ([[species.kind]]) replace those of the table; other tables are merged.
// The snippet's table must have the name of the table at `path`, or be keys without a header. The
// table at `path` may be missing, an item of an array may not.
core::Result<std::string> with_snippet(std::string_view text, const TextPath& path,
                                       std::string_view snippet);

// The keys of a snippet's first header: "species", "kind". Empty for keys without a header. Fails
// with kParse if the snippet is not TOML.
core::Result<TextPath> snippet_table(std::string_view snippet);

// Writes a preset file: a line that identifies it, then the snippet. And reads the snippet of such
// a file; fails with kParse for other files and newer versions, naming the file.
std::string preset_text(std::string_view snippet);
core::Result<std::string> read_preset(std::string_view text, std::string_view file_name);

}  // namespace psygen::world
