#include "engine/cli/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <sstream>
#include <string_view>
#include <system_error>

namespace psygen::cli {
namespace {

// Null-terminated, as the system requires.
std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts)
    pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

// Returns the environment of this process; `environment` replaces variables of the same name.
std::vector<std::string> with_ours(std::vector<std::string> environment) {
  const auto is_added = [&](std::string_view variable) {
    const std::string_view name = variable.substr(0, variable.find('=') + 1);
    return std::ranges::any_of(environment, [&](const auto& e) { return e.starts_with(name); });
  };
  std::vector<std::string> ours;
  for (char** variable = environ; *variable != nullptr; ++variable)
    if (!is_added(*variable)) ours.emplace_back(*variable);
  ours.insert(ours.end(), environment.begin(), environment.end());
  return ours;
}

}  // namespace

std::vector<std::string> words_of(const std::string& command) {
  std::vector<std::string> words;
  std::istringstream text(command);
  for (std::string word; text >> word;)
    words.push_back(word);
  return words;
}

core::Result<int> run_program(std::vector<std::string> words, const std::filesystem::path& log,
                              std::vector<std::string> environment) {
  if (words.empty()) return core::fail(core::ErrorCode::kInvalidArgument, "an empty command");
  std::vector<std::string> variables = with_ours(std::move(environment));
  const std::vector<char*> arguments = pointers_to(words), values = pointers_to(variables);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int failed =
      posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(), values.data());
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) {
    return core::fail(core::ErrorCode::kIo, fmt::format("{}: cannot run: {}", words.front(),
                                                        std::generic_category().message(failed)));
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace psygen::cli
