// Places single models on the ground: a click places a model of the chosen type, a drag moves one,
// and the wheel turns it. Each click, each drag and each series of turns is one undo step. Other
// parameters are fields of the model's section. Main thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "editor/tools/tool_host.hpp"
#include "editor/view/view_tool.hpp"

namespace psygen::editor {

class PlaceTool final : public ViewTool {
 public:
  static constexpr double kTurnDeg = 15, kFineTurnDeg = 1;  // per step of the wheel

  // The document of the host outlives the tool.
  explicit PlaceTool(ToolHost host) : host_(std::move(host)) {}

  // Model types that can be placed: models from files first, then species, then the others.
  const std::vector<std::string>& types() const;
  // The type that a click places. The first one if the world no longer has the chosen type.
  std::string type() const;
  void set_type(std::string name) { type_ = std::move(name); }

  // The chosen [[place]], on which keys act; nullopt also if it no longer exists.
  void choose(std::optional<std::size_t> place);
  std::optional<std::size_t> place() const;
  // Removes the chosen model, or turns it to the left (about +Y).
  void remove();
  void turn(double degrees);

  void press(const ToolPoint& at) override;
  void drag(const ToolPoint& at) override;
  void release() override { drag_.end(); }
  void hover(const ToolPoint& at) override;
  void leave() override { hover_m_.reset(); }
  // Removes the model under the pointer.
  void click_right(const ToolPoint& at) override;
  // Turns the model under the pointer.
  bool wheel(const ToolPoint& at, double steps) override;
  bool cancel() override { return drag_.cancel(); }
  // Handles of all models, the extent and front of the chosen one, and the extent of the next one.
  const ToolMarks& marks() override;

 private:
  void add(glm::dvec2 at_m);

  ToolHost host_;
  std::string type_;
  std::optional<std::size_t> place_;
  ToolDrag drag_{host_};
  int turn_drag_ = 0;                  // of the last turn; 0: none
  std::optional<std::size_t> turned_;  // the model that was turned last
  std::optional<glm::dvec2> hover_m_;  // where a click places a model
  ToolMarks marks_;
  mutable std::vector<std::string> types_;
  mutable ParsedWorldPtr listed_;  // the world of types_
};

}  // namespace psygen::editor
