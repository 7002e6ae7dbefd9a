// A separate display for a test: Xvfb with the openbox window manager, and xdotool in place of the
// user's keyboard and mouse. Ends with the object; DISPLAY points to it until then. One at a time.
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>
#include <vector>

namespace psygen::platform {

// Owns the two processes.
class VirtualDisplay {
 public:
  // Starts the display, of a size in pixels; null when Xvfb or openbox cannot be started.
  static std::unique_ptr<VirtualDisplay> start(const std::string& size = "1280x1024");
  // Ends the processes and restores DISPLAY.
  ~VirtualDisplay();
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

  // Runs xdotool with these arguments and waits for it; true when it succeeded.
  bool xdotool(std::vector<std::string> arguments) const;
  // Runs a command on this display, waits for its end and returns its stdout.
  std::string output(std::vector<std::string> command) const;

 private:
  VirtualDisplay() = default;
  pid_t server_ = -1;
  pid_t window_manager_ = -1;
  std::string display_before_;
};

}  // namespace psygen::platform
