#include "engine/scene/view/debug_colours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "engine/render/preset.hpp"

namespace psygen::scene {
namespace {

constexpr std::array<std::uint32_t, 8> kLevelColours = {0xD9433B, 0xE8873A, 0xE6C84A, 0x7DB84A,
                                                        0x3FA796, 0x3E7CC0, 0x6A55B5, 0xB04FA0};
constexpr std::uint32_t kAsWanted = 0x4E9A51, kOneCoarser = 0xE6C84A, kCoarse = 0xD9433B;
constexpr std::uint32_t kGrey = 0x808080;

// Yellow for the camera's node, darker and bluer with every ring.
std::uint32_t layer_colour(std::uint32_t layer) {
  const std::uint32_t far = std::min(layer * 16, 240U);
  const std::uint32_t red = 250 - far, green = 230 - far * 3 / 4, blue = 60 + far / 2;
  return red << 16 | green << 8 | blue;
}

constexpr std::array<std::uint32_t, 7> kCacheColours = {0x25306B, 0x2F62A8, 0x2F9C9C, 0x4FA84A,
                                                        0xD8C545, 0xE6873A, 0xD1382E};
constexpr std::array<std::string_view, 7> kCacheSteps = {
    "below 1/16", "1/16 to 1/4", "1/4 to 1", "1 to 4", "4 to 16", "16 to 64", "64 and more"};

std::uint32_t cache_colour(float bytes_per_m2) {
  std::size_t step = 0;
  for (float upper = 1.0F / 16; step + 1 < kCacheColours.size() && bytes_per_m2 >= upper;
       upper *= 4) {
    ++step;
  }
  return kCacheColours[step];
}

using Legend = std::vector<render::TextLine>;

void add_levels(render::View view, std::size_t levels, Legend& legend) {
  for (std::uint32_t i = 0; i < kLevelColours.size(); ++i) {
    std::string numbers = fmt::format("{}", i);
    for (std::size_t again = i + kLevelColours.size(); again < levels;
         again += kLevelColours.size()) {
      numbers += fmt::format(", {}", again);
    }
    if (i == 0) numbers += " (finest)";
    legend.push_back({numbers, colour_of(view, {.level = i})});
  }
}

void add_layers(Legend& legend) {
  const auto add = [&](std::uint32_t layer, std::string text) {
    legend.push_back({std::move(text), layer_colour(layer)});
  };
  add(0, "where the camera is");
  for (const std::uint32_t layer : {3U, 6U, 9U, 12U})
    add(layer, fmt::format("{} nodes away", layer));
  add(15, "15 and more");
}

}  // namespace

std::uint32_t colour_of(render::View view, const DrawFacts& facts) {
  switch (view) {
    case render::View::kLevels:
    case render::View::kBounds:
      return kLevelColours[facts.level % kLevelColours.size()];
    case render::View::kLayers:
      return layer_colour(facts.layer);
    case render::View::kMissing:
      return facts.coarser == 0 ? kAsWanted : facts.coarser == 1 ? kOneCoarser : kCoarse;
    case render::View::kCache:
      return cache_colour(facts.bytes_per_m2);
    case render::View::kNormal:
    case render::View::kWireframe:
      break;
  }
  return kGrey;
}

std::vector<render::TextLine> legend_of(render::View view, std::size_t levels, bool edges) {
  Legend legend;
  if (view == render::View::kNormal) return legend;
  legend.push_back({fmt::format("view: {}", render::to_string(view))});
  switch (view) {
    case render::View::kLevels:
      legend.push_back({"level of detail"});
      add_levels(view, levels, legend);
      break;
    case render::View::kLayers:
      legend.push_back({"order of synthesis"});
      add_layers(legend);
      break;
    case render::View::kBounds:
      legend.push_back({"boxes of nodes, by level"});
      add_levels(view, levels, legend);
      break;
    case render::View::kWireframe:
      legend.push_back({edges ? "edges of triangles" : "this device cannot draw edges"});
      break;
    case render::View::kMissing:
      legend.push_back({"detail that is missing"});
      legend.push_back({"as fine as wanted", kAsWanted});
      legend.push_back({"one level too coarse", kOneCoarser});
      legend.push_back({"two levels or more", kCoarse});
      break;
    case render::View::kCache:
      legend.push_back({"bytes per square metre"});
      for (std::size_t i = 0; i < kCacheColours.size(); ++i)
        legend.push_back({std::string(kCacheSteps[i]), kCacheColours[i]});
      break;
    case render::View::kNormal:
      break;
  }
  return legend;
}

void add_box(const core::Bounds& box, std::uint32_t colour, std::vector<render::Line>& lines) {
  const glm::vec3 shown(static_cast<float>(colour >> 16 & 0xFF) / 255.0F,
                        static_cast<float>(colour >> 8 & 0xFF) / 255.0F,
                        static_cast<float>(colour & 0xFF) / 255.0F);
  const auto corner = [&box](unsigned i) {
    return glm::vec3((i & 1U) != 0 ? box.max.x : box.min.x, (i & 2U) != 0 ? box.max.y : box.min.y,
                     (i & 4U) != 0 ? box.max.z : box.min.z);
  };
  for (unsigned from = 0; from < 8; ++from) {
    for (const unsigned axis : {1U, 2U, 4U}) {
      if ((from & axis) == 0) lines.push_back({corner(from), corner(from | axis), shown});
    }
  }
}

}  // namespace psygen::scene
