// A document with a world of the tests, a host for tools, and points for the pointer.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "editor/tools/tool_host.hpp"
#include "editor/view/view_tool.hpp"
#include "tests/editor/document/support.hpp"

namespace psygen::editor::testing {

struct Toolbench {
  Place place;
  Document document;
  std::vector<std::string> messages;
  std::string chosen;             // table of the file
  glm::dvec2 around_m{100, 100};  // middle of the view

  explicit Toolbench(const std::string& text = kWorld) : place(text), document(place.options()) {
    EXPECT_TRUE(good(document.open(place.file)));
  }
  ToolHost host() {
    return {
        .document = document,
        .set_dragging = [this](bool on) { on ? void(document.begin_drag()) : document.end_drag(); },
        .show_message = [this](const QString& text) { messages.push_back(text.toStdString()); },
        .chosen = [this](const world::TextPath& table) { chosen = table.text(); },
        .around = [this](double) { return around_m; }};
  }
  int steps() { return document.undo_stack().count(); }
  std::string last_step() { return document.undo_stack().undoText().toStdString(); }
};

inline ToolPoint ground(double x, double z) {
  ToolPoint point;
  point.ground_m = glm::dvec2(x, z);
  return point;
}
inline ToolPoint sky() {
  return {};
}
// The handle of a tool at a point.
inline ToolPoint handle(ViewTool& tool, double x, double z) {
  ToolPoint point = ground(x, z);
  const auto& handles = tool.marks().handles;
  const auto at = std::ranges::find(handles, glm::dvec2(x, z), &ToolMarks::Handle::at_m);
  EXPECT_NE(at, handles.end()) << x << ", " << z;
  if (at != handles.end()) point.handle = static_cast<std::size_t>(at - handles.begin());
  return point;
}

inline void click(ViewTool& tool, const ToolPoint& at) {
  tool.press(at);
  tool.release();
}

}  // namespace psygen::editor::testing
