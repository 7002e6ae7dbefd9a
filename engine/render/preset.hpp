// What the presets are made of, and their names.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

struct PresetTraits {
  bool pixel_light = false;        // light and haze per pixel, else per vertex
  bool fine_grain = false;         // on near ground
  bool waves = false;              // on water
  std::uint32_t samples = 1;       // per pixel, where the device has so many
  std::uint32_t cascades = 0;      // of the sun's shadow
  std::uint32_t shadow_size = 1;   // pixels along one side of a cascade
  std::array<float, 3> reach_m{};  // from the camera, of each cascade
};
PresetTraits traits_of(Preset preset);

std::string_view to_string(Preset preset);  // "low", "medium", "high", "ultra"
core::Result<Preset> preset_from(std::string_view name);
Preset next_preset(Preset preset);  // after the last comes kLow

std::string_view to_string(View view);  // "normal", "levels", "layers", "bounds", …
core::Result<View> view_from(std::string_view name);
View next_view(View view);  // after the last comes kNormal

// Whether draws have their own colour instead of the landscape's.
constexpr bool colours_draws(View view) {
  return view == View::kLevels || view == View::kLayers || view == View::kMissing ||
         view == View::kCache;
}

}  // namespace psygen::render
