// Converts events of a Qt window to the engine's input of a frame. Main thread.
#pragma once

#include <QEvent>
#include <QPointF>
#include <optional>

#include "engine/platform/input.hpp"

namespace psygen::editor {

class ViewInput {
 public:
  // Takes a key, mouse or wheel event; returns false for others. Keeps a click of the left button
  // without motion until take_click().
  bool take(const QEvent& event, double pixel_ratio);
  // Adds a wheel event that a tool did not use.
  void turn_wheel(double steps) { input_.wheel += steps; }
  // The input since the last call.
  platform::InputState take_frame();
  // Position of a click of the left button in device pixels; nullopt: no click.
  std::optional<QPointF> take_click();
  // True while a key or a button is held.
  bool busy() const { return input_.held.any() || input_.buttons_held.any(); }
  // Releases all keys and buttons, as when the window loses the keyboard.
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
