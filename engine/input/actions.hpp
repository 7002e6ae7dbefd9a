// Actions: what a game asks about ("jump", "move_x") instead of keys. Each has bindings to
// controls, which may change at any time. Frames come in with feed(), fixed steps take their states
// with step(). Where several steps or none fall into a frame, every press arrives exactly once, and
// every bit of movement in exactly one step. No clock, no window. One thread; linear in bindings.
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
  float scale = 1;          // of the control's value; negative: the other way
  float dead_zone = 0.15F;  // of gamepad axes: up to here they are 0; the rest is stretched to 1

  friend bool operator==(const Binding&, const Binding&) = default;
};

// An action in one fixed step.
struct ActionState {
  // The sum over the bindings: held controls together −1 … 1, then the movement of wheel and mouse
  // since the last step, which has no limit.
  float value = 0;
  bool held = false;      // down in this step; true in the step of a press even if it was short
  bool pressed = false;   // went down: the first step of `held`
  bool released = false;  // went up: the first step without `held`

  friend bool operator==(const ActionState&, const ActionState&) = default;
};

// The number of an action, from 0, in the order in which they were added.
using ActionId = std::size_t;

class Actions {
 public:
  static constexpr std::size_t kMaxActions = 256, kMaxBindings = 32, kMaxNameBytes = 64;

  // Adds an action with its default bindings. A name has 1 to kMaxNameBytes bytes of letters,
  // digits and "_", and is new; scales and dead zones are those of set_bindings(). Fails with
  // kInvalidArgument, and with kOverBudget beyond kMaxActions.
  core::Result<ActionId> add(std::string_view name, std::vector<Binding> defaults = {});

  // The actions, and the number of one by its name.
  std::size_t size() const { return actions_.size(); }
  const std::string& name(ActionId action) const { return actions_[action].name; }
  std::optional<ActionId> find(std::string_view name) const;

  std::span<const Binding> bindings(ActionId action) const { return actions_[action].bindings; }
  // Replaces the bindings. What the action holds is released in the next step, unless the new ones
  // hold it. Fails with kInvalidArgument for scales that are not finite, 0 or beyond ±1000, and
  // dead zones outside 0 … 0.95, and with kOverBudget beyond kMaxBindings; nothing changes then.
  core::Result<void> set_bindings(ActionId action, std::vector<Binding> bindings);
  // Gives an action another control. Those of a gamepad stay if that is of keyboard or mouse, and
  // the other way round. Fails as set_bindings().
  core::Result<void> rebind(ActionId action, const Control& control);
  // All actions have the bindings again with which they were added.
  void reset_bindings();

  // The gamepad that is read; none: whichever is moved most.
  void use_gamepad(std::optional<std::size_t> slot) { pad_slot_ = slot; }

  // Takes in the input of a frame. Once per frame, before its steps.
  void feed(const platform::InputState& input);
  // Goes on to the next fixed step, whose states are those below.
  void step();
  // Puts states in the place of those of step(), for replaying. As many as there are actions.
  void step_to(std::span<const ActionState> states);

  // Whether the last control that was used is one of a gamepad, for what is written on the screen.
  bool uses_pad() const { return uses_pad_; }

  // The states of this step; `action` is one that add() returned.
  const ActionState& state(ActionId action) const { return states_[action]; }
  std::span<const ActionState> states() const { return states_; }

  // Forgets everything that was fed, without releases: for a new level, and before step() goes on
  // after step_to(). What is held then is pressed anew.
  void clear();

 private:
  // What was fed and no step has taken yet.
  struct Input {
    double level = 0;      // of the control now: after the dead zone, 0 … 1
    bool down = false;     // the control counts as pressed
    bool latched = false;  // it went down since the last step
    double moved = 0;      // relative controls: since the last step
    double notches = 0;    // of the wheel, not yet counted as a press
  };
  struct Action {
    std::string name;
    std::vector<Binding> bindings, defaults;
    std::vector<Input> inputs;  // one for each binding
    bool down = false;          // any binding was, in the last frame
    // Presses and releases that no step has taken yet: the state changes once a step.
    std::uint32_t changes = 0;
  };
  void feed(Action& action, const platform::InputState& input);

  std::vector<Action> actions_;
  std::vector<ActionState> states_;
  std::optional<std::size_t> pad_slot_;
  bool uses_pad_ = false;
};

}  // namespace psygen::input
