// The window mixes up no files: recoveries belong to their world, and worlds that come with psygen
// stay as they are. It needs a display, and says so.
#include <QApplication>
#include <QFileDialog>
#include <QLineEdit>
#include <QMenu>
#include <QMessageBox>
#include <QProcess>
#include <QPushButton>
#include <QSettings>
#include <QTimer>
#include <QUndoStack>
#include <map>

#include "editor/document/qt_text.hpp"
#include "editor/document/recovery.hpp"
#include "tests/editor/window/window_fixture.hpp"

namespace psygen::editor {
namespace {

// Answers modal dialogs while it exists.
template <class Dialog>
class Answers {
 public:
  explicit Answers(std::function<void(Dialog&)> answer) : answer_(std::move(answer)) {
    QObject::connect(&timer_, &QTimer::timeout, &timer_, [this] {
      auto* dialog = qobject_cast<Dialog*>(QApplication::activeModalWidget());
      if (dialog == nullptr || dialog == last_) return;
      last_ = dialog;
      ++count_;
      answer_(*dialog);
    });
    timer_.start(10);
  }
  int count() const { return count_; }

 private:
  std::function<void(Dialog&)> answer_;
  QTimer timer_;
  Dialog* last_ = nullptr;
  int count_ = 0;
};

class RecoveryInWindow : public EditorWindow {
 protected:
  // Leaves the recovery that an editor leaves when it is killed.
  void leave(const std::string& id, const std::filesystem::path& world_file) {
    const auto state = folder_.path() / "state";
    const auto session = RecoverySession::start(state, {}).value();
    std::string text = kSmallWorld;
    text.replace(text.find("seed = 5"), 8, "seed = 6");
    ASSERT_TRUE(session->write({.world_file = world_file,
                                .text = text,
                                .saved_text = kSmallWorld,
                                .time = {},
                                .file = {}}));
    std::filesystem::copy_file(session->file(), state / (id + ".recovery"));
  }
};

TEST_F(RecoveryInWindow, AWorldGetsOnlyItsOwnChanges) {
  const auto other = folder_.path() / "other" / "small.toml";
  std::filesystem::create_directory(other.parent_path());
  std::filesystem::copy_file(file_, other);
  leave("a", other);
  leave("b", {});
  QString text, about, usual;
  const Answers<QMessageBox> answers([&](QMessageBox& box) {
    text = box.text();
    about = box.informativeText();
    usual = box.defaultButton()->text();
    box.defaultButton()->click();
  });
  ASSERT_TRUE(window_->open_file(file_));
  EXPECT_EQ(answers.count(), 0);
  leave("c", folder_.path() / "other" / ".." / "small.toml");
  ASSERT_TRUE(window_->open_file(file_));
  EXPECT_EQ(answers.count(), 1);
  EXPECT_TRUE(text.contains(to_qstring(file_.string()))) << text.toStdString();
  EXPECT_TRUE(about.contains("Changed lines: 1.")) << about.toStdString();
  EXPECT_EQ(usual, "Recover");
  EXPECT_EQ(document().file(), file_);
  EXPECT_EQ(document().undo_stack().count(), 1);
  EXPECT_EQ(document().world().seed, 6U);
  document().undo_stack().undo();
}

TEST_F(RecoveryInWindow, ANewWorldIsNotReplacedByDefault) {
  leave("a", file_);
  leave("b", {});
  QString text;
  const Answers<QMessageBox> answers([&](QMessageBox& box) {
    text = box.text();
    EXPECT_EQ(box.defaultButton()->text(), "Ask again later");
    box.defaultButton()->click();
  });
  command("New world");
  EXPECT_EQ(answers.count(), 1);
  EXPECT_TRUE(text.contains("a new world")) << text.toStdString();
  EXPECT_TRUE(document().file().empty());
  EXPECT_FALSE(document().is_modified());
  EXPECT_EQ(document().recoveries().size(), 2U);
}

// A file that has changed since then is not replaced by default either.
TEST_F(RecoveryInWindow, AChangedFileIsNotReplacedByDefault) {
  leave("a", file_);
  std::ofstream(file_) << kSmallWorld << "# more\n";
  const Answers<QMessageBox> answers([&](QMessageBox& box) {
    EXPECT_TRUE(box.informativeText().contains("The file has changed since then."));
    EXPECT_EQ(box.defaultButton()->text(), "Ask again later");
    box.defaultButton()->click();
  });
  ASSERT_TRUE(window_->open_file(file_));
  EXPECT_EQ(answers.count(), 1);
  EXPECT_EQ(document().world().seed, 5U);
}

class TemplateInWindow : public EditorWindow {
 protected:
  void adjust(MainWindowOptions& options) override {
    const auto shipped = folder_.path() / "shipped";
    std::filesystem::create_directory(shipped);
    std::filesystem::create_symlink(file_, shipped / "small.toml");
    options.document.shipped_folders = {shipped};
  }
};

TEST_F(TemplateInWindow, TheFirstSaveAsksForAFile) {
  EXPECT_TRUE(window_->windowTitle().contains("small.toml (template)"));
  ASSERT_TRUE(document().set_value({"world", "seed"}, "6"));
  const std::filesystem::path mine = folder_.path() / "mine.toml";
  QString suggested;
  {
    const Answers<QFileDialog> answers([&](QFileDialog& dialog) {
      suggested = dialog.selectedFiles().value(0);
      dialog.reject();
    });
    QTest::keyClick(window_.get(), Qt::Key_S, Qt::ControlModifier);
    EXPECT_EQ(answers.count(), 1);
  }
  EXPECT_FALSE(suggested.startsWith(to_qstring(folder_.path().string())));
  EXPECT_TRUE(suggested.endsWith("/small.toml")) << suggested.toStdString();
  EXPECT_TRUE(document().is_modified());
  {
    const Answers<QFileDialog> answers([&](QFileDialog& dialog) {
      // selectFile() leaves the name alone while the line has the focus.
      dialog.findChild<QLineEdit*>()->setText(to_qstring(mine.string()));
      QMetaObject::invokeMethod(&dialog, "accept");
    });
    QTest::keyClick(window_.get(), Qt::Key_S, Qt::ControlModifier);
  }
  EXPECT_EQ(document().file(), mine);
  EXPECT_FALSE(document().is_modified());
  EXPECT_TRUE(window_->windowTitle().startsWith("mine.toml"))
      << window_->windowTitle().toStdString();
  std::ifstream in(file_);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), kSmallWorld);
}

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
  // An option of Qt, which is no combination of short options.
  EXPECT_EQ(ended({"-reverse"}, {{"QT_QPA_PLATFORM", "offscreen"}}).code, 4);
}

