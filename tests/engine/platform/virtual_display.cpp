#include "tests/engine/platform/virtual_display.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>

extern char** environ;

namespace psygen::platform {
namespace {

// The child's process id, or −1. Its output goes to `output`, or nowhere; other descriptors are
// inherited.
pid_t spawn(std::vector<std::string> command, int output = -1) {
  std::vector<char*> arguments;
  for (std::string& argument : command)
    arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (output >= 0) {
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  } else {
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  }
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = -1;
  const int error =
      posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return error == 0 ? child : -1;
}

void end(pid_t child) {
  if (child <= 0) return;
  kill(child, SIGTERM);
  waitpid(child, nullptr, 0);
}

// The first line in the child's pipe that `wanted` accepts; empty if the child ends before.
template <class Start, class Wanted>
std::string line_from(pid_t& child, const Start& start, const Wanted& wanted) {
  std::array<int, 2> ends{-1, -1};
  if (pipe(ends.data()) != 0) return "";
  child = start(ends[1]);
  close(ends[1]);
  std::string line;
  bool found = false;
  char c = 0;
  while (child > 0 && !found && read(ends[0], &c, 1) == 1) {
    if (c != '\n') {
      line += c;
      continue;
    }
    found = wanted(line);
    if (!found) line.clear();
  }
  close(ends[0]);
  return found ? line : "";
}

}  // namespace

std::unique_ptr<VirtualDisplay> VirtualDisplay::start(const std::string& size) {
  std::unique_ptr<VirtualDisplay> display(new VirtualDisplay());
  if (const char* before = std::getenv("DISPLAY")) display->display_before_ = before;
  const std::string number = line_from(
      display->server_,
      [&size](int writer) {
        return spawn({"Xvfb", "-displayfd", std::to_string(writer), "-screen", "0", size + "x24",
                      "-nolisten", "tcp"});
      },
      [](const std::string& line) { return !line.empty(); });
  if (number.empty()) return nullptr;
  setenv("DISPLAY", (":" + number).c_str(), 1);
  const std::string ready = line_from(
      display->window_manager_,
      [](int writer) {
        return spawn({"openbox", "--startup", "echo ready"}, writer);
      },
      [](const std::string& line) { return line == "ready"; });
  return ready == "ready" ? std::move(display) : nullptr;
}

VirtualDisplay::~VirtualDisplay() {
  end(window_manager_);
  end(server_);
  if (display_before_.empty()) {
    unsetenv("DISPLAY");
  } else {
    setenv("DISPLAY", display_before_.c_str(), 1);
  }
}

bool VirtualDisplay::xdotool(std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), "xdotool");
  const pid_t child = spawn(std::move(arguments));
  int status = -1;
  return child > 0 && waitpid(child, &status, 0) == child && status == 0;
}

std::string VirtualDisplay::output(std::vector<std::string> command) const {
  std::string printed;
  pid_t child = -1;
  line_from(
      child, [&](int writer) { return spawn(std::move(command), writer); },
      [&](const std::string& line) {
        printed += line + "\n";
        return false;
      });
  if (child > 0) waitpid(child, nullptr, 0);
  return printed;
}

}  // namespace psygen::platform
