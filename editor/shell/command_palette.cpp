#include "editor/shell/command_palette.hpp"

#include <QAction>
#include <QKeyEvent>
#include <QLineEdit>
#include <QListWidget>
#include <QMenu>
#include <QVBoxLayout>
#include <algorithm>

namespace psygen::editor {
namespace {

// True if all words of `text` occur in `name`, in upper or lower case.
bool has_words(const QString& name, const QString& text) {
  const QStringList words = text.split(' ', Qt::SkipEmptyParts);
  return std::ranges::all_of(
      words, [&](const QString& word) { return name.contains(word, Qt::CaseInsensitive); });
}

}  // namespace

std::vector<CommandPalette::Command> commands_of(const QWidget& window) {
  std::vector<CommandPalette::Command> commands;
  for (QAction* action : window.findChildren<QAction*>()) {
    if (action->text().isEmpty() || action->menu() != nullptr || !action->isEnabled() ||
        !action->isVisible())
      continue;
    commands.push_back({.name = action->text().remove('&'),
                        .hint = action->shortcut().toString(),
                        .run = [action] { action->trigger(); }});
  }
  return commands;
}

CommandPalette::CommandPalette(QWidget* parent)
    : QDialog(parent), line_(new QLineEdit), list_(new QListWidget) {
  setWindowTitle(tr("Commands"));
  setModal(true);
  resize(520, 360);
  line_->setPlaceholderText(tr("Type a command or a field"));
  line_->setAccessibleName(tr("Command or field"));
  list_->setAccessibleName(tr("Commands and fields that match"));
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(line_);
  layout->addWidget(list_);
  line_->installEventFilter(this);
  connect(line_, &QLineEdit::textChanged, this, &CommandPalette::list);
  connect(line_, &QLineEdit::returnPressed, this, &CommandPalette::run);
  connect(list_, &QListWidget::itemActivated, this, &CommandPalette::run);
}

void CommandPalette::ask(std::vector<Command> commands) {
  commands_ = std::move(commands);
  line_->clear();
  list({});
  open();
  line_->setFocus();
}

void CommandPalette::list(const QString& text) {
  list_->clear();
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    const Command& command = commands_[i];
    if (!has_words(command.name, text)) continue;
    auto* item = new QListWidgetItem(
        command.hint.isEmpty() ? command.name : command.name + "    " + command.hint, list_);
    item->setData(Qt::UserRole, static_cast<int>(i));
  }
  list_->setCurrentRow(0);
}

void CommandPalette::run() {
  const QListWidgetItem* item = list_->currentItem();
  if (item == nullptr) return;
  const auto run = commands_[static_cast<std::size_t>(item->data(Qt::UserRole).toInt())].run;
  accept();
  run();
}

// Arrows move in the list while the line has the keyboard.
bool CommandPalette::eventFilter(QObject* object, QEvent* event) {
  if (object == line_ && event->type() == QEvent::KeyPress) {
    const int key = static_cast<QKeyEvent*>(event)->key();
    if (key == Qt::Key_Down || key == Qt::Key_Up) {
      const int row = list_->currentRow() + (key == Qt::Key_Down ? 1 : -1);
      list_->setCurrentRow(std::clamp(row, 0, std::max(list_->count() - 1, 0)));
      return true;
    }
  }
  return QDialog::eventFilter(object, event);
}

}  // namespace psygen::editor
