#include "editor/tools/road_tool.hpp"

#include <algorithm>
#include <utility>

#include "editor/document/qt_text.hpp"
#include "engine/world/curve.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/toml_values.hpp"
#include "engine/world/shaped_ground.hpp"

namespace psygen::editor {
namespace {

constexpr double kMinStepM = 2, kStepFraction = 1.0 / 2000;  // of a road's length, for its line
const glm::vec3 kRoadColour{0.75F, 0.78F, 0.85F}, kChosenRoadColour{1.0F, 0.62F, 0.1F};

std::string toml_points_of(const std::vector<glm::dvec2>& points) {
  std::string text;
  for (const glm::dvec2& point : points) {
    const double pair[] = {point.x, point.y};
    text += (text.empty() ? "" : ", ") + world::toml_vector(pair);
  }
  return "[" + text + "]";
}

}  // namespace

void RoadTool::choose(std::optional<std::size_t> road) {
  cancel();
  road_ = road;
  point_.reset();
  begun_.reset();
  host_.chosen(this->road() ? world::TextPath{"road", *road_} : world::TextPath{});
}

std::optional<std::size_t> RoadTool::road() const {
  const bool there = road_ && *road_ < host_.document.world().shaped.roads.size();
  return there ? road_ : std::nullopt;
}

std::optional<std::size_t> RoadTool::chosen_point() const {
  const bool there = road() && point_ && *point_ < points().size();
  return there ? point_ : std::nullopt;
}

const RoadTool::Points& RoadTool::points() const {
  return host_.document.world().shaped.roads[*road_].points_m;
}

core::Result<void> RoadTool::set_points(const Points& points, const QString& step) {
  const world::TextPath path{"road", *road_, "points_m"};
  return host_.document.edit(step.arg(*road_ + 1), [&](std::string_view text) {
    return world::with_value(text, path, toml_points_of(points));
  });
}

void RoadTool::press(const ToolPoint& at) {
  if (at.handle) {
    if (!road()) return;  // the first point of a new road
    point_ = *at.handle;
    return drag_.begin();
  }
  if (at.line && !road() && !begun_) return choose(at.line->line);
  if (!at.ground_m) return host_.show_message(tr("There is no ground here. Click on the ground."));
  const glm::dvec2 at_m = to_decimetres(*at.ground_m);
  if (road()) {
    drag_.begin();
    return add_point(at_m, at.line && at.line->line == *road_ ? at.line : std::nullopt);
  }
  if (!begun_) {
    begun_ = at_m;
    return host_.show_message(tr("Click the next point of the road."));
  }
  drag_.begin();
  add_road(*begun_, at_m);
}

void RoadTool::add_point(glm::dvec2 at_m, const std::optional<ToolPoint::OnLine>& on_line) {
  Points now = points();
  // Between two points, before the first point if that is chosen, else after the last one.
  std::size_t place = chosen_point() == std::size_t{0} ? 0 : now.size();
  if (on_line) place = parts_[on_line->line][on_line->part] + 1;
  now.insert(now.begin() + static_cast<std::ptrdiff_t>(place), at_m);
  if (host_.check(set_points(now, tr("Add a point to road %1"))))
    point_ = place;
  else
    drag_.cancel();
}

void RoadTool::add_road(glm::dvec2 from_m, glm::dvec2 to_m) {
  const std::size_t count = host_.document.world().shaped.roads.size();
  const QString step = tr("Add road %1").arg(count + 1);
  const bool added = host_.check(host_.document.edit(step, [&](std::string_view text) {
    return world::with_table_appended(text, {"road"},
                                      "points_m = " + toml_points_of({from_m, to_m}) + "\n");
  }));
  if (!added) {
    drag_.cancel();
    return;
  }
  begun_.reset();
  road_ = count;
  point_ = 1;
  if (road()) host_.chosen({"road", *road_});
}

void RoadTool::drag(const ToolPoint& at) {
  if (!drag_.active() || !chosen_point() || !at.ground_m) return;
  Points now = points();
  now[*point_] = to_decimetres(*at.ground_m);
  drag_.note(set_points(now, tr("Move a point of road %1")));
}

bool RoadTool::cancel() {
  const bool begun = std::exchange(begun_, std::nullopt).has_value();
  return drag_.cancel() || begun;
}

void RoadTool::click_right(const ToolPoint& at) {
  if (!at.handle || drag_.active()) return;
  if (road()) point_ = *at.handle;
  remove();
}

void RoadTool::remove() {
  if (drag_.active()) return;
  if (begun_) return begun_.reset();
  if (!chosen_point()) return host_.show_message(tr("Click on a point of a road first."));
  if (points().size() > 2) {
    Points now = points();
    now.erase(now.begin() + static_cast<std::ptrdiff_t>(*point_));
    if (host_.check(set_points(now, tr("Remove a point of road %1"))) && *point_ > 0) --*point_;
    return;
  }
  if (!host_.check(host_.document.remove_table({"road", *road_}))) return;
  choose(std::nullopt);
  host_.show_message(tr("Removed the road, because a road needs two points. Undo restores it."));
}

const ToolMarks& RoadTool::marks() {
  Shown now{host_.document.parsed(), road(), chosen_point(), begun_};
  if (now == shown_) return marks_;
  shown_ = std::move(now);
  marks_ = {};
  parts_.clear();
  const std::vector<world::Road>& roads = shown_.world->world.shaped.roads;
  for (std::size_t i = 0; i < roads.size(); ++i) {
    ToolMarks::Line& line = marks_.lines.emplace_back();
    std::vector<std::size_t>& parts = parts_.emplace_back();
    line.colour = shown_.road == i ? kChosenRoadColour : kRoadColour;
    const double step_m = std::max(kMinStepM, world::chords_m(roads[i].points_m) * kStepFraction);
    for (const world::CurvePoint& point : world::curve_through(roads[i].points_m, step_m)) {
      line.points_m.push_back(point.at_m);
      parts.push_back(point.after);
    }
  }
  if (begun_) marks_.handles.push_back({*begun_, true});
  if (shown_.road && !begun_) {
    for (const glm::dvec2& point : points())
      marks_.handles.push_back({point, shown_.point == marks_.handles.size()});
  }
  return marks_;
}

}  // namespace psygen::editor
