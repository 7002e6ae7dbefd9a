#include "tests/engine/platform/wayland_display.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <sstream>

#include "tests/source_file.hpp"

extern char** environ;

namespace psygen::platform {

std::unique_ptr<WaylandDisplay> WaylandDisplay::start(const std::string& layout) {
  std::unique_ptr<WaylandDisplay> display(new WaylandDisplay());
  std::array<int, 2> in{}, out{};
  if (pipe2(in.data(), O_CLOEXEC) != 0 || pipe2(out.data(), O_CLOEXEC) != 0) return nullptr;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
  std::string python = "python3", program = source_file("tests/engine/platform/wayland_display.py");
  std::string language = layout;
  const std::array<char*, 4> arguments{python.data(), program.data(), language.data(), nullptr};
  const int error = posix_spawnp(&display->process_, python.c_str(), &actions, nullptr,
                                 arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(in[0]);
  close(out[1]);
  display->commands_ = fdopen(in[1], "w");
  display->answers_ = fdopen(out[0], "r");
  if (error != 0) return nullptr;
  std::istringstream ready(display->answer());
  std::string word, folder, name;
  if (!(ready >> word >> folder >> name) || word != "ready") return nullptr;
  display->set("XDG_RUNTIME_DIR", folder);
  display->set("WAYLAND_DISPLAY", name);
  display->set("DISPLAY", std::nullopt);
  return display;
}

WaylandDisplay::~WaylandDisplay() {
  for (const auto& [variable, value] : std::exchange(before_, {}))
    set(variable, value);
  if (commands_ != nullptr) std::fclose(commands_);
  if (answers_ != nullptr) std::fclose(answers_);
  if (process_ > 0) waitpid(process_, nullptr, 0);
}

void WaylandDisplay::set(const char* variable, const std::optional<std::string>& value) {
  const char* const before = std::getenv(variable);
  before_.emplace_back(variable, before == nullptr ? std::nullopt : std::optional(before));
  if (value) {
    setenv(variable, value->c_str(), 1);
  } else {
    unsetenv(variable);
  }
}

std::string WaylandDisplay::answer() {
  std::string line;
  for (int c = 0; (c = std::fgetc(answers_)) != EOF && c != '\n';)
    line += static_cast<char>(c);
  return line;
}

bool WaylandDisplay::run(const std::string& command) {
  return std::fputs((command + "\n").c_str(), commands_) >= 0 && std::fflush(commands_) == 0 &&
         answer() == command;
}

}  // namespace psygen::platform
