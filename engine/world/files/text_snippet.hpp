// Parts of world files that go from one place or file to another: copied values and sections, and
// presets in files. A snippet is TOML with the header of its table, as table_text() returns it:
// "[sky]\nexposure = 2\n". It does not know what values mean (world_file.hpp reads the result).
// Pure functions, any thread.
#pragma once

#include <string>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/world/files/text_path.hpp"

namespace psygen::world {

inline constexpr int kPresetFormat = 1;  // version of preset files

// The value, table or item at `path` as a snippet. Fails with kInvalidArgument where the text has
// none: what is not set cannot be copied.
core::Result<std::string> copied_snippet(std::string_view text, const TextPath& path);

// The text with the keys of a snippet in the table at `path`; other keys of that table stay. Of the
// tables in it, arrays ([[species.kind]]) replace those of the table, and others are merged. The
// snippet's table must have the name of that at `path`, or be keys without a header. The table may
// be missing, the item of an array may not.
core::Result<std::string> with_snippet(std::string_view text, const TextPath& path,
                                       std::string_view snippet);

// Where a snippet belongs: the keys of its first header, "species", "kind". Empty for keys without
// a header. Fails with kParse where it is not TOML.
core::Result<TextPath> snippet_table(std::string_view snippet);

// A preset file: a snippet, behind a line that says so. And the snippet of such a file. Fails with
// kParse for other files and newer versions; messages name the file.
std::string preset_text(std::string_view snippet);
core::Result<std::string> read_preset(std::string_view text, std::string_view file_name);

}  // namespace psygen::world
