#include "engine/input/control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/nearest_word.hpp"
#include "engine/core/utf8.hpp"

namespace psygen::input {
namespace {

using namespace std::string_view_literals;
using platform::InputState;
using platform::PadAxis;

constexpr std::array kWheelNames{"Wheel Up"sv, "Wheel Down"sv, "Wheel Left"sv, "Wheel Right"sv};
constexpr std::array kMouseNames{"Mouse Move Up"sv, "Mouse Move Down"sv, "Mouse Move Left"sv,
                                 "Mouse Move Right"sv};
constexpr std::array kPadNames{"Gamepad Left Stick Up"sv,    "Gamepad Left Stick Down"sv,
                               "Gamepad Left Stick Left"sv,  "Gamepad Left Stick Right"sv,
                               "Gamepad Right Stick Up"sv,   "Gamepad Right Stick Down"sv,
                               "Gamepad Right Stick Left"sv, "Gamepad Right Stick Right"sv,
                               "Gamepad Left Trigger"sv,     "Gamepad Right Trigger"sv};
static_assert(kWheelNames.size() == static_cast<std::size_t>(WheelDirection::kCount));
static_assert(kMouseNames.size() == static_cast<std::size_t>(MouseDirection::kCount));
static_assert(kPadNames.size() == static_cast<std::size_t>(PadAxisDirection::kCount));

// Half an axis.
struct Half {
  PadAxis axis;
  float sign;
};
constexpr std::array kHalves{Half{PadAxis::kLeftY, 1},       Half{PadAxis::kLeftY, -1},
                             Half{PadAxis::kLeftX, -1},      Half{PadAxis::kLeftX, 1},
                             Half{PadAxis::kRightY, 1},      Half{PadAxis::kRightY, -1},
                             Half{PadAxis::kRightX, -1},     Half{PadAxis::kRightX, 1},
                             Half{PadAxis::kLeftTrigger, 1}, Half{PadAxis::kRightTrigger, 1}};
static_assert(kHalves.size() == kPadNames.size());

constexpr double kMaxMoved = 1e6;

double forward(double value) {
  return std::isfinite(value) ? std::clamp(value, 0.0, kMaxMoved) : 0.0;
}

// How far the stick of an axis is pushed; 0 for triggers.
double stick_length(const platform::Gamepad& pad, PadAxis axis) {
  using enum PadAxis;
  if (axis == kLeftX || axis == kLeftY) return std::hypot(pad.axis(kLeftX), pad.axis(kLeftY));
  if (axis == kRightX || axis == kRightY) return std::hypot(pad.axis(kRightX), pad.axis(kRightY));
  return 0;
}

Reading read_pads(Control control, const InputState& input, std::optional<std::size_t> slot) {
  Reading strongest;
  for (std::size_t i = 0; i < input.pads.size(); ++i) {
    if (slot && *slot != i) continue;
    const platform::Gamepad& pad = input.pads[i];
    if (control.device == Device::kPadButton) {
      strongest.value = std::max(strongest.value, pad.held[control.code] ? 1.0 : 0.0);
      strongest.went_down |= pad.went_down[control.code];
      strongest.went_up |= pad.went_up[control.code];
    } else {
      const Half half = kHalves[control.code];
      const double value =
          std::min(forward(static_cast<double>(pad.axis(half.axis) * half.sign)), 1.0);
      if (value < strongest.value) continue;
      strongest.value = value;
      strongest.length = std::max(value, stick_length(pad, half.axis));
    }
  }
  return strongest;
}

// The part of a movement of the wheel or the mouse, upwards and to the left, in one of its
// directions.
double moved(std::uint8_t way, double up, double left) {
  static_assert(static_cast<int>(WheelDirection::kLeft) == 2 &&
                static_cast<int>(MouseDirection::kLeft) == 2);
  const double along = way < 2 ? up : left;
  return forward(way % 2 == 0 ? along : -along);
}

template <class Code>
void add_all(std::vector<Control>& all) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(Code::kCount); ++i)
    all.emplace_back(static_cast<Code>(i));
}

std::vector<Control> list_controls() {
  std::vector<Control> all;
  add_all<platform::Key>(all);
  add_all<platform::MouseButton>(all);
  add_all<WheelDirection>(all);
  add_all<MouseDirection>(all);
  add_all<platform::PadButton>(all);
  add_all<PadAxisDirection>(all);
  return all;
}

}  // namespace

std::span<const Control> all_controls() {
  static const std::vector<Control> all = list_controls();
  return all;
}

std::string_view name_of(Control control) {
  switch (control.device) {
    case Device::kKey:
      return platform::name_of(static_cast<platform::Key>(control.code));
    case Device::kMouseButton:
      return platform::name_of(static_cast<platform::MouseButton>(control.code));
    case Device::kWheel:
      return kWheelNames[control.code];
    case Device::kMouse:
      return kMouseNames[control.code];
    case Device::kPadButton:
      return platform::name_of(static_cast<platform::PadButton>(control.code));
    case Device::kPadAxis:
      return kPadNames[control.code];
  }
  return "";
}

core::Result<Control> control_named(std::string_view name) {
  std::vector<std::string> names;
  for (const Control control : all_controls()) {
    if (name_of(control) == name) return control;
    names.emplace_back(name_of(control));
  }
  const std::string_view nearest = core::nearest_word(name, names);
  return core::fail(core::ErrorCode::kInvalidArgument,
                    fmt::format("there is no control \"{}\"{}", core::shown(name, 64),
                                nearest.empty() ? "; examples: \"Space\", \"Mouse Left\", "
                                                  "\"Wheel Up\", \"Gamepad A\""
                                                : fmt::format("; did you mean \"{}\"?", nearest)));
}

bool is_relative(Control control) {
  return control.device == Device::kWheel || control.device == Device::kMouse;
}

bool is_digital(Control control) {
  return control.device == Device::kKey || control.device == Device::kMouseButton ||
         control.device == Device::kPadButton;
}

Reading read(Control control, const InputState& input, std::optional<std::size_t> pad_slot) {
  switch (control.device) {
    case Device::kKey:
      return {input.held[control.code] ? 1.0 : 0.0, input.went_down[control.code],
              input.went_up[control.code]};
    case Device::kMouseButton:
      return {input.buttons_held[control.code] ? 1.0 : 0.0, input.buttons_went_down[control.code],
              input.buttons_went_up[control.code]};
    case Device::kWheel:
      return {moved(control.code, input.wheel, input.wheel_x)};
    case Device::kMouse:
      return {moved(control.code, -input.move_px.y, -input.move_px.x)};
    case Device::kPadButton:
    case Device::kPadAxis:
      return read_pads(control, input, pad_slot);
  }
  return {};
}

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
