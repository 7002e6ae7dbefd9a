// A local socket that exchanges lines of text with one client of the same user. Never blocks, and
// buffers a bounded number of bytes whatever the client does: it reads requests only as they are
// answered, and answers only as the client reads. Does not interpret the lines. Linux. One thread.
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

// A longer line ends the connection. A world file has at most 1 MiB, and JSON escapes part of it.
inline constexpr std::size_t kMaxLineBytes = std::size_t{4} << 20;

class LineServer {
 public:
  // Creates a socket with mode 0600 in a folder (socket_folder()). Removes sockets of crashed
  // processes. Fails with kInvalidArgument and kIo.
  static core::Result<std::unique_ptr<LineServer>> open(const std::filesystem::path& folder);
  // Removes the socket.
  ~LineServer();

  const std::filesystem::path& address() const { return address_; }
  bool attached() const { return static_cast<bool>(client_); }
  // Accepts a waiting client of the same user; returns true if a client is connected.
  bool accept();
  // Call once the client has used the protocol correctly. Clients that do not within 5 s are
  // dropped.
  void trust() { trusted_ = attached(); }
  void drop();
  // True if the client has closed its end. Reads nothing.
  bool has_left() const;

  // Reads received data, at most 256 KiB per call, and rejects other clients. Any error ends the
  // connection, as do silence before trust() and 10 s in which the client does not read.
  void receive();
  // The next complete line without its end; nullopt while earlier replies are unsent.
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
  double since_s_ = 0;  // when the client connected or last read
  std::string input_, output_;
  std::size_t looked_at_ = 0;  // in the input: no line ends before it
  std::size_t sent_ = 0;       // in the output
};

}  // namespace psygen::inspect
