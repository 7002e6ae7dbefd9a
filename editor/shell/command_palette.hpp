// A line that finds every command of the window and every field of the world by its name
// (Ctrl+Shift+P). Main thread.
#pragma once

#include <QDialog>
#include <functional>
#include <vector>

class QLineEdit;
class QListWidget;

namespace psygen::editor {

// The dialog "Commands". Modal.
class CommandPalette final : public QDialog {
  Q_OBJECT

 public:
  struct Command {
    QString name;
    QString hint;  // the shortcut of a command, or the description of a field
    std::function<void()> run;
  };
  explicit CommandPalette(QWidget* parent);
  // Opens the dialog with these commands.
  void ask(std::vector<Command> commands);

 protected:
  bool eventFilter(QObject* object, QEvent* event) override;

 private:
  void list(const QString& text);
  void run();

  std::vector<Command> commands_;
  QLineEdit* line_;
  QListWidget* list_;
};

// The enabled actions of a window as commands.
std::vector<CommandPalette::Command> commands_of(const QWidget& window);

}  // namespace psygen::editor
