// The panel "Messages": results and errors of commands, with their time. Main thread.
#pragma once

#include <QPlainTextEdit>

#include "engine/core/error.hpp"

class QStatusBar;

namespace psygen::editor {

// Keeps all messages until the window closes.
class MessageLog final : public QPlainTextEdit {
  Q_OBJECT

 public:
  // The status bar outlives the panel.
  explicit MessageLog(QStatusBar& status_bar);

  // Shows a message in the status bar for ten seconds and appends it to the panel.
  void show_message(const QString& message);
  // Shows the error message of a failed call. Returns true if the call succeeded.
  bool check(const core::Result<void>& result);

 private:
  QStatusBar& status_bar_;
};

}  // namespace psygen::editor
