// The other end of inspect.hpp: finds sessions that can be inspected, and exchanges lines with one
// (docs/inspect.md). Never waits, and knows no JSON. Linux. One thread.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::inspect {

// A session that runs and can be inspected.
struct Endpoint {
  std::filesystem::path socket;
  int pid = 0;
  std::string command;  // of its process, as it was started
};

// Those in a folder, or in $XDG_RUNTIME_DIR if it is empty, by process. Fails with kInvalidArgument
// for folders that others may enter.
core::Result<std::vector<Endpoint>> endpoints(const std::filesystem::path& folder = {});

// A connection to one.
class Client {
 public:
  // Connects. Fails with kIo where nobody of this user listens.
  static core::Result<std::unique_ptr<Client>> attach(const std::filesystem::path& socket);
  // Leaves: the session puts back what was changed.
  ~Client();

  // Sends a line, now or with the next calls. Ignored once the connection has ended.
  void ask(std::string_view line);
  // The next whole line that has come, without its end.
  std::optional<std::string> take_answer();
  // False once the session has ended, or refused; answers that have come can still be taken.
  bool is_open() const;
  // Bytes that are not sent yet.
  std::size_t unsent() const;

 private:
  Client();
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace psygen::inspect
