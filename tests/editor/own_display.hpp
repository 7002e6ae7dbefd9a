// Gives programs that open the editor's window their own display, settings and state, and lets them
// wait for conditions. Main thread.
#pragma once

#include <unistd.h>

#include <QApplication>
#include <QDeadlineTimer>
#include <QThread>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "tests/engine/platform/virtual_display.hpp"

namespace psygen::editor {

// Folders for settings and state. To be created before the QApplication; the destructor removes
// them.
class OwnFolders {
 public:
  OwnFolders()
      : home_(std::filesystem::temp_directory_path() /
              ("psygen_editor_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(home_);
    for (const char* variable : {"XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME"})
      ::setenv(variable, home_.c_str(), 1);
  }
  ~OwnFolders() {
    std::error_code ignored;
    std::filesystem::remove_all(home_, ignored);
  }
  OwnFolders(const OwnFolders&) = delete;
  OwnFolders& operator=(const OwnFolders&) = delete;

  const std::filesystem::path& home() const { return home_; }

 private:
  std::filesystem::path home_;
};

// A display of X11, and folders. To be created before the QApplication.
class OwnDisplay {
 public:
  // `size` in pixels. Null, with a message on stderr, if no display can be started.
  static std::unique_ptr<OwnDisplay> start(const std::string& size = "1280x1024") {
    std::unique_ptr<OwnDisplay> own(new OwnDisplay());
    own->display_ = platform::VirtualDisplay::start(size);
    if (!own->display_) {
      std::fprintf(stderr, "no display: Xvfb or openbox cannot be started (tools/setup.sh)\n");
      return nullptr;
    }
    ::setenv("QT_QPA_PLATFORM", "xcb", 1);
    return own;
  }

  const std::filesystem::path& home() const { return folders_.home(); }

 private:
  OwnDisplay() = default;

  OwnFolders folders_;
  std::unique_ptr<platform::VirtualDisplay> display_;
};

// Processes events until a condition is true. Returns false after a timeout.
inline bool wait_until(const std::function<bool()>& is_so, int longest_ms) {
  const QDeadlineTimer end(longest_ms);
  while (!is_so()) {
    if (end.hasExpired()) return false;
    QApplication::processEvents(QEventLoop::AllEvents, 5);
    QThread::usleep(200);
  }
  return true;
}

}  // namespace psygen::editor
