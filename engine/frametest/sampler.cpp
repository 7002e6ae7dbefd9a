#include "engine/frametest/sampler.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>
#include <utility>

#include "engine/core/child_process.hpp"
#include "engine/core/read_file.hpp"
#include "engine/core/utf8.hpp"

namespace psygen::frametest {
namespace {

constexpr const char *kData = "perf.data", *kScript = "perf.txt", *kMessages = "perf_messages.txt";
constexpr std::uint64_t kMaxScriptBytes = 256ULL << 20;
constexpr int kPatienceMs = 30'000;  // for a perf that hangs
constexpr int kControlOfChild = 10;  // the socket for commands and answers

core::Error unavailable(std::string_view reason) {
  return {core::ErrorCode::kNoDevice, fmt::format("perf cannot sample functions: {}", reason)};
}

// Starts perf with its outputs in files and without input. Returns its process.
core::Result<pid_t> start_perf(std::vector<std::string> words, const std::filesystem::path& out,
                               const std::filesystem::path& messages,
                               std::vector<core::PassedDescriptor> passed = {}) {
  words.insert(words.begin(), "perf");
  return core::start_child(
             std::move(words),
             {.in = "/dev/null", .out = out, .messages = messages, .passed = std::move(passed)})
      .map_error([](const core::Error& error) { return unavailable(error.message); });
}

// Waits for the end of a child, at most kPatienceMs. Returns true if it succeeded.
bool ends_well(pid_t child) {
  constexpr int kPollMs = 5;
  int status = 0;
  for (int waited_ms = 0; waitpid(child, &status, WNOHANG) == 0; waited_ms += kPollMs) {
    if (waited_ms >= kPatienceMs) kill(child, SIGKILL);
    poll(nullptr, 0, kPollMs);
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

// Sends a command to perf and waits for its answer. False if perf has ended.
bool obeys(int control, std::string_view command) {
  if (send(control, command.data(), command.size(), MSG_NOSIGNAL) < 0) return false;
  pollfd answer{control, POLLIN, 0};
  std::array<char, 16> text{};
  return poll(&answer, 1, kPatienceMs) > 0 && recv(control, text.data(), text.size(), 0) > 0;
}

// "45651.133096:      7fcf70cb23e0 update_active"
bool parse_sample(std::string_view line, Sample& sample) {
  const auto number =
      std::from_chars(line.data() + std::min(line.find_first_not_of(' '), line.size()),
                      line.data() + line.size(), sample.time_s);
  if (number.ec != std::errc() || number.ptr == line.data() + line.size() || *number.ptr != ':')
    return false;
  line.remove_prefix(static_cast<std::size_t>(number.ptr + 1 - line.data()));
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  const std::size_t address_end = line.find(' ');
  if (address_end == std::string_view::npos) return false;
  sample.function = core::shown(line.substr(address_end + 1));
  return !sample.function.empty();
}

}  // namespace

std::vector<Sample> parse_samples(std::string_view script) {
  std::vector<Sample> samples;
  while (!script.empty()) {
    const std::string_view line = script.substr(0, script.find('\n'));
    script.remove_prefix(std::min(line.size() + 1, script.size()));
    if (Sample sample; parse_sample(line, sample)) samples.push_back(std::move(sample));
  }
  return samples;
}

core::Result<Sampler> Sampler::start(const std::filesystem::path& folder) {
  Sampler sampler(folder);
  if (auto ok = sampler.open(); !ok) return tl::unexpected(ok.error());
  return sampler;
}

core::Result<void> Sampler::open() {
  std::array<int, 2> ends{-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return tl::unexpected(unavailable(std::generic_category().message(errno)));
  control_ = ends[0];
  const auto child =
      start_perf({"record", "--quiet", "-k", "CLOCK_MONOTONIC", "-e", "cpu-clock", "-F",
                  fmt::format("{:.0f}", kSamplesPerSecond), "-t",
                  fmt::format("{}", syscall(SYS_gettid)), "-o", (folder_ / kData).string(),
                  "--control", fmt::format("fd:{0},{0}", kControlOfChild), "-D", "-1"},
                 "/dev/null", folder_ / kMessages, {{ends[1], kControlOfChild}});
  close(ends[1]);
  if (!child) return tl::unexpected(child.error());
  child_ = *child;
  if (obeys(control_, "enable\n")) return {};
  end();
  return tl::unexpected(perf_error());
}

// The first line that perf has written.
core::Error Sampler::perf_error() const {
  constexpr std::uint64_t kMaxMessageBytes = 64 << 10;
  const auto text = core::read_file(folder_ / kMessages, kMaxMessageBytes);
  const std::string line =
      text ? std::string(text->begin(), std::ranges::find(*text, '\n')) : std::string();
  return unavailable(line.empty() ? "it ended without a message" : core::shown(line));
}

// Closes the socket and ends perf.
void Sampler::end() {
  if (control_ >= 0) close(std::exchange(control_, -1));
  if (child_ < 0) return;
  kill(child_, SIGTERM);
  ends_well(std::exchange(child_, -1));
}

Sampler::Sampler(Sampler&& other) noexcept
    : folder_(std::move(other.folder_)),
      child_(std::exchange(other.child_, -1)),
      control_(std::exchange(other.control_, -1)) {}

Sampler::~Sampler() {
  end();
  std::error_code ignored;
  if (folder_.empty()) return;
  for (const char* name : {kData, kScript, kMessages})
    std::filesystem::remove(folder_ / name, ignored);
}

core::Result<std::vector<Sample>> Sampler::stop() {
  if (!obeys(control_, "stop\n") || !ends_well(std::exchange(child_, -1)))
    return tl::unexpected(perf_error());
  const auto reader =
      start_perf({"script", "-i", (folder_ / kData).string(), "--no-inline", "-F", "time,ip,sym"},
                 folder_ / kScript, folder_ / kMessages);
  if (!reader) return tl::unexpected(reader.error());
  if (!ends_well(*reader)) return tl::unexpected(perf_error());
  const auto script = core::read_file(folder_ / kScript, kMaxScriptBytes);
  if (!script) return tl::unexpected(script.error());
  return parse_samples({reinterpret_cast<const char*>(script->data()), script->size()});
}

}  // namespace psygen::frametest
