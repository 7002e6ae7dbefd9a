// Lets one program of the same user inspect and change a running session over a local socket
// (docs/inspect.md). Server of the protocol, as a plugin; client.hpp is the client. Off unless a
// program adds the plugin. Without a client, a frame costs one non-blocking system call. Main
// thread.
#pragma once

#include <filesystem>

#include "engine/app/options.hpp"

namespace psygen::inspect {

// Name and version of the protocol, as `hello` reports it.
inline constexpr const char* kProtocol = "psygen.inspect/1";

// Location of a session's socket.
struct InspectOptions {
  // Folder of the socket: owned by this user and closed to others. Empty: $XDG_RUNTIME_DIR.
  std::filesystem::path folder = {};
};

// The plugin for SessionOptions::plugins; one per session. Session creation fails if the socket
// cannot be created: kInvalidArgument for a folder that others may enter, or kIo.
app::Plugin plugin(InspectOptions options = {});

}  // namespace psygen::inspect
