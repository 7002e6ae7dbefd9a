// The folders of the project's own world and path files, and small files for tests.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/assert.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/world.hpp"
#include "tests/source_file.hpp"

namespace psygen::world::testing {

inline std::filesystem::path game_file(const std::string& name) {
  return std::filesystem::path(source_file("game")) / name;
}

inline std::string shipped_text(const std::string& name) {
  std::ifstream stream(game_file(name), std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

// Name and text of every world, by name.
inline std::vector<std::pair<std::string, std::string>> shipped_worlds() {
  std::vector<std::pair<std::string, std::string>> worlds;
  for (const auto& entry : std::filesystem::directory_iterator(game_file("worlds"))) {
    if (entry.path().extension() != ".toml") continue;
    const std::string name = entry.path().filename().string();
    worlds.emplace_back(name, shipped_text("worlds/" + name));
  }
  std::ranges::sort(worlds);
  return worlds;
}

inline const models::Registry& registry() {
  static const models::Registry standard = models::make_standard_registry();
  return standard;
}

inline constexpr const char* kSmallWorld = R"(format = 1

[world]
name = "small"
seed = 5
blocks = [8, 4]
cell_m = 2
block_vertices = 33

[terrain]
octaves = 4
relief_m = 60

[[scatter]]
model = "tree"
count = 3
iterations = [2, 3]
size_m = [1.5, 2.5]

[[scatter]]
model = "rock"
count = 5
subdivisions = 1
)";

inline World parsed(std::string_view text) {
  auto world = parse_world(text, "test.toml", registry());
  if (!world) std::fprintf(stderr, "%s\n", world.error().message.c_str());
  PSYGEN_CHECK(world.has_value(), "the world of the test is sound");
  return *world;
}

// `text` with the first occurrence of `from` replaced.
inline std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  PSYGEN_CHECK(at != std::string::npos, "the text has what is to be replaced");
  return text.replace(at, from.size(), to);
}

}  // namespace psygen::world::testing
