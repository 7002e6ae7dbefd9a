// Options shared by all commands that draw a world: world, size, detail, device. Each is declared
// once, so that it has the same meaning everywhere.
#pragma once

#include <CLI/CLI.hpp>

#include "engine/app/options.hpp"

namespace psygen::cli {

// `options` outlives the command; its current values are the defaults.
void add_scene_options(CLI::App& command, app::SessionOptions& options);

// Replace the name in the options by the file that find_file() finds. An empty path stays empty.
core::Result<void> find_world(app::SessionOptions& options);
core::Result<void> find_path(app::FlightOptions& options);

}  // namespace psygen::cli
