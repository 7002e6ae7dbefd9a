#include "engine/frametest/sampler.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <system_error>
#include <utility>

#include "engine/core/read_file.hpp"
#include "engine/core/utf8.hpp"

namespace psygen::frametest {
namespace {

constexpr const char *kData = "perf.data", *kScript = "perf.txt", *kMessages = "perf_messages.txt";
constexpr std::uint64_t kMaxScriptBytes = 256ULL << 20;
constexpr int kPatienceMs = 30'000;  // for a perf that hangs
constexpr int kCommandsOfChild = 10, kAnswersOfChild = 11;

// The two ends of a pipe, closed with it.
class Pipe {
 public:
  Pipe() {
    std::array<int, 2> ends{-1, -1};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return;
    // Numbers over those of the child, so that no duplicate replaces an end.
    for (std::size_t i = 0; i < ends.size(); ++i) {
      ends_[i] = fcntl(ends[i], F_DUPFD_CLOEXEC, kAnswersOfChild + 1);
      close(ends[i]);
    }
  }
  ~Pipe() {
    for (const int end : ends_)
      if (end >= 0) close(end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  bool is_open() const { return ends_[0] >= 0 && ends_[1] >= 0; }
  int reader() const { return ends_[0]; }
  int writer() const { return ends_[1]; }
  int take_reader() { return std::exchange(ends_[0], -1); }
  int take_writer() { return std::exchange(ends_[1], -1); }

 private:
  std::array<int, 2> ends_{-1, -1};
};

struct EndsOfChild {
  int commands = -1, answers = -1;
};

core::Error unavailable(std::string_view reason) {
  return {core::ErrorCode::kNoDevice, fmt::format("perf cannot sample functions: {}", reason)};
}

// Starts perf with its outputs in files and without input. Returns its process.
core::Result<pid_t> spawn(std::vector<std::string> words, const std::filesystem::path& out,
                          const std::filesystem::path& messages,
                          std::optional<EndsOfChild> ends = {}) {
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  constexpr int kWrite = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), kWrite, 0644);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, messages.c_str(), kWrite, 0644);
  if (ends) {
    posix_spawn_file_actions_adddup2(&actions, ends->commands, kCommandsOfChild);
    posix_spawn_file_actions_adddup2(&actions, ends->answers, kAnswersOfChild);
  }
  pid_t child = -1;
  const int failed =
      posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return tl::unexpected(unavailable(std::generic_category().message(failed)));
  return child;
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

// Sends a command to perf and waits for its answer.
bool obeys(int commands, int answers, std::string_view command) {
  if (write(commands, command.data(), command.size()) < 0) return false;
  pollfd answer{answers, POLLIN, 0};
  std::array<char, 16> text{};
  return poll(&answer, 1, kPatienceMs) > 0 && (answer.revents & POLLIN) != 0 &&
         read(answers, text.data(), text.size()) > 0;
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
  Pipe commands, answers;
  if (!commands.is_open() || !answers.is_open())
    return tl::unexpected(unavailable(std::generic_category().message(errno)));
  const auto child =
      spawn({"perf", "record", "--quiet", "-k", "CLOCK_MONOTONIC", "-e", "cpu-clock", "-F",
             fmt::format("{:.0f}", kSamplesPerSecond), "-t", fmt::format("{}", syscall(SYS_gettid)),
             "-o", (folder_ / kData).string(), "--control",
             fmt::format("fd:{},{}", kCommandsOfChild, kAnswersOfChild), "-D", "-1"},
            "/dev/null", folder_ / kMessages,
            EndsOfChild{.commands = commands.reader(), .answers = answers.writer()});
  if (!child) return tl::unexpected(child.error());
  child_ = *child;
  commands_ = commands.take_writer();
  answers_ = answers.take_reader();
  close(answers.take_writer());  // perf's death is then seen as the end of its answers
  if (obeys(commands_, answers_, "enable\n")) return {};
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

// Closes the pipes and ends perf.
void Sampler::end() {
  for (int* pipe : {&commands_, &answers_})
    if (*pipe >= 0) close(std::exchange(*pipe, -1));
  if (child_ < 0) return;
  kill(child_, SIGTERM);
  ends_well(std::exchange(child_, -1));
}

Sampler::Sampler(Sampler&& other) noexcept
    : folder_(std::move(other.folder_)),
      child_(std::exchange(other.child_, -1)),
      commands_(std::exchange(other.commands_, -1)),
      answers_(std::exchange(other.answers_, -1)) {}

Sampler::~Sampler() {
  end();
  std::error_code ignored;
  if (folder_.empty()) return;
  for (const char* name : {kData, kScript, kMessages})
    std::filesystem::remove(folder_ / name, ignored);
}

core::Result<std::vector<Sample>> Sampler::stop() {
  if (!obeys(commands_, answers_, "stop\n") || !ends_well(std::exchange(child_, -1)))
    return tl::unexpected(perf_error());
  const auto reader = spawn(
      {"perf", "script", "-i", (folder_ / kData).string(), "--no-inline", "-F", "time,ip,sym"},
      folder_ / kScript, folder_ / kMessages);
  if (!reader) return tl::unexpected(reader.error());
  if (!ends_well(*reader)) return tl::unexpected(perf_error());
  const auto script = core::read_file(folder_ / kScript, kMaxScriptBytes);
  if (!script) return tl::unexpected(script.error());
  return parse_samples({reinterpret_cast<const char*>(script->data()), script->size()});
}

}  // namespace psygen::frametest
