#include "engine/render/preset.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/core/nearest_word.hpp"

namespace psygen::render {

namespace {

constexpr std::array<std::string_view, 4> kPresets{"low", "medium", "high", "ultra"};
constexpr std::array<std::string_view, 7> kViews{"normal",    "levels",  "layers", "bounds",
                                                 "wireframe", "missing", "cache"};
constexpr std::array<std::string_view, 3> kPaths{"auto", "cpu", "gpu"};

template <class Value, std::size_t kCount>
core::Result<Value> named(const std::array<std::string_view, kCount>& names, std::string_view name,
                          std::string_view what) {
  for (std::size_t i = 0; i < kCount; ++i) {
    if (names[i] == name) return static_cast<Value>(i);
  }
  return core::fail(core::ErrorCode::kInvalidArgument,
                    fmt::format("{} '{}' is unknown; allowed are {}{}", what, name,
                                fmt::join(names, ", "), core::suggestion(name, names)));
}

}  // namespace

PresetTraits traits_of(Preset preset) {
  switch (preset) {
    case Preset::kMedium:
      return {.pixel_light = true};
    case Preset::kHigh:
      return {.pixel_light = true,
              .fine_grain = true,
              .waves = true,
              .samples = 4,
              .cascades = 2,
              .shadow_size = 2048,
              .reach_m = {90.0F, 450.0F, 0.0F}};
    case Preset::kUltra:
      return {.pixel_light = true,
              .fine_grain = true,
              .waves = true,
              .samples = 8,
              .cascades = 3,
              .shadow_size = 4096,
              .reach_m = {70.0F, 300.0F, 1500.0F}};
    case Preset::kLow:
      break;
  }
  return {};
}

std::string_view to_string(Preset preset) {
  return kPresets[static_cast<std::size_t>(preset)];
}
core::Result<Preset> preset_from(std::string_view name) {
  return named<Preset>(kPresets, name, "preset");
}
Preset next_preset(Preset preset) {
  return static_cast<Preset>((static_cast<std::size_t>(preset) + 1) % kPresets.size());
}

std::string_view to_string(View view) {
  return kViews[static_cast<std::size_t>(view)];
}
core::Result<View> view_from(std::string_view name) {
  return named<View>(kViews, name, "view");
}
View next_view(View view) {
  return static_cast<View>((static_cast<std::size_t>(view) + 1) % kViews.size());
}

std::string_view to_string(RenderPath path) {
  return kPaths[static_cast<std::size_t>(path)];
}
core::Result<RenderPath> render_path_from(std::string_view name) {
  for (std::size_t i = 0; i < kPaths.size(); ++i) {
    if (kPaths[i] == name) return static_cast<RenderPath>(i);
  }
  return core::fail(core::ErrorCode::kInvalidArgument,
                    fmt::format("render path '{}' is unknown; allowed are auto, cpu, gpu", name));
}

}  // namespace psygen::render
