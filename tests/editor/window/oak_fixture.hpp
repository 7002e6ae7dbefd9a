// An editor's window with a small world, to which the oak of the library was added.
#pragma once

#include <iterator>

#include "engine/world/files/text_snippet.hpp"
#include "tests/editor/window/window_fixture.hpp"
#include "tests/source_file.hpp"

namespace psygen::editor {

class OakInWindow : public EditorWindow {
 protected:
  std::string world_text() override {
    std::ifstream in(source_file("editor/library/species/oak.toml"));
    const std::string preset{std::istreambuf_iterator<char>(in), {}};
    const auto species = world::read_preset(preset, "oak.toml");
    EXPECT_TRUE(species.has_value());
    return std::string(kSmallWorld) + "\n" + *species +
           "\n[[scatter]]\nmodel = \"oak\"\ncount = 8\n";
  }
};

}  // namespace psygen::editor
