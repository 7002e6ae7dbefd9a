// The tests, and with the hidden option the rendering process that they talk to. It has a model
// that ends its process, like a faulty model of a program.
#include <gtest/gtest.h>

#include <QGuiApplication>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "editor/pictures/picture_server.hpp"
#include "tests/editor/pictures/faulty_rock.hpp"

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], psygen::editor::kPicturesOption) == 0)
    return psygen::editor::render_pictures({psygen::editor::testing::faulty_rock_plugin()});
  ::testing::InitGoogleTest(&argc, argv);
  qputenv("QT_QPA_PLATFORM", "offscreen");
  const QGuiApplication application(argc, argv);
  return RUN_ALL_TESTS();
}
