// The library of preset files: those of psygen (share/psygen/library) and the user's own ones. Each
// folder of the library is a heading. Reads files; draws nothing and edits no document. Main
// thread.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::editor {

// One preset.
struct Preset {
  std::string heading;  // "Species"
  std::string name;     // "Silver birch"
  std::string doc;      // the first comment line of the file, without '#'; may be empty
  std::string table;    // "species", "scatter", "terrain", "sky"
  std::string snippet;  // text_snippet.hpp
  std::filesystem::path file;
};

// The folders "library" of the data folders and, last, the user's own one.
std::vector<std::filesystem::path> library_folders();
// The folder of the user's own presets, which need not exist.
std::filesystem::path own_library_folder();

// All presets of these folders: species, rocks, grasses, terrains, skies and others, each sorted by
// name; own ones ("Mine") are last. Skips invalid files and appends their errors to `problems`,
// which may be null.
std::vector<Preset> load_library(const std::vector<std::filesystem::path>& folders,
                                 std::vector<std::string>* problems = nullptr);

// Returns the world text with a preset: adds a species under a free name together with a scatter of
// it, adds a scatter, or sets the preset's values in other tables. Fails like the functions of
// text_edit.hpp.
core::Result<std::string> with_preset(std::string_view text, const Preset& preset);

}  // namespace psygen::editor
