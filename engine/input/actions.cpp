#include "engine/input/actions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/assert.hpp"
#include "engine/core/utf8.hpp"

namespace psygen::input {
namespace {

using core::ErrorCode;

constexpr float kMaxScale = 1000;
constexpr float kMaxDeadZone = 0.95F;
// An axis counts as pressed from the first value on, and as released below the second.
constexpr double kPressAt = 0.5, kReleaseAt = 0.4, kUsedAt = 0.3;
// Maximum number of presses and releases waiting for a step; further ones are dropped in pairs.
constexpr std::uint32_t kMaxChanges = 16;

bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= Actions::kMaxNameBytes &&
         std::ranges::all_of(name, [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '_';
         });
}

core::Result<void> check(std::string_view action, const std::vector<Binding>& bindings) {
  if (bindings.size() > Actions::kMaxBindings) {
    return core::fail(ErrorCode::kOverBudget,
                      fmt::format("action {} has {} bindings; allowed: {}", action, bindings.size(),
                                  Actions::kMaxBindings));
  }
  for (const Binding& binding : bindings) {
    const std::string_view control = name_of(binding.control);
    if (!(std::abs(binding.scale) <= kMaxScale) || binding.scale == 0) {
      return core::fail(ErrorCode::kInvalidArgument,
                        fmt::format("action {}, {}: scale is {}; allowed: -{} to {}, not 0", action,
                                    control, binding.scale, kMaxScale, kMaxScale));
    }
    if (!(binding.dead_zone >= 0 && binding.dead_zone <= kMaxDeadZone)) {
      return core::fail(ErrorCode::kInvalidArgument,
                        fmt::format("action {}, {}: dead_zone is {}; allowed: 0 to {}", action,
                                    control, binding.dead_zone, kMaxDeadZone));
    }
  }
  return {};
}

// A worn stick does not reach its end.
constexpr double kOuterZone = 0.05;

// The part of `value`, a coordinate of a vector of this length, beyond the dead zone: 0 inside it,
// 1 for a vector along the axis that reaches the outer zone.
double beyond_dead_zone(double value, double length, double dead_zone) {
  if (length <= dead_zone) return 0;
  const double end = std::max(1 - kOuterZone, dead_zone + 0.01);  // also beyond wide dead zones
  const double reach = std::min(1.0, (length - dead_zone) / (end - dead_zone));
  return value / length * reach;
}

void add_changes(std::uint32_t& changes, std::uint32_t more) {
  changes += more;
  if (changes > kMaxChanges) changes = kMaxChanges - (changes - kMaxChanges) % 2;
}

}  // namespace

core::Result<ActionId> Actions::add(std::string_view name, std::vector<Binding> defaults) {
  if (!is_name(name) || find(name)) {
    return core::fail(ErrorCode::kInvalidArgument,
                      fmt::format("\"{}\" cannot be an action: {}", core::shown(name, 80),
                                  is_name(name) ? "the name is taken"
                                                : "a name has 1 to 64 letters, digits and _"));
  }
  if (actions_.size() >= kMaxActions) {
    return core::fail(ErrorCode::kOverBudget,
                      fmt::format("the maximum of {} actions is reached", kMaxActions));
  }
  if (auto ok = check(name, defaults); !ok) return tl::unexpected(ok.error());
  Action action{
      .name = std::string(name), .bindings = defaults, .defaults = defaults, .inputs = {}};
  action.inputs.resize(defaults.size());
  actions_.push_back(std::move(action));
  states_.emplace_back();
  return actions_.size() - 1;
}

std::optional<ActionId> Actions::find(std::string_view name) const {
  const auto found = std::ranges::find(actions_, name, &Action::name);
  if (found == actions_.end()) return std::nullopt;
  return static_cast<ActionId>(found - actions_.begin());
}

core::Result<void> Actions::set_bindings(ActionId id, std::vector<Binding> bindings) {
  Action& action = actions_[id];
  if (auto ok = check(action.name, bindings); !ok) return ok;
  if (action.bindings == bindings) return {};
  action.inputs.assign(bindings.size(), {});
  action.bindings = std::move(bindings);
  return {};
}

