#include "engine/platform/input.hpp"

#include <algorithm>
#include <cmath>

namespace psygen::platform {

namespace {

float in_range(float value, PadAxis axis) {
  const bool trigger = axis == PadAxis::kLeftTrigger || axis == PadAxis::kRightTrigger;
  return std::isfinite(value) ? std::clamp(value, trigger ? 0.0F : -1.0F, 1.0F) : 0.0F;
}

}  // namespace

void update_gamepads(const ReadPad& read, Gamepads& pads) {
  for (std::size_t slot = 0; slot < pads.size(); ++slot) {
    Gamepad& pad = pads[slot];
    const std::optional<PadReading> found = read(slot);
    if (!found && !pad.connected) continue;
    const PadReading now = found.value_or(PadReading{});
    pad.came |= found.has_value() && !pad.connected;
    pad.went |= !found.has_value() && pad.connected;
    pad.connected = found.has_value();
    pad.went_down |= now.buttons & ~pad.held;
    pad.went_up |= pad.held & ~now.buttons;
    pad.held = now.buttons;
    for (std::size_t i = 0; i < kPadAxes; ++i)
      pad.axes[i] = in_range(now.axes[i], static_cast<PadAxis>(i));
  }
}

void clear_changes(Gamepads& pads) {
  for (Gamepad& pad : pads) {
    pad.came = pad.went = false;
    pad.went_down.reset();
    pad.went_up.reset();
  }
}

void clear_changes(InputState& input) {
  input.went_down.reset();
  input.went_up.reset();
  input.repeated.reset();
  input.buttons_went_down.reset();
  input.buttons_went_up.reset();
  input.text.clear();
  input.move_px = input.look_px = {};
  input.wheel = input.wheel_x = 0;
  input.resized = false;
  clear_changes(input.pads);
}

namespace {

// `taken` is the input that another reader takes, `before` the input that the last result held.
template <std::size_t kCount>
void leave_out(std::bitset<kCount>& held, std::bitset<kCount>& went_down,
               std::bitset<kCount>& went_up, std::bitset<kCount>& before,
               std::bitset<kCount>& taken, bool take) {
  if (take) taken |= held | went_down;
  const std::bitset<kCount> let_through = before | ~taken;
  const std::bitset<kCount> still_held = held;
  went_down &= ~taken;
  held &= ~taken;
  went_up = (went_up & let_through) | (before & taken);
  before = held;
  taken &= still_held;
}

}  // namespace

InputState InputFilter::apply(const InputState& now, TakenDevices taken) {
  InputState rest = now;
  leave_out(rest.held, rest.went_down, rest.went_up, held_, taken_, taken.keyboard);
  leave_out(rest.buttons_held, rest.buttons_went_down, rest.buttons_went_up, buttons_held_,
            buttons_taken_, taken.mouse);
  if (taken.keyboard) {
    rest.repeated.reset();
    rest.text.clear();
  }
  if (taken.mouse) {
    rest.move_px = rest.look_px = {};
    rest.wheel = rest.wheel_x = 0;
    rest.looking = false;
  }
  return rest;
}

}  // namespace psygen::platform
