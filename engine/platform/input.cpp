#include "engine/platform/input.hpp"

namespace psygen::platform {

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
