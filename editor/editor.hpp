// The whole editor as a function, so that a program can use it with its own model types:
//   int main(int argc, char** argv) { return psygen::editor::run(argc, argv, {my_plugin}); }
#pragma once

#include <vector>

#include "engine/app/options.hpp"

namespace psygen::editor {

// Opens the editor's window and returns the exit code after it is closed: 0, 1 for failures, 2 for
// usage errors, 4 without an X11 display, like psygen's commands. Plugins add model types,
// components and systems to every session.
int run(int argc, char** argv, std::vector<app::Plugin> plugins = {});

}  // namespace psygen::editor
