// A local socket that exchanges lines of text with one client of the same user. Never waits, and
// keeps a bounded number of bytes whatever the client does: what it sends is read only when it is
// answered, and answered only when it reads. Knows nothing of what the lines mean. Linux. One
// thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/inspect/socket_address.hpp"

namespace psygen::inspect {

// A longer line ends the connection. A world file has at most 1 MiB, and JSON escapes some of it.
inline constexpr std::size_t kMaxLineBytes = std::size_t{4} << 20;

class LineServer {
 public:
  // A socket with mode 0600 in a folder (socket_folder()). Removes those of processes that have
  // crashed. Fails with kInvalidArgument and kIo.
  static core::Result<std::unique_ptr<LineServer>> open(const std::filesystem::path& folder);
  // Removes the socket.
  ~LineServer();

  const std::filesystem::path& address() const { return address_; }
  bool attached() const { return static_cast<bool>(client_); }
  // Takes a client of the same user that waits; true if there is one now.
  bool accept();
  // The client has shown that it knows the protocol. Those that do not within 5 s are dropped.
  void trust() { trusted_ = true; }
  void drop();

  // Reads what has come, at most 256 KiB a call, and refuses other clients. What goes wrong ends
  // the connection, as silence before trust() does, and 10 s in which the client does not read.
  void receive();
  // The next whole line without its end. Nothing while earlier answers are not sent.
  std::optional<std::string> take_line();
  void send(std::string_view line);
  void transmit();
  bool is_sending() const { return sent_ < output_.size(); }

 private:
  LineServer() = default;
  core::Result<void> listen(const std::filesystem::path& folder);
  void refuse_others() const;

  std::filesystem::path address_;
  std::uint64_t device_ = 0, inode_ = 0;  // of the socket's file
  Descriptor listening_, client_;
  bool trusted_ = false;
  double since_s_ = 0;  // when the client came, or when it last read
  std::string input_, output_;
  std::size_t looked_at_ = 0;  // of the input: no line ends before
  std::size_t sent_ = 0;       // of the output
};

}  // namespace psygen::inspect
