// Single models, put on the ground by hand: a click places one of the chosen type, dragging moves
// one, and the wheel over it turns it. Each click, drag and run of turns is one undo step. Other
// parameters are fields of the model's section. Main thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "editor/tools/tool_drag.hpp"
#include "editor/tools/tool_host.hpp"
#include "editor/view/view_tool.hpp"

namespace psygen::editor {

class PlaceTool final : public ViewTool {
 public:
  static constexpr double kTurnDeg = 15, kFineTurnDeg = 1;  // per step of the wheel

  explicit PlaceTool(ToolHost host) : host_(std::move(host)) {}

  // What can be placed: models of the file first, then its species, then the others.
  const std::vector<std::string>& types() const;
  // Of what is placed next. Where the world has lost it, the first one.
  std::string type() const;
  void set_type(std::string name) { type_ = std::move(name); }

  // The [[place]] that keys work on; nothing too where it is gone.
  void choose(std::optional<std::size_t> place);
  std::optional<std::size_t> place() const;
  // Removes the chosen one, or turns it about +Y, to the left.
  void remove();
  void turn(double degrees);

  void press(const ToolPoint& at) override;
  void drag(const ToolPoint& at) override;
  void release() override { drag_.end(); }
  void hover(const ToolPoint& at) override;
  void leave() override { hover_m_.reset(); }
  // Removes the one under the mouse.
  void click_right(const ToolPoint& at) override;
  // Turns the one under the mouse.
  bool wheel(const ToolPoint& at, double steps) override;
  bool cancel() override { return drag_.take_back(); }
  // Handles of all, the outline and front of the chosen one, and the outline of the next one.
  const ToolMarks& marks() override;

 private:
  void add(glm::dvec2 at_m);

  ToolHost host_;
  std::string type_;
  std::optional<std::size_t> place_;
  ToolDrag drag_{host_};
  int turn_drag_ = 0;                  // of the last turn; 0: none
  std::optional<std::size_t> turned_;  // what it turned
  std::optional<glm::dvec2> hover_m_;  // where a click would place one
  ToolMarks marks_;
  mutable std::vector<std::string> types_;
  mutable ParsedWorldPtr listed_;  // what they were listed of
};

}  // namespace psygen::editor
