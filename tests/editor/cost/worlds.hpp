// A small world for tests of costs.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "editor/document/parsed_world.hpp"
#include "engine/world/files/text_edit.hpp"

namespace psygen::editor {

inline constexpr const char* kCostedWorld = R"(format = 1

[world]
name = "costed"
seed = 5
blocks = [64, 64]
block_vertices = 32

[[scatter]]
model = "tree"
count = 6

[[scatter]]
model = "rock"
count = 5
)";

// The world with one other value.
inline ParsedWorldPtr costed_with(const world::TextPath& path, const std::string& toml) {
  const auto text = world::with_value(kCostedWorld, path, toml);
  EXPECT_TRUE(text.has_value());
  const auto parsed = parse_world_text(*text, "costed.toml", {});
  EXPECT_TRUE(parsed.has_value()) << (parsed ? "" : parsed.error().message);
  return *parsed;
}
inline ParsedWorldPtr costed() {
  return costed_with({"world", "seed"}, "5");
}

}  // namespace psygen::editor
