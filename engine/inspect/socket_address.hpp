// Where the sockets of inspected sessions are, and who is behind them. Linux. Any thread.
#pragma once

#include <sys/un.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "engine/core/error.hpp"

namespace psygen::inspect {

inline constexpr std::string_view kSocketPrefix = "psygen-", kSocketSuffix = ".inspect";

// A descriptor that is closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_;
};

// `folder`, or $XDG_RUNTIME_DIR if it is empty. Fails with kInvalidArgument unless it is a folder
// of this user that nobody else may enter.
core::Result<std::filesystem::path> socket_folder(const std::filesystem::path& folder);

// Nothing where the path is too long for a socket.
std::optional<sockaddr_un> address_of(const std::filesystem::path& socket);

// A socket that does not wait, connected; none where nobody listens there. errno says why.
Descriptor connect_to(const std::filesystem::path& socket);

// The process at the other end, if it is of the same user.
std::optional<int> peer_of(int fd);

}  // namespace psygen::inspect
