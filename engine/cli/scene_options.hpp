// The options that all commands share which draw a world: which world, how large, how finely, with
// what. Each is told in one place, so that it means the same everywhere.
#pragma once

#include <CLI/CLI.hpp>

#include "engine/app/options.hpp"

namespace psygen::cli {

// `options` outlives the command; what it holds now are the defaults.
void add_scene_options(CLI::App& command, app::SessionOptions& options);

}  // namespace psygen::cli