void Actions::reset_bindings() {
  for (ActionId id = 0; id < actions_.size(); ++id)
    (void)set_bindings(id, actions_[id].defaults);  // they were checked when they were added
}

core::Result<void> Actions::rebind(ActionId action, const Control& control) {
  std::vector<Binding> bindings{{control}};
  for (const Binding& binding : actions_[action].bindings) {
    if (is_of_pad(binding.control.device) != is_of_pad(control.device)) bindings.push_back(binding);
  }
  return set_bindings(action, std::move(bindings));
}

void Actions::feed(const platform::InputState& input) {
  for (Action& action : actions_)
    feed(action, input);
}

// An action counts as pressed or released from the sum of its bindings: pressing a second control
// while a first is held is not another press.
void Actions::feed(Action& action, const platform::InputState& input) {
  bool down = false, pressed = false, any_was_down = false, all_went_up = true;
  std::uint32_t notches = 0;
  for (std::size_t i = 0; i < action.bindings.size(); ++i) {
    const Binding& binding = action.bindings[i];
    Input& at = action.inputs[i];
    const Reading reading = read(binding.control, input, pad_slot_);
    if (reading.value > kUsedAt || reading.went_down) uses_pad_ = is_of_pad(binding.control.device);
    if (is_relative(binding.control)) {
      at.moved += reading.value;
      if (binding.control.device != Device::kWheel) continue;
      at.notches = std::min(at.notches + reading.value, double{kMaxChanges});
      notches += static_cast<std::uint32_t>(at.notches);
      at.notches -= std::floor(at.notches);
      continue;
    }
    const bool was_down = at.down;
    bool went_down = reading.went_down, went_up = reading.went_up;
    if (is_digital(binding.control)) {
      at.level = reading.value;
      at.down = reading.value > 0;
    } else {
      at.level =
          beyond_dead_zone(reading.value, reading.length, static_cast<double>(binding.dead_zone));
      at.down = at.level >= (was_down ? kReleaseAt : kPressAt);
    }
    went_down |= at.down && !was_down;
    went_up |= !at.down && was_down;
    at.latched |= went_down;
    down |= at.down;
    pressed |= went_down;
    any_was_down |= was_down;
    if (was_down) all_went_up &= went_up;
  }
  const bool was_down = action.down;
  action.down = down;
  std::uint32_t changes = was_down != down ? 1 : 0;
  // Pressed and released, or released and pressed again, within the frame.
  if (pressed && (was_down ? any_was_down && all_went_up : !down)) changes += 2;
  add_changes(action.changes, changes + 2 * notches);
}

void Actions::step() {
  for (ActionId id = 0; id < actions_.size(); ++id) {
    Action& action = actions_[id];
    ActionState& state = states_[id];
    double held = 0, moved = 0;
    for (std::size_t i = 0; i < action.bindings.size(); ++i) {
      Input& at = action.inputs[i];
      const double scale = static_cast<double>(action.bindings[i].scale);
      const bool digital = is_digital(action.bindings[i].control);
      held += scale * (digital && at.latched ? 1.0 : at.level);
      moved += scale * at.moved;
      at.latched = false;
      at.moved = 0;
    }
    const bool changed = action.changes > 0;
    if (changed) --action.changes;
    const bool was_held = state.held;
    state.held = was_held != changed;
    state.pressed = changed && !was_held;
    state.released = changed && was_held;
    state.value = static_cast<float>(std::clamp(held, -1.0, 1.0) + moved);
  }
}

void Actions::step_to(std::span<const ActionState> states) {
  PSYGEN_ASSERT(states.size() == states_.size(), "one state for each action");
  std::ranges::copy(states, states_.begin());
}

void Actions::clear() {
  for (Action& action : actions_) {
    action.inputs.assign(action.bindings.size(), {});
    action.down = false;
    action.changes = 0;
  }
  std::ranges::fill(states_, ActionState{});
}

}  // namespace psygen::input
