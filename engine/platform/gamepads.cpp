#include "engine/platform/gamepads.hpp"

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

}  // namespace psygen::platform
