// The player's settings in a TOML file of the user's configuration folder, with the key bindings in
// a second file. A file that cannot be read is reported and kept; the defaults apply.
#pragma once

#include <filesystem>

#include "engine/input/actions.hpp"
#include "engine/render/types.hpp"

namespace cairns {

using namespace psygen;

struct Settings {
  int quality = -1;  // render::Preset, low to ultra; -1: chosen for the device
  double fov_deg = 60, mouse = 1, text = 1;  // degrees; factors
  double effects = 0.8, music = 0.5;         // volumes, 0 … 1
  bool colour_blind = false;                 // markers differ in brightness, not in hue
  bool reduced_motion = false;               // no sway, and a still title screen
  bool fullscreen = false;
};

// Settings with a slider or a check box. `name` is the key in the file.
struct Number {
  const char *name, *label;
  double Settings::*value;
  double low, high;
};
inline constexpr Number kNumbers[] = {{"fov_deg", "field of view", &Settings::fov_deg, 45, 100},
                                      {"mouse", "mouse sensitivity", &Settings::mouse, 0.2, 5},
                                      {"text", "text size", &Settings::text, 0.7, 2},
                                      {"effects", "sound effects", &Settings::effects, 0, 1},
                                      {"music", "music", &Settings::music, 0, 1}};
struct Switch {
  const char *name, *label;
  bool Settings::*value;
};
inline constexpr Switch kSwitches[] = {
    {"colour_blind", "high-contrast markers", &Settings::colour_blind},
    {"reduced_motion", "reduced motion", &Settings::reduced_motion},
    {"fullscreen", "full screen", &Settings::fullscreen}};

// Returns the defaults if the file is missing, and clamps values to their ranges. Fails with kIo,
// or with kParse if the file is not TOML.
core::Result<Settings> load_settings(const std::filesystem::path& folder);
// Loads the key bindings. Fails like input::load_bindings().
core::Result<void> load_keys(const std::filesystem::path& folder, input::Actions& actions);
core::Result<void> save_settings(const std::filesystem::path& folder, const Settings& settings,
                                 const input::Actions& actions);

}  // namespace cairns
