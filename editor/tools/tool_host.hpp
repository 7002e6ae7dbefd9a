// What the tools of the view work on, and what they tell. One document for all; the window, or a
// test, fills in the rest. Main thread.
#pragma once

#include <QString>
#include <cmath>
#include <functional>
#include <glm/vec2.hpp>

#include "editor/document/document.hpp"

namespace psygen::editor {

struct ToolHost {
  Document& document;
  // Edits between true and false are one undo step.
  std::function<void(bool)> set_dragging;
  // A sentence for the person.
  std::function<void(const QString&)> say;
  // Another thing was chosen: the table of the file that it is; empty: nothing.
  std::function<void(const world::TextPath&)> chosen;
  // A place amid what the view shows (x and z in the world), for a thing of so many metres.
  std::function<glm::dvec2(double size_m)> around;

  // Whether it went well; if not, the person is told why.
  bool tell(const core::Result<void>& result) const {
    if (!result) say(QString::fromStdString(result.error().message));
    return result.has_value();
  }
};

// Points that the mouse puts are written to the decimetre.
inline glm::dvec2 to_decimetres(glm::dvec2 at_m) {
  return {std::round(at_m.x * 10) / 10, std::round(at_m.y * 10) / 10};
}

}  // namespace psygen::editor
