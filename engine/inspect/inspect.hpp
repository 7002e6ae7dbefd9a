// Lets one program of the same user look into a running session and change it, over a local socket
// (docs/inspect.md). The server of the protocol, as a plugin; client.hpp is the other end. Off
// unless a program adds the plugin. While nobody is attached a frame costs one system call that
// does not wait. Main thread.
#pragma once

#include <filesystem>

#include "engine/app/options.hpp"

namespace psygen::inspect {

// The name and version of the protocol, as `hello` tells it.
inline constexpr const char* kProtocol = "psygen.inspect/1";

// How a session can be reached.
struct InspectOptions {
  // Where the socket is: a folder of ours that nobody else may enter. Empty: $XDG_RUNTIME_DIR.
  std::filesystem::path folder = {};
};

// The plugin, for SessionOptions::plugins; one a session. A session that cannot have the socket is
// not created: kInvalidArgument for a folder that others may enter, and kIo.
app::Plugin plugin(InspectOptions options = {});

}  // namespace psygen::inspect
