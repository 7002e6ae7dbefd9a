// Tests of the editor's window run on a display of their own, with settings of their own.
#include <gtest/gtest.h>

#include <QApplication>
#include <cstdlib>

#include "tests/engine/platform/virtual_display.hpp"
#include "tests/temporary_folder.hpp"

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (::testing::GTEST_FLAG(list_tests)) return RUN_ALL_TESTS();
  const psygen::TemporaryFolder home("editor-window");
  for (const char* variable : {"XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME"})
    ::setenv(variable, home.path().c_str(), 1);
  const auto display = psygen::platform::VirtualDisplay::start();
  if (!display) {
    std::fprintf(stderr, "no display: Xvfb or openbox cannot be started (tools/setup.sh)\n");
    return 1;
  }
  ::setenv("QT_QPA_PLATFORM", "xcb", 1);
  const QApplication application(argc, argv);
  QApplication::setOrganizationName("psygen");
  QApplication::setApplicationName("psygen-editor-test");
  return RUN_ALL_TESTS();
}
