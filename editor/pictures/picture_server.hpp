// The rendering process: reads requests as lines of JSON from the standard input, renders, writes
// files, and answers each request with a line on the standard output. One headless session follows
// the worlds of the requests, so that common meshes are synthesised once. A world that crashes this
// process does not affect the editor.
#pragma once

#include <string>
#include <vector>

#include "engine/app/options.hpp"

namespace psygen::editor {

// The hidden option of the editor that starts this process.
inline constexpr const char* kPicturesOption = "--render-pictures";

// Serves requests until the input ends, and returns the exit code. Runs at the lowest priority, and
// is the first process that the system kills when memory is short. Ends the process after a request
// whose model hangs, because a single thread cannot be ended. `device_name`: as
// render::RendererOptions::device_name.
int render_pictures(std::vector<app::Plugin> plugins, std::string device_name = {});

}  // namespace psygen::editor
