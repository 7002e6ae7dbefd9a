// The drag of a tool: all edits while the button is held are one undo step, which can be cancelled.
// Errors during the drag become one message at its end, because the pointer may pass over invalid
// places. Main thread.
#pragma once

#include <string>
#include <utility>

#include "editor/tools/tool_host.hpp"

namespace psygen::editor {

// The host outlives the drag.
class ToolDrag {
 public:
  explicit ToolDrag(const ToolHost& host) : host_(host) {}
  bool active() const { return active_; }

  void begin() {
    active_ = true;
    error_.clear();
    before_ = host_.document.text();
    host_.set_dragging(true);
  }
  // Records the result of an edit during the drag.
  void note(const core::Result<void>& edit) {
    error_ = edit ? QString() : QString::fromStdString(edit.error().message);
  }
  void end() {
    if (!std::exchange(active_, false)) return;
    host_.set_dragging(false);
    if (!error_.isEmpty()) host_.show_message(error_);
  }
  // Ends the drag and restores the text of its start. Returns false if no drag was active.
  bool cancel() {
    if (!std::exchange(active_, false)) return false;
    host_.check(host_.document.set_text(before_, QString()));
    host_.set_dragging(false);
    return true;
  }

 private:
  const ToolHost& host_;
  bool active_ = false;
  std::string before_;
  QString error_;
};

}  // namespace psygen::editor
