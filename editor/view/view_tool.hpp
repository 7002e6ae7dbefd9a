// What a tool of the view is asked and shows: it gets the mouse as points of the ground and returns
// marks that lie over the picture. It knows no window and no pixels, so tests drive it with plain
// values. The tools themselves are in editor/tools. Main thread.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

namespace psygen::editor {

// What a tool draws over the view. Points are x and z in metres of the world; they lie on the
// ground, or on the water over it.
struct ToolMarks {
  // A square of constant size, which the mouse can take.
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

// Where the mouse is.
struct ToolPoint {
  // A part of a line: that behind its point number `part`.
  struct OnLine {
    std::size_t line = 0, part = 0;
  };
  std::optional<glm::dvec2> ground_m;  // x and z in the world; nothing: the sky
  std::optional<std::size_t> handle;   // the one under the mouse
  std::optional<OnLine> line;          // the one under the mouse, where no handle is
  bool fine = false;                   // Shift is held
};

class ViewTool {
 public:
  ViewTool() = default;
  ViewTool(const ViewTool&) = delete;
  ViewTool& operator=(const ViewTool&) = delete;
  virtual ~ViewTool() = default;
  // The left button goes down, the mouse moves while it is held, and it goes up.
  virtual void press(const ToolPoint& at) = 0;
  virtual void drag(const ToolPoint& at) = 0;
  virtual void release() = 0;
  // The mouse moves without a button, or leaves the view.
  virtual void hover(const ToolPoint&) {}
  virtual void leave() {}
  // The right button was clicked.
  virtual void click_right(const ToolPoint& at) = 0;
  // The wheel turned by so many steps. False: it is the camera's.
  virtual bool wheel(const ToolPoint&, double) { return false; }
  // Takes back what the held button has done, or what is only begun. False: there is nothing.
  virtual bool cancel() = 0;
  // What is drawn now. Valid until the next call of any function.
  virtual const ToolMarks& marks() = 0;
};

}  // namespace psygen::editor
