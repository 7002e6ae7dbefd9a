// Draws roads on the ground: a click adds a point to the chosen road, a drag moves a point, and a
// click on the road inserts one. Each click and each drag is one undo step. It changes only points:
// width and borders are fields of the road's section. Main thread.
#pragma once

#include <optional>
#include <vector>

#include "editor/tools/tool_host.hpp"
#include "editor/view/view_tool.hpp"

namespace psygen::editor {

// At most one road and one of its points are chosen.
class RoadTool final : public ViewTool {
 public:
  explicit RoadTool(ToolHost host) : host_(std::move(host)) {}

  // The road that clicks extend; nullopt: the next two clicks make a new road.
  void choose(std::optional<std::size_t> road);
  // nullopt also if the road no longer exists, for example after undo.
  std::optional<std::size_t> road() const;
  std::optional<std::size_t> chosen_point() const;
  // Removes the chosen point, or the whole road if only one point would remain.
  void remove();

  void press(const ToolPoint& at) override;
  void drag(const ToolPoint& at) override;
  void release() override { drag_.end(); }
  // Removes the point under the pointer.
  void click_right(const ToolPoint& at) override;
  bool cancel() override;
  // The lines of all roads, and the handles of the chosen one.
  const ToolMarks& marks() override;

 private:
  using Points = std::vector<glm::dvec2>;
  const Points& points() const;  // of the chosen road
  core::Result<void> set_points(const Points& points, const QString& step);
  void add_point(glm::dvec2 at_m, const std::optional<ToolPoint::OnLine>& on_line);
  void add_road(glm::dvec2 from_m, glm::dvec2 to_m);

  ToolHost host_;
  std::optional<std::size_t> road_, point_;
  std::optional<glm::dvec2> begun_;  // the first point of a new road
  ToolDrag drag_{host_};
  // The inputs of marks_.
  struct Shown {
    ParsedWorldPtr world;
    std::optional<std::size_t> road, point;
    std::optional<glm::dvec2> begun;
    friend bool operator==(const Shown&, const Shown&) = default;
  } shown_;
  ToolMarks marks_;
  std::vector<std::vector<std::size_t>> parts_;  // per line and part: the preceding road point
};

}  // namespace psygen::editor
