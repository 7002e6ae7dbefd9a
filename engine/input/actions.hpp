// Actions: names ("jump", "move_x") that a game queries instead of keys. Each has bindings to
// controls, which may change at any time. feed() takes the input of a frame; step() computes the
// states of a fixed step. If several steps or none fall into a frame, every press still arrives
// exactly once, and every movement in exactly one step. No clock, no window. One thread; linear in
// bindings.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/input/control.hpp"

namespace psygen::input {

// One control of an action.
struct Binding {
  Control control;
  float scale = 1;          // factor on the control's value; negative: reversed
  float dead_zone = 0.15F;  // for gamepad axes: values below are 0; the rest is scaled to 1

  friend bool operator==(const Binding&, const Binding&) = default;
};

// The state of an action in one fixed step.
struct ActionState {
  // The sum over the bindings: held controls within −1 … 1, plus the movement of wheel and mouse
  // since the last step, which is unlimited.
  float value = 0;
  bool held = false;      // down in this step; also true in the step of a short press
  bool pressed = false;   // the first step of `held`
  bool released = false;  // the first step without `held`

  friend bool operator==(const ActionState&, const ActionState&) = default;
};

// The index of an action, in the order in which actions were added.
using ActionId = std::size_t;

// The actions of a game with their bindings and states.
class Actions {
 public:
  static constexpr std::size_t kMaxActions = 256, kMaxBindings = 32, kMaxNameBytes = 64;

  // Adds an action with its default bindings. A name is new and has 1 to kMaxNameBytes bytes of
  // letters, digits and "_"; scales and dead zones have the limits of set_bindings(). Fails with
  // kInvalidArgument, and with kOverBudget beyond kMaxActions.
  core::Result<ActionId> add(std::string_view name, std::vector<Binding> defaults = {});

  // The number of actions, their names, and the index of a name.
  std::size_t size() const { return actions_.size(); }
  const std::string& name(ActionId action) const { return actions_[action].name; }
  std::optional<ActionId> find(std::string_view name) const;

  std::span<const Binding> bindings(ActionId action) const { return actions_[action].bindings; }
  // Replaces the bindings. A held action is released in the next step, unless the new bindings hold
  // it. Fails with kInvalidArgument for scales that are not finite, 0 or beyond ±1000, and for dead
  // zones outside 0 … 0.95, and with kOverBudget beyond kMaxBindings; nothing changes then.
  core::Result<void> set_bindings(ActionId action, std::vector<Binding> bindings);
  // Replaces the control of an action. A control of keyboard or mouse replaces only bindings of
  // keyboard and mouse, a control of a gamepad only bindings of gamepads. Fails like
  // set_bindings().
  core::Result<void> rebind(ActionId action, const Control& control);
  // Restores the default bindings of all actions.
  void reset_bindings();

  // Selects the gamepad to read; nothing: the one that is moved most.
  void use_gamepad(std::optional<std::size_t> slot) { pad_slot_ = slot; }

  // Adds the input of a frame. Call it once per frame, before its steps.
  void feed(const platform::InputState& input);
  // Advances to the next fixed step and computes its states.
  void step();
  // Sets the states of a step instead of step(), for replaying. One state for each action.
  void step_to(std::span<const ActionState> states);

  // True if the last used control is on a gamepad, to choose the labels on the screen.
  bool uses_pad() const { return uses_pad_; }

  // The states of this step; `action` is a result of add().
  const ActionState& state(ActionId action) const { return states_[action]; }
  std::span<const ActionState> states() const { return states_; }

  // Discards all input so far, without releases: for a new level, and before step() continues after
  // step_to(). Held controls are then pressed again.
  void clear();

 private:
  // Input that no step has processed yet.
  struct Input {
    double level = 0;      // the control's value now, after the dead zone, 0 … 1
    bool down = false;     // the control counts as pressed
    bool latched = false;  // it went down since the last step
    double moved = 0;      // movement of relative controls since the last step
    double notches = 0;    // wheel steps not yet counted as a press
  };
  struct Action {
    std::string name;
    std::vector<Binding> bindings, defaults;
    std::vector<Input> inputs;  // one for each binding
    bool down = false;          // true if any binding was down in the last frame
    // Presses and releases that no step has processed yet: the state changes once per step.
    std::uint32_t changes = 0;
  };
  void feed(Action& action, const platform::InputState& input);

  std::vector<Action> actions_;
  std::vector<ActionState> states_;
  std::optional<std::size_t> pad_slot_;
  bool uses_pad_ = false;
};

}  // namespace psygen::input
