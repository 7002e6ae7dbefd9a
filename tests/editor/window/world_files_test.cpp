// The window mixes up no files: recoveries belong to their world, and worlds that come with psygen
// stay as they are. It needs a display, and says so.
#include <QApplication>
#include <QFileDialog>
#include <QMessageBox>
#include <QProcess>
#include <QTimer>
#include <QUndoStack>
#include <map>

#include "editor/document/qt_text.hpp"
#include "editor/document/recovery.hpp"
#include "tests/editor/window/window_fixture.hpp"

namespace psygen::editor {
namespace {

// Runs the editor without the variables of a display, but with these.
struct Ended {
  int code = -1;
  std::string out, err;
};
Ended ended(const QStringList& arguments, const std::map<QString, QString>& variables) {
  QProcess editor;
  QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"})
    environment.remove(name);
  for (const auto& [name, value] : variables)
    environment.insert(name, value);
  editor.setProcessEnvironment(environment);
  editor.start(QCoreApplication::applicationDirPath() + "/psygen-editor", arguments);
  EXPECT_TRUE(editor.waitForFinished(120'000));
  EXPECT_EQ(editor.exitStatus(), QProcess::NormalExit);
  return {editor.exitCode(), editor.readAllStandardOutput().toStdString(),
          editor.readAllStandardError().toStdString()};
}

TEST(StartOfTheEditor, HelpAndVersionNeedNoDisplay) {
  for (const char* option : {"--help", "--version"}) {
    for (const char* platform : {"xcb", "offscreen"}) {
      const Ended editor = ended({option}, {{"QT_QPA_PLATFORM", platform}});
      EXPECT_EQ(editor.code, 0) << editor.err;
      EXPECT_NE(editor.out.find("psygen-editor"), std::string::npos) << editor.out;
    }
  }
}

TEST(StartOfTheEditor, WithoutX11ItEndsWithASentence) {
  const QString display = qEnvironmentVariable("DISPLAY");
  struct Start {
    QStringList arguments;
    std::map<QString, QString> variables;
    std::string word;
  };
  const std::vector<Start> starts{
      {{}, {}, "DISPLAY is not set"},
      {{"alps"}, {{"DISPLAY", ":4242"}}, "\":4242\" cannot be opened"},
      {{}, {{"DISPLAY", display}, {"QT_QPA_PLATFORM", "offscreen"}}, "\"offscreen\""},
      {{"-platform", "minimal"}, {{"DISPLAY", display}}, "\"minimal\""}};
  for (const auto& [arguments, variables, word] : starts) {
    const Ended editor = ended(arguments, variables);
    EXPECT_EQ(editor.code, 4) << word;
    EXPECT_NE(editor.err.find(word), std::string::npos) << editor.err;
  }
}

}  // namespace
}  // namespace psygen::editor
