// Addresses of the sockets of inspected sessions, and identity of their peers. Linux. Any thread.
#pragma once

#include <sys/un.h>

#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/core/error.hpp"

namespace psygen::inspect {

inline constexpr std::string_view kSocketPrefix = "psygen-", kSocketSuffix = ".inspect";

// A file descriptor, closed by the destructor.
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

// Returns `folder`, or $XDG_RUNTIME_DIR if it is empty. Fails with kInvalidArgument unless it is a
// folder of this user that no other user may enter.
core::Result<std::filesystem::path> socket_folder(const std::filesystem::path& folder);

// Returns nullopt if the path is too long for a socket.
std::optional<sockaddr_un> address_of(const std::filesystem::path& socket);

// Returns a connected non-blocking socket, or none if no process listens; errno has the reason.
Descriptor connect_to(const std::filesystem::path& socket);

// Returns true if a process listens. Does not connect, so that nobody loses a seat.
bool is_served(const std::filesystem::path& socket);

// Returns the process id of the peer if it belongs to the same user.
std::optional<int> peer_of(int fd);

}  // namespace psygen::inspect
