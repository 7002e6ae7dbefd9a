// A held button of a tool: all edits meanwhile are one undo step, which can be taken back. What is
// refused on the way is told once, at the end: on its way the mouse may be anywhere. Main thread.
#pragma once

#include <string>
#include <utility>

#include "editor/tools/tool_host.hpp"

namespace psygen::editor {

class ToolDrag {
 public:
  explicit ToolDrag(const ToolHost& host) : host_(host) {}
  bool active() const { return active_; }

  void begin() {
    active_ = true;
    refused_.clear();
    before_ = host_.document.text();
    host_.set_dragging(true);
  }
  // One of its edits went well or did not.
  void note(const core::Result<void>& edit) {
    refused_ = edit ? QString() : QString::fromStdString(edit.error().message);
  }
  void end() {
    if (!std::exchange(active_, false)) return;
    host_.set_dragging(false);
    if (!refused_.isEmpty()) host_.say(refused_);
  }
  // Ends it with the text that it began with. False: there was none.
  bool take_back() {
    if (!std::exchange(active_, false)) return false;
    host_.tell(host_.document.set_text(before_, QString()));
    host_.set_dragging(false);
    return true;
  }

 private:
  const ToolHost& host_;
  bool active_ = false;
  std::string before_;
  QString refused_;
};

}  // namespace psygen::editor
