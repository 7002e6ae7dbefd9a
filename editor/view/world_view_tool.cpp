// The tool of a view: converts the pointer to points of the ground.
#include "editor/view/world_view.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/scene.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {

void WorldView::set_tool(ViewTool* tool) {
  if (tool == tool_) return;
  if (tool_ != nullptr) {
    tool_->cancel();
    tool_->leave();
  }
  tool_ = tool;
  tool_input_.forget();
  if (tool_ != nullptr) select(std::nullopt);
}

ViewProjection WorldView::view_projection() const {
  const scene::Scene& scene = session_->scene();
  return {camera_.pose(), scene.camera().projection, session_->picture_size(),
          scene.world().block_size_m()};
}

std::optional<QPointF> WorldView::pixel_of(glm::dvec2 at_m) const {
  if (!session_) return std::nullopt;
  const auto pixel = view_projection().pixel_of(on_surface(at_m, session_->scene().world()));
  if (!pixel) return std::nullopt;
  return QPointF(static_cast<double>(pixel->x), static_cast<double>(pixel->y)) / devicePixelRatio();
}

ToolPoint WorldView::point_at(const ToolEvent& event) {
  const scene::Scene& scene = session_->scene();
  const ViewProjection seen = view_projection();
  ToolPoint point;
  point.fine = event.fine;
  point.ground_m =
      ground_.at(scene, seen.pose, direction_of(event.at, seen.size, seen.pose, seen.projection));
  overlay_.set(tool_->marks(), scene.world());
  overlay_.hit(event.at, seen, point);
  return point;
}

// Sends the events since the last frame to the tool.
void WorldView::serve_tool() {
  if (tool_ == nullptr) return;
  using Kind = ToolEvent::Kind;
  for (const ToolEvent& event : tool_input_.take_all()) {
    if (tool_ == nullptr) return;  // an event may exit the tool
    switch (event.kind) {
      case Kind::kPress:
        tool_->press(point_at(event));
        break;
      case Kind::kMove:
        event.held ? tool_->drag(point_at(event)) : tool_->hover(point_at(event));
        break;
      case Kind::kRelease:
        tool_->release();
        break;
      case Kind::kClickRight:
        tool_->click_right(point_at(event));
        break;
      case Kind::kWheel:
        if (!tool_->wheel(point_at(event), event.steps)) input_.turn_wheel(event.steps);
        break;
      case Kind::kLeave:
        tool_->leave();
        break;
    }
  }
}

}  // namespace psygen::editor
