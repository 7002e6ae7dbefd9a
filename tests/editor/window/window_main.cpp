// Tests of the editor's window run on a display of their own, with settings of their own.
#include <gtest/gtest.h>
#include <unistd.h>

#include <QApplication>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "editor/pictures/picture_server.hpp"
#include "tests/engine/platform/virtual_display.hpp"

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], psygen::editor::kPicturesOption) == 0)
    return psygen::editor::render_pictures({});
  ::testing::InitGoogleTest(&argc, argv);
  if (::testing::GTEST_FLAG(list_tests)) return RUN_ALL_TESTS();
  // Of this process alone.
  const std::filesystem::path home = std::filesystem::temp_directory_path() /
                                     ("psygen_editor_window_" + std::to_string(::getpid()));
  std::filesystem::create_directories(home);
  for (const char* variable : {"XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME"})
    ::setenv(variable, home.c_str(), 1);
  const auto display = psygen::platform::VirtualDisplay::start();
  if (!display) {
    std::fprintf(stderr, "no display: Xvfb or openbox cannot be started (tools/setup.sh)\n");
    return 1;
  }
  ::setenv("QT_QPA_PLATFORM", "xcb", 1);
  const QApplication application(argc, argv);
  QApplication::setOrganizationName("psygen");
  QApplication::setApplicationName("psygen-editor-test");
  const int code = RUN_ALL_TESTS();
  std::error_code ignored;
  std::filesystem::remove_all(home, ignored);
  return code;
}
