#include "editor/view/tool_input.hpp"

#include <QMouseEvent>
#include <QWheelEvent>
#include <utility>

namespace psygen::editor {
namespace {

constexpr double kRightClickPx = 4;      // a click moves less than this
constexpr double kToolWheelUnits = 120;  // of Qt, per step

}  // namespace

bool ToolInput::take(const QEvent& event, double pixel_ratio) {
  using Kind = ToolEvent::Kind;
  switch (event.type()) {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonDblClick:
    case QEvent::MouseButtonRelease:
    case QEvent::MouseMove: {
      const auto& mouse = static_cast<const QMouseEvent&>(event);
      const bool down = event.type() != QEvent::MouseButtonRelease;
      const bool fine = (mouse.modifiers() & Qt::ShiftModifier) != 0;
      last_ = mouse.position() * pixel_ratio;
      if (event.type() == QEvent::MouseMove) {
        add({Kind::kMove, last_, held_, fine});
        return held_;  // else the camera turns
      }
      if (mouse.button() == Qt::LeftButton) {
        held_ = down;
        add({down ? Kind::kPress : Kind::kRelease, last_, down, fine});
        return true;
      }
      if (mouse.button() == Qt::RightButton && down) right_at_ = last_;
      if (mouse.button() == Qt::RightButton && !down &&
          (last_ - right_at_).manhattanLength() < kRightClickPx)
        add({Kind::kClickRight, last_, false, fine});
      return false;
    }
    case QEvent::Wheel: {
      const auto& wheel = static_cast<const QWheelEvent&>(event);
      const bool fine = (wheel.modifiers() & Qt::ShiftModifier) != 0;
      // Some systems make Shift+wheel a horizontal scroll.
      const QPoint turned = wheel.angleDelta();
      const double units = turned.y() != 0 ? turned.y() : turned.x();
      last_ = wheel.position() * pixel_ratio;
      add({Kind::kWheel, last_, held_, fine, units / kToolWheelUnits});
      return true;
    }
    case QEvent::Leave:
      add({Kind::kLeave, last_});
      return false;
    default:
      return false;
  }
}

void ToolInput::add(ToolEvent event) {
  const bool moves = event.kind == ToolEvent::Kind::kMove;
  if (moves && !events_.empty() && events_.back().kind == ToolEvent::Kind::kMove)
    events_.back() = event;
  else
    events_.push_back(event);
}

std::vector<ToolEvent> ToolInput::take_all() {
  return std::exchange(events_, {});
}

void ToolInput::forget() {
  events_.clear();
  held_ = false;
}

}  // namespace psygen::editor
