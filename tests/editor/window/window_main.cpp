// Runs the tests of the editor's window on their own display, with their own settings.
#include <gtest/gtest.h>

#include <cstring>

#include "editor/pictures/picture_server.hpp"
#include "tests/editor/own_display.hpp"

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], psygen::editor::kPicturesOption) == 0)
    return psygen::editor::render_pictures({});
  ::testing::InitGoogleTest(&argc, argv);
  if (::testing::GTEST_FLAG(list_tests)) return RUN_ALL_TESTS();
  const auto display = psygen::editor::OwnDisplay::start();
  if (!display) return 1;
  const QApplication application(argc, argv);
  QApplication::setOrganizationName("psygen");
  QApplication::setApplicationName("psygen-editor-test");
  return RUN_ALL_TESTS();
}
