#include "editor/view/view_input.hpp"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>
#include <algorithm>
#include <iterator>
#include <utility>

namespace psygen::editor {
namespace {

using platform::Key;
using platform::MouseButton;

constexpr double kClickPx = 4;       // a click moves less than this
constexpr double kWheelUnits = 120;  // of Qt, per step

std::optional<Key> key_of(int key) {
  if (key >= Qt::Key_A && key <= Qt::Key_Z)
    return static_cast<Key>(static_cast<int>(Key::kA) + key - Qt::Key_A);
  constexpr std::pair<int, Key> kKeys[] = {{Qt::Key_Up, Key::kUp},
                                           {Qt::Key_Down, Key::kDown},
                                           {Qt::Key_Left, Key::kLeft},
                                           {Qt::Key_Right, Key::kRight},
                                           {Qt::Key_Shift, Key::kShift}};
  const auto* const known = std::ranges::find(kKeys, key, &std::pair<int, Key>::first);
  return known != std::end(kKeys) ? std::optional(known->second) : std::nullopt;
}

std::optional<MouseButton> button_of(Qt::MouseButton button) {
  if (button == Qt::LeftButton) return MouseButton::kLeft;
  if (button == Qt::RightButton) return MouseButton::kRight;
  if (button == Qt::MiddleButton) return MouseButton::kMiddle;
  return std::nullopt;
}

}  // namespace

bool ViewInput::take(const QEvent& event, double pixel_ratio, bool has_tool) {
  if (event.type() == QEvent::MouseMove)
    pointer_ = static_cast<const QMouseEvent&>(event).position() * pixel_ratio;
  if (event.type() == QEvent::Leave) pointer_ = std::nullopt;
  if (has_tool && take_for_tool(event, pixel_ratio)) return true;
  switch (event.type()) {
    case QEvent::KeyPress:
    case QEvent::KeyRelease:
      key(event);
      return true;
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonRelease:
      button(event, pixel_ratio);
      return true;
    case QEvent::MouseMove:
      move(event, pixel_ratio);
      return true;
    case QEvent::Wheel:
      input_.wheel += static_cast<const QWheelEvent&>(event).angleDelta().y() / kWheelUnits;
      return true;
    default:
      return false;
  }
}

// Queues an event. Returns true if only the tool gets it.
bool ViewInput::take_for_tool(const QEvent& event, double pixel_ratio) {
  using Kind = ToolEvent::Kind;
  switch (event.type()) {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonRelease:
    case QEvent::MouseMove: {
      const auto& mouse = static_cast<const QMouseEvent&>(event);
      const bool down = event.type() != QEvent::MouseButtonRelease;
      const bool fine = (mouse.modifiers() & Qt::ShiftModifier) != 0;
      const QPointF at = mouse.position() * pixel_ratio;
      if (event.type() == QEvent::MouseMove) {
        const bool follows = !tool_events_.empty() && tool_events_.back().kind == Kind::kMove;
        if (follows) tool_events_.pop_back();
        tool_events_.push_back({Kind::kMove, at, tool_holds_, fine});
        return tool_holds_;  // else the camera turns
      }
      if (mouse.button() == Qt::LeftButton) {
        tool_holds_ = down;
        tool_events_.push_back({down ? Kind::kPress : Kind::kRelease, at, down, fine});
        return true;
      }
      if (mouse.button() == Qt::RightButton && down) pressed_at_ = at;
      if (mouse.button() == Qt::RightButton && !down &&
          (at - pressed_at_).manhattanLength() < kClickPx)
        tool_events_.push_back({Kind::kClickRight, at, false, fine});
      return false;
    }
    case QEvent::Wheel: {
      const auto& wheel = static_cast<const QWheelEvent&>(event);
      const bool fine = (wheel.modifiers() & Qt::ShiftModifier) != 0;
      // Some systems make Shift+wheel a horizontal scroll.
      const QPoint turned = wheel.angleDelta();
      const double units = turned.y() != 0 ? turned.y() : turned.x();
      tool_events_.push_back(
          {Kind::kWheel, wheel.position() * pixel_ratio, tool_holds_, fine, units / kWheelUnits});
      return true;
    }
    case QEvent::Leave:
      tool_events_.push_back({.kind = Kind::kLeave});
      return false;
    default:
      return false;
  }
}

void ViewInput::forget_tool() {
  tool_events_.clear();
  tool_holds_ = false;
}

void ViewInput::key(const QEvent& event) {
  const auto& key = static_cast<const QKeyEvent&>(event);
  const std::optional<Key> known = key_of(key.key());
  if (!known || key.isAutoRepeat()) return;
  const auto at = static_cast<std::size_t>(*known);
  const bool down = event.type() == QEvent::KeyPress;
  // Shortcuts do not move the camera.
  if (down && (key.modifiers() & (Qt::ControlModifier | Qt::AltModifier)) != 0) return;
  input_.held.set(at, down);
  (down ? input_.went_down : input_.went_up).set(at);
}

void ViewInput::button(const QEvent& event, double pixel_ratio) {
  const auto& mouse = static_cast<const QMouseEvent&>(event);
  const std::optional<MouseButton> known = button_of(mouse.button());
  if (!known) return;
  const auto at = static_cast<std::size_t>(*known);
  const bool down = event.type() == QEvent::MouseButtonPress;
  input_.buttons_held.set(at, down);
  (down ? input_.buttons_went_down : input_.buttons_went_up).set(at);
  const QPointF place = mouse.position() * pixel_ratio;
  last_ = place;
  if (down) pressed_at_ = place;
  const bool still = (place - pressed_at_).manhattanLength() < kClickPx;
  if (!down && *known == MouseButton::kLeft && still) click_ = place;
}

void ViewInput::move(const QEvent& event, double pixel_ratio) {
  const QPointF place = static_cast<const QMouseEvent&>(event).position() * pixel_ratio;
  const QPointF by = place - std::exchange(last_, place);
  input_.move_px += glm::dvec2(by.x(), by.y());
  input_.pointer_px = {place.x(), place.y()};
}

platform::InputState ViewInput::take_frame() {
  input_.looking = input_.is_held(MouseButton::kRight);
  platform::InputState frame = input_;
  if (frame.looking) frame.look_px = frame.move_px;
  platform::clear_changes(input_);
  return frame;
}

std::optional<QPointF> ViewInput::take_click() {
  return std::exchange(click_, std::nullopt);
}

void ViewInput::release_all() {
  input_.held.reset();
  input_.buttons_held.reset();
}

}  // namespace psygen::editor
