// The shipped worlds and presets, for tests.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/world/files/text_file.hpp"
#include "tests/source_file.hpp"

namespace psygen::editor::testing {

inline std::string world_text(const std::string& name) {
  return *world::read_text_file(source_file("game/worlds/" + name + ".toml"));
}

inline std::vector<std::string> shipped_worlds() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(source_file("game/worlds")))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  return names;
}

}  // namespace psygen::editor::testing
