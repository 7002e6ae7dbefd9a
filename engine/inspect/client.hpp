// Client of inspect.hpp: finds sessions that can be inspected and exchanges lines with one
// (docs/inspect.md). Never blocks; does not parse JSON. Linux. One thread.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::inspect {

// A running session that can be inspected.
struct Endpoint {
  std::filesystem::path socket;
  int pid = 0;
  std::string command;  // command line of its process
};

// Sessions in a folder, or in $XDG_RUNTIME_DIR if it is empty, by process. Connects to none, so a
// session stays free for its next client. Fails with kInvalidArgument for folders that other users
// may enter.
core::Result<std::vector<Endpoint>> endpoints(const std::filesystem::path& folder = {});

// A connection to a session.
class Client {
 public:
  // Connects. Fails with kIo if no process of this user listens.
  static core::Result<std::unique_ptr<Client>> attach(const std::filesystem::path& socket);
  // Disconnects: the session restores what the client changed.
  ~Client();

  // Queues a line and sends it, in this call or the next ones. Ignored once the connection has
  // ended.
  void ask(std::string_view line);
  // The next complete line received, without its end.
  std::optional<std::string> take_answer();
  // False once the session has ended or rejected the connection; received replies remain available.
  bool is_open() const;

 private:
  Client();
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace psygen::inspect
