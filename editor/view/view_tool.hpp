// The interface of the tools of the view: a tool gets the pointer as points of the ground and
// returns marks. It knows no window and no pixels, so tests drive it with plain values. The tools
// are in editor/tools. Main thread.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace psygen::editor {

// The marks of a tool. Points are x and z in metres of the world, on the ground or on the water
// above it.
struct ToolMarks {
  // A square of constant size that the user can drag.
  struct Handle {
    glm::dvec2 at_m{0.0};
    bool chosen = false;
    friend bool operator==(const Handle&, const Handle&) = default;
  };
  // Follows the ground between its points.
  struct Line {
    std::vector<glm::dvec2> points_m;
    glm::vec3 colour{1.0F};
    friend bool operator==(const Line&, const Line&) = default;
  };
  std::vector<Handle> handles;
  std::vector<Line> lines;
  friend bool operator==(const ToolMarks&, const ToolMarks&) = default;
};

// The pointer.
struct ToolPoint {
  // A part of a line: the one that follows point number `part`.
  struct OnLine {
    std::size_t line = 0, part = 0;
  };
  std::optional<glm::dvec2> ground_m;  // x and z in the world; nullopt: the sky
  std::optional<std::size_t> handle;   // under the pointer
  std::optional<OnLine> line;          // under the pointer, if there is no handle
  bool fine = false;                   // Shift is held
};

class ViewTool {
 public:
  ViewTool() = default;
  ViewTool(const ViewTool&) = delete;
  ViewTool& operator=(const ViewTool&) = delete;
  virtual ~ViewTool() = default;
  // The left button is pressed, moved while held, and released.
  virtual void press(const ToolPoint& at) = 0;
  virtual void drag(const ToolPoint& at) = 0;
  virtual void release() = 0;
  // The pointer moves without a button, or leaves the view.
  virtual void hover(const ToolPoint&) {}
  virtual void leave() {}
  // The right button was clicked.
  virtual void click_right(const ToolPoint& at) = 0;
  // The wheel turned by some steps. Returns false to leave it to the camera.
  virtual bool wheel(const ToolPoint&, double) { return false; }
  // Undoes the action of the held button, or cancels an unfinished action. Returns false if there
  // is none.
  virtual bool cancel() = 0;
  // The present marks. Valid until the next call of any function.
  virtual const ToolMarks& marks() = 0;
};

}  // namespace psygen::editor
