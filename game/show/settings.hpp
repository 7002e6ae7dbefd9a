// What the player chooses: kept in a TOML file in the user's configuration, bindings of keys in
// another beside it. A file that cannot be read is told and left as it is; the usual values count.
#pragma once

#include <filesystem>

#include "engine/input/actions.hpp"
#include "engine/render/types.hpp"

namespace cairns {

using namespace psygen;

struct Settings {
  int quality = -1;  // of render::Preset, from low to ultra; -1: what suits the device
  double fov_deg = 60, mouse = 1, text = 1;  // degrees; factors
  double effects = 0.8, music = 0.5;         // volumes, 0 … 1
  bool colour_blind = false;                 // marks differ by brightness, not by hue
  bool reduced_motion = false;               // the view does not sway, and the title stands still
  bool fullscreen = false;
};

// What has a slider or a box in the settings. `name` is that of the file.
struct Number {
  const char *name, *label;
  double Settings::*value;
  double low, high;
};
inline constexpr Number kNumbers[] = {{"fov_deg", "field of view", &Settings::fov_deg, 45, 100},
                                      {"mouse", "mouse", &Settings::mouse, 0.2, 5},
                                      {"text", "text size", &Settings::text, 0.7, 2},
                                      {"effects", "sounds", &Settings::effects, 0, 1},
                                      {"music", "music", &Settings::music, 0, 1}};
struct Switch {
  const char *name, *label;
  bool Settings::*value;
};
inline constexpr Switch kSwitches[] = {
    {"colour_blind", "marks without colour", &Settings::colour_blind},
    {"reduced_motion", "reduced motion", &Settings::reduced_motion},
    {"fullscreen", "full screen", &Settings::fullscreen}};

// A missing file has the usual values; values out of their ranges are moved into them. Fails with
// kParse for a file that is not TOML, and kIo.
core::Result<Settings> load_settings(const std::filesystem::path& folder);
// The same for the keys, with the errors of input::load_bindings().
core::Result<void> load_keys(const std::filesystem::path& folder, input::Actions& actions);
core::Result<void> save_settings(const std::filesystem::path& folder, const Settings& settings,
                                 const input::Actions& actions);

}  // namespace cairns
