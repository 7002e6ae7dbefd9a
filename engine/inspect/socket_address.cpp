#include "engine/inspect/socket_address.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace psygen::inspect {

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

core::Result<std::filesystem::path> socket_folder(const std::filesystem::path& folder) {
  std::filesystem::path found = folder;
  if (found.empty()) {
    const char* runtime = std::getenv("XDG_RUNTIME_DIR");
    if (runtime == nullptr || *runtime != '/')
      return core::invalid_argument(
          "inspection needs XDG_RUNTIME_DIR, a folder that only this user may enter");
    found = runtime;
  }
  struct stat is {};
  if (::lstat(found.c_str(), &is) != 0)
    return core::invalid_argument(fmt::format("{}: {}", found.string(), std::strerror(errno)));
  if (!S_ISDIR(is.st_mode) || is.st_uid != ::geteuid() || (is.st_mode & 077) != 0) {
    return core::invalid_argument(
        fmt::format("{}: the socket must be in a folder of this user that no other "
                    "user may enter (mode 0700)",
                    found.string()));
  }
  return found;
}

std::optional<sockaddr_un> address_of(const std::filesystem::path& socket) {
  sockaddr_un address{};
  const std::string name = socket.string();
  if (name.size() >= sizeof(address.sun_path)) return std::nullopt;
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, name.c_str(), name.size() + 1);
  return address;
}

Descriptor connect_to(const std::filesystem::path& socket) {
  const auto address = address_of(socket);
  if (!address) return errno = ENAMETOOLONG, Descriptor();
  Descriptor fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (fd &&
      ::connect(fd.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof(*address)) != 0)
    return Descriptor();
  return fd;
}

// A datagram socket cannot connect to a stream: the kernel looks for the listener first.
bool is_served(const std::filesystem::path& socket) {
  const auto address = address_of(socket);
  const Descriptor fd(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  return address && fd &&
         ::connect(fd.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof(*address)) != 0 &&
         errno == EPROTOTYPE;
}

std::optional<int> peer_of(int fd) {
  ucred peer{};
  socklen_t size = sizeof(peer);
  if (::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return std::nullopt;
  if (peer.uid != ::geteuid()) return std::nullopt;
  return static_cast<int>(peer.pid);
}

}  // namespace psygen::inspect
