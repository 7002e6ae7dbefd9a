#include "editor/panels/message_log.hpp"

#include <QDateTime>
#include <QStatusBar>

#include "editor/document/qt_text.hpp"

namespace psygen::editor {
namespace {

constexpr int kShownMs = 10'000;

}  // namespace

MessageLog::MessageLog(QStatusBar& status_bar) : status_bar_(status_bar) {
  setReadOnly(true);
  setAccessibleName(tr("Messages"));
  setPlaceholderText(tr("Messages appear here."));
  setFrameShape(QFrame::NoFrame);
}

void MessageLog::show_message(const QString& message) {
  status_bar_.showMessage(message, kShownMs);
  appendPlainText(QDateTime::currentDateTime().toString("HH:mm:ss  ") + message);
}

bool MessageLog::check(const core::Result<void>& result) {
  if (!result) show_message(to_qstring(result.error().message));
  return result.has_value();
}

}  // namespace psygen::editor
