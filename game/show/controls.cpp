#include "game/show/controls.hpp"

#include <algorithm>
#include <array>

namespace cairns {
namespace {

using platform::Key;
using platform::PadButton;
using Way = input::MouseDirection;
using Pad = input::PadAxisDirection;

constexpr float kMouseTurn = 0.0022F;  // radians per mouse count
constexpr double kStickTurn = 2.6;     // rad/s

struct Named {
  const char* name;
  const char* label;
  std::vector<input::Binding> keys;
};

const std::array<Named, kActs>& all() {
  static const std::array<Named, kActs> kAll{{
      {"look_x", "turn", {{Way::kRight, kMouseTurn}, {Way::kLeft, -kMouseTurn}}},
      {"look_y", "look up", {{Way::kUp, kMouseTurn}, {Way::kDown, -kMouseTurn}}},
      {"turn_x", "turn (pad)", {{Pad::kRightStickRight}, {Pad::kRightStickLeft, -1}}},
      {"turn_y", "look up (pad)", {{Pad::kRightStickUp}, {Pad::kRightStickDown, -1}}},
      {"ahead", "walk forward", {{Key::kW}, {Key::kUp}, {Pad::kLeftStickUp}}},
      {"back", "walk back", {{Key::kS}, {Key::kDown}, {Pad::kLeftStickDown}}},
      {"left", "step left", {{Key::kA}, {Key::kLeft}, {Pad::kLeftStickLeft}}},
      {"right", "step right", {{Key::kD}, {Key::kRight}, {Pad::kLeftStickRight}}},
      {"run", "run", {{Key::kLeftShift}, {PadButton::kLeftThumb}, {Pad::kLeftTrigger}}},
      {"jump", "jump, climb, glide", {{Key::kSpace}, {PadButton::kA}}},
      {"use", "gather, fell", {{Key::kE}, {platform::MouseButton::kLeft}, {PadButton::kX}}},
      {"build", "build a cairn", {{Key::kC}, {PadButton::kY}}},
      {"fire", "light a fire", {{Key::kF}, {PadButton::kB}}},
      {"sleep", "sleep until morning", {{Key::kR}, {PadButton::kDown}}},
      {"lantern", "lantern", {{Key::kL}, {PadButton::kUp}}},
      {"eye", "spyglass", {{Key::kZ}, {platform::MouseButton::kRight}, {Pad::kRightTrigger}}},
      {"map", "map", {{Key::kM}, {Key::kTab}, {PadButton::kBack}}},
      {"photo", "photo mode", {{Key::kP}, {PadButton::kRight}}},
      {"menu", "menu", {{Key::kEscape}, {PadButton::kStart}}},
      {"picture", "take a screenshot", {{Key::kF12}}},
  }};
  return kAll;
}

}  // namespace

core::Result<void> add_actions(input::Actions& actions) {
  for (const Named& named : all()) {
    const auto added = actions.add(named.name, named.keys);
    if (!added) return tl::unexpected(added.error());
  }
  return {};
}

Intent intent_of(const input::Actions& actions, double mouse, double dt) {
  const auto value = [&](Act act) { return double{state_of(actions, act).value}; };
  const auto pressed = [&](Act act) { return state_of(actions, act).pressed; };
  Intent intent;
  intent.move = {value(Act::kRight) - value(Act::kLeft), value(Act::kAhead) - value(Act::kBack)};
  intent.turn = value(Act::kLookX) * mouse + value(Act::kTurnX) * kStickTurn * dt;
  intent.look = value(Act::kLookY) * mouse + value(Act::kTurnY) * kStickTurn * dt;
  intent.run = state_of(actions, Act::kRun).held;
  intent.jump = pressed(Act::kJump);
  intent.jump_held = state_of(actions, Act::kJump).held;
  intent.use = pressed(Act::kUse);
  intent.use_held = state_of(actions, Act::kUse).held;
  intent.build = pressed(Act::kBuild);
  intent.fire = pressed(Act::kFire);
  intent.sleep = pressed(Act::kSleep);
  intent.lantern = pressed(Act::kLantern);
  return intent;
}

std::string key_of(const input::Actions& actions, Act act, const platform::Window* window) {
  const auto bindings = actions.bindings(static_cast<input::ActionId>(act));
  if (bindings.empty()) return "–";
  const auto of_device = std::ranges::find_if(bindings, [&](const input::Binding& binding) {
    return input::is_of_pad(binding.control.device) == actions.uses_pad();
  });
  const input::Control control =
      (of_device == bindings.end() ? bindings.begin() : of_device)->control;
  if (control.device == input::Device::kKey && window != nullptr)
    return window->label_of(static_cast<Key>(control.code));
  return std::string(input::name_of(control));
}

const char* label_of(Act act) {
  return all()[static_cast<std::size_t>(act)].label;
}

}  // namespace cairns
