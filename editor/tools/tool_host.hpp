// The environment of the tools: the document that they edit, and functions of the window or of a
// test. Main thread.
#pragma once

#include <QString>
#include <cmath>
#include <functional>
#include <glm/vec2.hpp>
#include <numbers>
#include <utility>

#include "editor/document/document.hpp"
#include "editor/document/qt_text.hpp"
#include "editor/view/view_tool.hpp"

namespace psygen::editor {

struct ToolHost {
  Document& document;
  // Edits between true and false are one undo step.
  std::function<void(bool)> set_dragging;
  // Shows a message to the user.
  std::function<void(const QString&)> show_message;
  // The tool has chosen a table of the file; empty: none.
  std::function<void(const world::TextPath&)> chosen;
  // Returns a point in the middle of the view (x and z in metres of the world), for an area with a
  // side of `size_m`.
  std::function<glm::dvec2(double size_m)> around;

  // Shows the error message of a failed call. Returns true if the call succeeded.
  bool check(const core::Result<void>& result) const {
    if (!result) show_message(to_qstring(result.error().message));
    return result.has_value();
  }
};

// The drag of a tool: all edits while the button is held are one undo step, which can be cancelled.
// Errors during the drag become one message at its end, because the pointer may pass over invalid
// places. The host outlives the drag.
class ToolDrag {
 public:
  explicit ToolDrag(const ToolHost& host) : host_(host) {}
  bool active() const { return active_; }

  void begin() {
    active_ = true;
    error_.clear();
    host_.set_dragging(true);
  }
  // Records the result of an edit during the drag.
  void note(const core::Result<void>& edit) {
    error_ = edit ? QString() : to_qstring(edit.error().message);
  }
  void end() {
    if (!std::exchange(active_, false)) return;
    host_.set_dragging(false);
    if (!error_.isEmpty()) host_.show_message(error_);
  }
  // Ends the drag and restores the text of its start. Returns false if no drag was active.
  bool cancel() {
    if (!std::exchange(active_, false)) return false;
    host_.check(host_.document.cancel_drag());
    host_.set_dragging(false);
    return true;
  }

 private:
  const ToolHost& host_;
  bool active_ = false;
  QString error_;
};

// Rounds a point of the pointer to decimetres, for the file.
inline glm::dvec2 to_decimetres(glm::dvec2 at_m) {
  return {std::round(at_m.x * 10) / 10, std::round(at_m.y * 10) / 10};
}

// Returns a circle on the ground as a mark: a brush, or the extent of a model. `middle_m`: x and z
// in metres of the world.
inline ToolMarks::Line circle_mark(glm::dvec2 middle_m, double radius_m, const glm::vec3& colour) {
  constexpr int kPoints = 48;
  ToolMarks::Line line;
  line.colour = colour;
  for (int i = 0; i <= kPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPoints;
    line.points_m.push_back(middle_m + radius_m * glm::dvec2(std::sin(angle), std::cos(angle)));
  }
  return line;
}

}  // namespace psygen::editor
