// Converts events of a Qt window to the engine's input of a frame. Events for a tool are queued
// until the next frame, because they refer to points of the drawn world. Main thread.
#pragma once

#include <QEvent>
#include <QPointF>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/platform/input.hpp"

namespace psygen::editor {

// An event of the mouse for a tool.
struct ToolEvent {
  enum class Kind : std::uint8_t { kPress, kMove, kRelease, kClickRight, kWheel, kLeave };
  Kind kind = Kind::kMove;
  QPointF at = {};    // device pixels
  bool held = false;  // the left button, of a move
  bool fine = false;  // Shift
  double steps = 0;   // of the wheel
};

class ViewInput {
 public:
  // Takes a key, mouse or wheel event; returns false for others. Keeps a click of the left button
  // without motion until take_click(). With a tool, the camera gets only the keys, the middle
  // button, and drags of the right button.
  bool take(const QEvent& event, double pixel_ratio, bool has_tool);
  // The events for the tool since the last call; of consecutive moves only the last one.
  std::vector<ToolEvent> take_tool_events() { return std::exchange(tool_events_, {}); }
  // Drops the events for the tool and releases its button.
  void forget_tool();
  // Adds a wheel event that a tool did not use.
  void turn_wheel(double steps) { input_.wheel += steps; }
  // The input since the last call.
  platform::InputState take_frame();
  // Position of a click of the left button in device pixels; nullopt: no click.
  std::optional<QPointF> take_click();
  // The pointer in device pixels; nullopt: outside the window.
  std::optional<QPointF> pointer() const { return pointer_; }
  // True while a key or a button is held.
  bool busy() const { return input_.held.any() || input_.buttons_held.any() || tool_holds_; }
  // Releases all keys and buttons, as when the window loses the keyboard.
  void release_all();

 private:
  bool take_for_tool(const QEvent& event, double pixel_ratio);
  void key(const QEvent& event);
  void button(const QEvent& event, double pixel_ratio);
  void move(const QEvent& event, double pixel_ratio);

  platform::InputState input_;
  QPointF last_, pressed_at_;
  std::optional<QPointF> click_, pointer_;
  std::vector<ToolEvent> tool_events_;
  bool tool_holds_ = false;  // the left button
};

}  // namespace psygen::editor
