// The traits of the presets (docs/presets.md), and the names of presets, views and paths. Pure
// functions, any thread. Knows no Vulkan.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

// The properties of a preset.
struct PresetTraits {
  bool pixel_light = false;        // light and haze per pixel, else per vertex
  bool fine_grain = false;         // on near ground
  bool waves = false;              // on water, which also mirrors the land
  std::uint32_t samples = 1;       // per pixel; fewer if the device supports fewer
  std::uint32_t cascades = 0;      // of the sun's shadow
  std::uint32_t shadow_size = 1;   // pixels along one side of a cascade
  std::array<float, 3> reach_m{};  // distance from the camera that each cascade covers
};
// The properties of `preset`.
PresetTraits traits_of(Preset preset);

// Names of presets and the cycle through them. preset_from() fails with kInvalidArgument and lists
// the names.
std::string_view to_string(Preset preset);  // "low", "medium", "high", "ultra"
core::Result<Preset> preset_from(std::string_view name);
Preset next_preset(Preset preset);  // after the last comes kLow

// The same for views.
std::string_view to_string(View view);  // "normal", "levels", "layers", "bounds", …
core::Result<View> view_from(std::string_view name);
View next_view(View view);  // after the last comes kNormal

// The name of a path and its inverse, which fails with kInvalidArgument.
std::string_view to_string(RenderPath path);  // "auto", "cpu", "gpu"
core::Result<RenderPath> render_path_from(std::string_view name);

// Returns true if a view shows draws in their debug colour instead of the landscape's.
constexpr bool colours_draws(View view) {
  return view == View::kLevels || view == View::kLayers || view == View::kMissing ||
         view == View::kCache;
}

}  // namespace psygen::render
