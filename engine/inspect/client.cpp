#include "engine/inspect/client.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>

#include "engine/inspect/socket_address.hpp"

namespace psygen::inspect {
namespace {

constexpr std::size_t kMaxAnswerBytes = std::size_t{64} << 20;
constexpr std::size_t kMaxCommandBytes = 4096;

std::string command_of(int pid) {
  std::ifstream file(fmt::format("/proc/{}/cmdline", pid), std::ios::binary);
  std::string text(kMaxCommandBytes, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  while (!text.empty() && text.back() == '\0')
    text.pop_back();
  std::ranges::replace(text, '\0', ' ');
  return text;
}

}  // namespace

core::Result<std::vector<Endpoint>> endpoints(const std::filesystem::path& folder) {
  const auto checked = socket_folder(folder);
  if (!checked) return tl::unexpected(checked.error());
  std::vector<Endpoint> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(*checked, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kSocketPrefix) || !name.ends_with(kSocketSuffix)) continue;
    int pid = 0;  // psygen-PID.inspect, psygen-PID-2.inspect
    const char* const end =
        std::from_chars(name.data() + kSocketPrefix.size(), name.data() + name.size(), pid).ptr;
    const bool is_name = *end == '-' || end == name.data() + name.size() - kSocketSuffix.size();
    if (is_name && pid > 0 && is_served(entry.path()))
      found.push_back({entry.path(), pid, command_of(pid)});
  }
  std::ranges::sort(found, {}, [](const Endpoint& e) { return std::pair(e.pid, e.socket); });
  return found;
}

struct Client::Parts {
  Descriptor fd;
  std::string input, output;
  std::size_t looked_at = 0;

  void close() { fd = Descriptor(); }

  void transmit() {
    while (fd && !output.empty()) {
      const ssize_t went = ::send(fd.get(), output.data(), output.size(), MSG_NOSIGNAL);
      if (went > 0) {
        output.erase(0, static_cast<std::size_t>(went));
        continue;
      }
      if (went < 0 && errno == EINTR) continue;
      // Earlier replies may still arrive.
      if (errno != EAGAIN && errno != EWOULDBLOCK) output.clear();
      return;
    }
  }

  void receive() {
    std::array<char, 64 << 10> bytes;
    while (fd && input.size() < kMaxAnswerBytes) {
      const ssize_t got = ::recv(fd.get(), bytes.data(), bytes.size(), 0);
      if (got > 0) {
        input.append(bytes.data(), static_cast<std::size_t>(got));
        continue;
      }
      if (got < 0 && errno == EINTR) continue;
      if (got == 0 || (errno != EAGAIN && errno != EWOULDBLOCK)) close();
      return;
    }
    if (input.find('\n') == std::string::npos && input.size() >= kMaxAnswerBytes) close();
  }
};

Client::Client() : parts_(std::make_unique<Parts>()) {}

Client::~Client() = default;

core::Result<std::unique_ptr<Client>> Client::attach(const std::filesystem::path& socket) {
  std::unique_ptr<Client> client(new Client);
  client->parts_->fd = connect_to(socket);
  if (!client->parts_->fd)
    return core::fail(core::ErrorCode::kIo,
                      fmt::format("{}: {}", socket.string(), std::strerror(errno)));
  if (!peer_of(client->parts_->fd.get()))
    return core::fail(core::ErrorCode::kIo,
                      fmt::format("{}: the socket belongs to another user", socket.string()));
  return client;
}

void Client::ask(std::string_view line) {
  if (!parts_->fd) return;
  parts_->output.append(line);
  parts_->output += '\n';
  parts_->transmit();
}

std::optional<std::string> Client::take_answer() {
  parts_->transmit();
  std::string& input = parts_->input;
  std::size_t end = input.find('\n', parts_->looked_at);
  if (end == std::string::npos) {
    parts_->looked_at = input.size();
    parts_->receive();
    end = input.find('\n', parts_->looked_at);
  }
  if (end == std::string::npos) {
    parts_->looked_at = input.size();
    return std::nullopt;
  }
  std::string line = input.substr(0, end);
  input.erase(0, end + 1);
  parts_->looked_at = 0;
  return line;
}

bool Client::is_open() const {
  return static_cast<bool>(parts_->fd);
}

}  // namespace psygen::inspect
