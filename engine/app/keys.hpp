// Keys of a window and their functions: one list for the help on the screen and for the
// documentation (docs/cli.md). Implemented in controls.cpp and platform/fly_camera.cpp.
#pragma once

#include <array>
#include <string_view>

namespace psygen::app {

// A key and its function.
struct KeyHelp {
  std::string_view keys, meaning;
};

inline constexpr std::array kKeyHelp{
    KeyHelp{"W A S D", "fly forward, left, back, right"},
    KeyHelp{"E Q", "fly up, down"},
    KeyHelp{"arrows", "turn"},
    KeyHelp{"mouse", "look around, with the right button"},
    KeyHelp{"wheel", "faster, slower"},
    KeyHelp{"Shift", "5 times as fast, while held"},
    KeyHelp{"Ctrl", "a fifth as fast, while held"},
    KeyHelp{"F1", "statistics, help, nothing"},
    KeyHelp{"F2", "next view, with its legend"},
    KeyHelp{"F3", "next preset"},
    KeyHelp{"P", "pause or continue"},
    KeyHelp{"F11", "toggle full screen"},
    KeyHelp{"F12", "save a screenshot"},
    KeyHelp{"Esc", "quit"},
};

}  // namespace psygen::app
