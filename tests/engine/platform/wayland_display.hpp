// A separate Wayland display for a test, with a keyboard and a mouse (wayland_display.py). Ends
// with the object; XDG_RUNTIME_DIR and WAYLAND_DISPLAY name it, and DISPLAY is unset, until then.
// One at a time.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace psygen::platform {

// Owns a process.
class WaylandDisplay {
 public:
  // Starts a display with a keyboard layout of xkb; null without sway, xkbcli or Python 3.
  static std::unique_ptr<WaylandDisplay> start(const std::string& layout);
  // Ends the process and restores the environment.
  ~WaylandDisplay();
  WaylandDisplay(const WaylandDisplay&) = delete;
  WaylandDisplay& operator=(const WaylandDisplay&) = delete;

  // Runs a command of wayland_display.py; true when the display has done it.
  bool run(const std::string& command);

 private:
  WaylandDisplay() = default;
  void set(const char* variable, const std::optional<std::string>& value);
  std::string answer();

  pid_t process_ = -1;
  std::FILE* commands_ = nullptr;
  std::FILE* answers_ = nullptr;
  std::vector<std::pair<const char*, std::optional<std::string>>> before_;  // the environment
};

}  // namespace psygen::platform
