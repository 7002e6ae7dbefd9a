// A line that finds every command of the window and every field of the world by its name
// (Ctrl+Shift+P). Main thread.
#pragma once

#include <QDialog>
#include <functional>
#include <vector>

class QLineEdit;
class QListWidget;

namespace psygen::editor {

class CommandPalette final : public QDialog {
  Q_OBJECT

 public:
  struct Command {
    QString name, hint;  // hint: the shortcut, or what a field does
    std::function<void()> run;
  };
  explicit CommandPalette(QWidget* parent);
  // Opens with these commands.
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

// Whether all words of `text` occur in `name`, in any case.
bool is_found(const QString& name, const QString& text);

}  // namespace psygen::editor
