// The presets in files: those that come with psygen (share/psygen/library) and a person's own. A
// folder of the library is a heading. Reads files; draws nothing and edits no document. Main
// thread.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::editor {

// One preset that can be read.
struct Preset {
  std::string heading;  // "Species"
  std::string name;     // "Silver birch"
  std::string doc;      // the first comment line of the file, without '#'; may be empty
  std::string table;    // "species", "scatter", "terrain", "sky"
  std::string snippet;  // text_snippet.hpp
  std::filesystem::path file;
};

// The folders "library" of the data folders and, last, that of the person.
std::vector<std::filesystem::path> library_folders();
// The person's own presets; the folder need not exist.
std::filesystem::path own_library_folder();

// All presets of these folders: species, rocks, grasses, terrains, skies, others, each by name, own
// ones ("Mine") last. Files that are no
// presets are left out and named in `problems` (may be null).
std::vector<Preset> load_library(const std::vector<std::filesystem::path>& folders,
                                 std::vector<std::string>* problems = nullptr);

// The world text with a preset: a species is added, under a free name, together with a scatter of
// it, so that it is seen; a scatter is added; other tables take the preset's values. Fails like the
// functions of text_edit.hpp.
core::Result<std::string> with_preset(std::string_view text, const Preset& preset);

}  // namespace psygen::editor
