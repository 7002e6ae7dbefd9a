// Runs the tests of the editor's window on a Wayland display of their own.
#include <gtest/gtest.h>

#include <cstring>

#include "editor/pictures/picture_server.hpp"
#include "editor/view/window_surface.hpp"
#include "tests/editor/own_display.hpp"
#include "tests/editor/wayland/display.hpp"

namespace psygen::editor {
namespace {

std::unique_ptr<platform::WaylandDisplay> own_display;

}  // namespace

platform::WaylandDisplay& display() {
  return *own_display;
}

int run_tests(int argc, char** argv) {
  const OwnFolders folders;
  own_display = platform::WaylandDisplay::start("us");
  if (!own_display) {
    std::fprintf(stderr, "these tests need sway, xkbcli and Python 3 (tools/setup.sh --test)\n");
    return 1;
  }
  ::unsetenv("QT_QPA_PLATFORM");
  const auto chosen = require_display({argv, static_cast<std::size_t>(argc)});
  if (!chosen) {
    std::fprintf(stderr, "%s\n", chosen.error().message.c_str());
    return 1;
  }
  int code = 1;
  {
    const QApplication application(argc, argv);
    QApplication::setOrganizationName("psygen");
    QApplication::setApplicationName("psygen-editor-test");
    code = RUN_ALL_TESTS();
  }
  own_display.reset();
  return code;
}

}  // namespace psygen::editor

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], psygen::editor::kPicturesOption) == 0)
    return psygen::editor::render_pictures({});
  ::testing::InitGoogleTest(&argc, argv);
  if (::testing::GTEST_FLAG(list_tests)) return RUN_ALL_TESTS();
  return psygen::editor::run_tests(argc, argv);
}
