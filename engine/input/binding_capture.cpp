#include "engine/input/binding_capture.hpp"

namespace psygen::input {
namespace {

constexpr double kPressedAt = 0.7, kAtRest = 0.3;  // values of axes

bool can_be_captured(Control control) {
  using platform::Key;
  return control.device != Device::kMouse && control != Control(Key::kShift) &&
         control != Control(Key::kControl) && control != Control(Key::kAlt);
}

bool is_pressed(Control control, const Reading& reading) {
  if (is_digital(control)) return reading.went_down;
  return reading.value >= (is_relative(control) ? 1.0 : kPressedAt);
}

}  // namespace

BindingCapture::BindingCapture(const platform::InputState& now) {
  for (const Control control : all_controls())
    armed_.push_back(is_relative(control) || read(control, now).value <= kAtRest);
}

std::optional<Control> BindingCapture::update(const platform::InputState& input) {
  std::optional<Control> pressed;
  for (std::size_t i = 0; i < armed_.size(); ++i) {
    const Control control = all_controls()[i];
    const Reading reading = read(control, input);
    if (!pressed && armed_[i] && can_be_captured(control) && is_pressed(control, reading))
      pressed = control;
    if (!is_relative(control)) armed_[i] = armed_[i] || reading.value <= kAtRest;
  }
  return pressed;
}

}  // namespace psygen::input
