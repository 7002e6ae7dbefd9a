#include "tests/game/made_up_pad.hpp"

#include <GLFW/glfw3.h>

namespace psygen {
namespace {

GLFWgamepadstate made_up{};
bool connected = false;

}  // namespace

MadeUpPad::MadeUpPad() {
  made_up = {};
  made_up.axes[GLFW_GAMEPAD_AXIS_LEFT_TRIGGER] = made_up.axes[GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER] = -1;
  connected = true;
}

MadeUpPad::~MadeUpPad() {
  connected = false;
}

void MadeUpPad::hold(platform::PadButton button, bool held) {
  made_up.buttons[static_cast<std::size_t>(button)] = held ? GLFW_PRESS : GLFW_RELEASE;
}

void MadeUpPad::move(platform::PadAxis axis, float to) {
  made_up.axes[static_cast<std::size_t>(axis)] = to;
}

}  // namespace psygen

// Replace GLFW's functions in the whole program.
extern "C" int glfwGetGamepadState(int slot, GLFWgamepadstate* state) {
  if (slot != 0 || !psygen::connected) return GLFW_FALSE;
  *state = psygen::made_up;
  return GLFW_TRUE;
}
