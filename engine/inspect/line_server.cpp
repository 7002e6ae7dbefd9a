#include "engine/inspect/line_server.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "engine/core/clock.hpp"

namespace psygen::inspect {
namespace {

constexpr std::size_t kReadBytes = 16 << 10, kMaxReads = 16;  // per frame
constexpr std::size_t kMaxUnread = std::size_t{1} << 20;      // bytes of replies
constexpr double kGreetingSeconds = 5, kStuckSeconds = 10;
constexpr int kMaxSockets = 16;  // per process

tl::unexpected<core::Error> no_socket(const std::filesystem::path& path) {
  return core::fail(core::ErrorCode::kIo,
                    fmt::format("{}: {}", path.string(), std::strerror(errno)));
}

bool is_ours(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with(kSocketPrefix) && name.ends_with(kSocketSuffix);
}

// Removes sockets without a listening process.
void remove_dead_sockets(const std::filesystem::path& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (!is_ours(entry.path()) || !entry.is_socket(error)) continue;
    if (!connect_to(entry.path()) && errno == ECONNREFUSED)
      std::filesystem::remove(entry.path(), error);
  }
}

}  // namespace

core::Result<std::unique_ptr<LineServer>> LineServer::open(const std::filesystem::path& folder) {
  const auto checked = socket_folder(folder);
  if (!checked) return tl::unexpected(checked.error());
  std::unique_ptr<LineServer> server(new LineServer);
  if (auto ok = server->listen(*checked); !ok) return tl::unexpected(ok.error());
  return server;
}

core::Result<void> LineServer::listen(const std::filesystem::path& folder) {
  remove_dead_sockets(folder);
  Descriptor fd(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  // Sets the mode of the file before it becomes visible.
  if (!fd || ::fchmod(fd.get(), 0600) != 0) return no_socket(folder);
  for (int i = 1; i <= kMaxSockets; ++i) {
    const std::string number = i > 1 ? fmt::format("-{}", i) : "";
    const auto path =
        folder / fmt::format("{}{}{}{}", kSocketPrefix, ::getpid(), number, kSocketSuffix);
    const auto address = address_of(path);
    if (!address)
      return core::invalid_argument(
          fmt::format("{}: too long for a socket address", path.string()));
    if (::bind(fd.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof(*address)) != 0) {
      if (errno == EADDRINUSE && i < kMaxSockets) continue;
      return no_socket(path);
    }
    address_ = path;
    struct stat is {};
    if (::chmod(path.c_str(), 0600) != 0 || ::lstat(path.c_str(), &is) != 0 ||
        ::listen(fd.get(), 4) != 0)
      return no_socket(path);
    device_ = is.st_dev;
    inode_ = is.st_ino;
    listening_ = std::move(fd);
    return {};
  }
  return no_socket(folder);
}

LineServer::~LineServer() {
  struct stat is {};
  if (address_.empty() || ::lstat(address_.c_str(), &is) != 0) return;
  if (is.st_dev == device_ && is.st_ino == inode_) ::unlink(address_.c_str());
}

bool LineServer::accept() {
  do {
    client_ =
        Descriptor(::accept4(listening_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!client_) return false;
    char first = 0;  // a connection that has ended was only a look
    if (::recv(client_.get(), &first, 1, MSG_PEEK) == 0) drop();
  } while (!client_);
  if (!peer_of(client_.get())) return drop(), false;
  since_s_ = core::monotonic_seconds();
  return true;
}

void LineServer::drop() {
  client_ = Descriptor();
  trusted_ = false;
  input_ = {};
  output_ = {};
  looked_at_ = sent_ = 0;
}

bool LineServer::has_left() const {
  pollfd end{client_.get(), POLLRDHUP, 0};
  return !client_ ||
         (::poll(&end, 1, 0) > 0 && (end.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0);
}

void LineServer::refuse_others() const {
  const Descriptor other(
      ::accept4(listening_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  constexpr std::string_view kBusy =
      "{\"ok\":false,\"error\":\"another program is already attached\"}\n";
  if (other && peer_of(other.get()))
    (void)!::send(other.get(), kBusy.data(), kBusy.size(), MSG_NOSIGNAL);
}

void LineServer::receive() {
  refuse_others();
  std::array<char, kReadBytes> bytes;
  for (std::size_t i = 0; i < kMaxReads; ++i) {
    // A complete line is waiting, or the input limit is reached.
    if (input_.find('\n', looked_at_) != std::string::npos) return;
    looked_at_ = input_.size();
    if (input_.size() > kMaxLineBytes) return drop();
    const ssize_t got = ::recv(client_.get(), bytes.data(), bytes.size(), 0);
    if (got == 0) return drop();
    if (got < 0) {
      if (errno == EINTR) continue;
      if (errno != EAGAIN && errno != EWOULDBLOCK) return drop();
      if (!trusted_ && core::monotonic_seconds() - since_s_ > kGreetingSeconds) drop();
      return;
    }
    input_.append(bytes.data(), static_cast<std::size_t>(got));
  }
}

std::optional<std::string> LineServer::take_line() {
  if (!attached() || output_.size() - sent_ > kMaxUnread) return std::nullopt;
  const std::size_t end = input_.find('\n', looked_at_);
  if (end == std::string::npos) return std::nullopt;
  std::string line = input_.substr(0, end);
  input_.erase(0, end + 1);
  looked_at_ = 0;
  return line;
}

void LineServer::send(std::string_view line) {
  if (!attached()) return;
  if (!is_sending()) since_s_ = core::monotonic_seconds();
  output_.append(line);
  output_ += '\n';
}

void LineServer::transmit() {
  while (attached() && is_sending()) {
    const ssize_t went =
        ::send(client_.get(), output_.data() + sent_, output_.size() - sent_, MSG_NOSIGNAL);
    if (went < 0 && errno == EINTR) continue;
    if (went < 0) {
      const bool waits = errno == EAGAIN || errno == EWOULDBLOCK;
      if (!waits || core::monotonic_seconds() - since_s_ > kStuckSeconds) drop();
      return;
    }
    sent_ += static_cast<std::size_t>(went);
    since_s_ = core::monotonic_seconds();
  }
  output_.clear();
  sent_ = 0;
}

}  // namespace psygen::inspect