TEST(StartOfTheEditor, WithoutADisplayItEndsWithASentence) {
  const QString display = qEnvironmentVariable("DISPLAY");
  struct Start {
    QStringList arguments;
    std::map<QString, QString> variables;
    std::string word;
  };
  const std::vector<Start> starts{
      {{}, {}, "neither WAYLAND_DISPLAY nor DISPLAY is set"},
      {{}, {{"WAYLAND_DISPLAY", "wayland-4242"}}, "\"wayland-4242\" cannot be opened"},
      {{"-platform", "wayland"}, {{"DISPLAY", display}}, "WAYLAND_DISPLAY is not set"},
      {{"alps"}, {{"DISPLAY", ":4242"}}, "\":4242\" cannot be opened"},
      {{}, {{"DISPLAY", display}, {"QT_QPA_PLATFORM", "offscreen"}}, "\"offscreen\""},
      {{"-platform", "minimal"}, {{"DISPLAY", display}}, "\"minimal\""},
      {{}, {{"DISPLAY", display}, {"QT_QPA_PLATFORM", "xcbx"}}, "error: Qt cannot start: "}};
  for (const auto& [arguments, variables, word] : starts) {
    const Ended editor = ended(arguments, variables);
    EXPECT_EQ(editor.code, 4) << word;
    EXPECT_NE(editor.err.find(word), std::string::npos) << editor.err;
  }
}

// Such a server resets when its last client leaves, and refuses others until it has.
TEST(StartOfTheEditor, MayBeTheOnlyClientOfItsServer) {
  for (int i = 0; i < 4; ++i) {
    QProcess server;
    server.start("Xvfb", {"-displayfd", "1", "-nolisten", "tcp"});
    ASSERT_TRUE(server.waitForReadyRead(60'000));
    const QString display = ":" + QString(server.readLine()).trimmed();
    const Ended editor = ended({"--unknown"}, {{"DISPLAY", display}});
    EXPECT_EQ(editor.code, 2) << editor.err;
    server.terminate();
    server.waitForFinished();
  }
}

TEST_F(EditorWindow, RecentFilesAreUniqueAndNewestFirst) {
  const QString file = to_qstring(file_.string());
  QStringList kept;
  for (int i = 0; i < 20; ++i)
    kept += QString("/%1.toml").arg(i);
  kept.insert(5, file);
  QSettings().setValue("recent_files", kept);
  ASSERT_TRUE(window_->open_file(folder_.path() / "state" / ".." / "small.toml"));
  QStringList listed;
  for (const QMenu* menu : window_->findChildren<QMenu*>()) {
    if (menu->title() != "Open &recent") continue;
    for (const QAction* action : menu->actions())
      listed += action->text();
  }
  kept.removeOne(file);
  kept.prepend(file);
  EXPECT_EQ(listed, kept.mid(0, 12));
}

}  // namespace
}  // namespace psygen::editor
