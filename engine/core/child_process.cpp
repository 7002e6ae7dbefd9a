#include "engine/core/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <unistd.h>

#include <system_error>

namespace psygen::core {
namespace {

// The child takes these actions between fork and exec.
class Actions {
 public:
  explicit Actions(const ChildOptions& options) {
    posix_spawn_file_actions_init(&files_);
    posix_spawnattr_init(&attributes_);
    sigset_t usual;  // programs of psygen ignore these, and a child would too
    sigemptyset(&usual);
    sigaddset(&usual, SIGPIPE);
    sigaddset(&usual, SIGXFSZ);
    posix_spawnattr_setsigdefault(&attributes_, &usual);
    const int group = options.own_group ? POSIX_SPAWN_SETPGROUP : 0;
    posix_spawnattr_setflags(&attributes_, static_cast<short>(POSIX_SPAWN_SETSIGDEF | group));
    constexpr int kWrite = O_WRONLY | O_CREAT | O_TRUNC;
    open(STDIN_FILENO, options.in, O_RDONLY);
    open(STDOUT_FILENO, options.out, kWrite);
    if (!options.out.empty() && options.messages == options.out)
      posix_spawn_file_actions_adddup2(&files_, STDOUT_FILENO, STDERR_FILENO);
    else
      open(STDERR_FILENO, options.messages, kWrite);
    for (const PassedDescriptor& each : options.passed)
      posix_spawn_file_actions_adddup2(&files_, each.here, each.there);
  }
  ~Actions() {
    posix_spawnattr_destroy(&attributes_);
    posix_spawn_file_actions_destroy(&files_);
  }
  Actions(const Actions&) = delete;
  Actions& operator=(const Actions&) = delete;

  // Returns 0 or an errno.
  int spawn(char** arguments, pid_t& child) const {
    return posix_spawnp(&child, arguments[0], &files_, &attributes_, arguments, environ);
  }

 private:
  void open(int descriptor, const std::filesystem::path& file, int flags) {
    if (!file.empty())
      posix_spawn_file_actions_addopen(&files_, descriptor, file.c_str(), flags, 0644);
  }

  posix_spawn_file_actions_t files_;
  posix_spawnattr_t attributes_;
};

}  // namespace

Result<pid_t> start_child(std::vector<std::string> words, const ChildOptions& options) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  if (words.empty()) return invalid_argument("a program without a name cannot run");
  pid_t child = -1;
  const int failed = Actions(options).spawn(arguments.data(), child);
  if (failed == 0) return child;
  return fail(ErrorCode::kIo, fmt::format("{}: cannot run: {}", words.front(),
                                          std::generic_category().message(failed)));
}

}  // namespace psygen::core
