// Events of a Qt window as the engine's input of a frame. Main thread.
#pragma once

#include <QEvent>
#include <QPointF>
#include <optional>

#include "engine/platform/input.hpp"

namespace psygen::editor {

class ViewInput {
 public:
  // Takes a key, mouse or wheel event; false for others. A click with the left button that did not
  // move is kept until take_click().
  bool take(const QEvent& event, double pixel_ratio);
  // A wheel event that was somebody else's at first.
  void turn_wheel(double steps) { input_.wheel += steps; }
  // The input since the last call.
  platform::InputState take_frame();
  // Where the left button was clicked, in device pixels; nothing if it was not.
  std::optional<QPointF> take_click();
  // Whether the person does anything with keys or buttons now.
  bool busy() const { return input_.held.any() || input_.buttons_held.any(); }
  // Everything is let go, as when the window loses the keyboard.
  void release_all();

 private:
  void key(const QEvent& event);
  void button(const QEvent& event, double pixel_ratio);
  void move(const QEvent& event, double pixel_ratio);

  platform::InputState input_;
  QPointF last_, pressed_at_;
  std::optional<QPointF> click_;
};

}  // namespace psygen::editor
