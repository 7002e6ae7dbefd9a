// The drawing process: reads requests as lines of JSON from the standard input, draws, writes
// files, and answers each with a line on the standard output. It has one headless session that
// follows the worlds of the requests, so that what they have in common is made once. Whatever a
// world does to this process, the editor stays.
#pragma once

#include <string>
#include <vector>

#include "engine/app/options.hpp"

namespace psygen::editor {

// The hidden option of the editor that runs this.
inline constexpr const char* kPicturesOption = "--render-pictures";

// Serves until the input ends; the exit code. At the lowest priority of the operating system, and
// the first to go where memory is short. Ends after a request whose model hangs: its thread cannot
// be ended alone. `device_name`: part of a Vulkan device's name; empty: the best one.
int render_pictures(std::vector<app::Plugin> plugins, std::string device_name = {});

}  // namespace psygen::editor
