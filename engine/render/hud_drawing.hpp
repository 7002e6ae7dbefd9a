// Drawings over the frame as plain values, any thread: the HUD of a game (text of any size, and
// rectangles of one colour; docs/hud.md), and panels of text for debugging. HUD positions are
// fractions of the frame plus pixels, so they hold for every window size. text/overlay_layout.hpp
// lays both out.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/coordinates.hpp"

namespace psygen::render {

// Where something is: share of the picture (0, 0 the upper left corner, 1, 1 the lower right one)
// plus pixels, right and down.
struct HudPlace {
  glm::vec2 share{0.0F};
  glm::vec2 px{0.0F};
};

// Alignment of a text to its place. kTop: the place is at its top.
enum class HudAlign : std::uint8_t { kLeft, kCentre, kRight };
enum class HudVertical : std::uint8_t { kTop, kMiddle, kBottom };

// Colours are display values, not linear: red, green, blue, opacity, each 0 … 1.
struct HudText {
  std::string text;  // UTF-8; "\n" begins a line; unknown letters are shown as a sign
  HudPlace at;
  HudAlign align = HudAlign::kLeft;
  HudVertical vertical = HudVertical::kTop;
  float size_px = 24;  // height of a line, 4 … 2000, also fractions
  glm::vec4 colour{1.0F};
  float bolder_px = 0;  // thickens strokes on each side; negative: thins
  // Around the letters, 0: none. At most an eighth of the size, with bolder_px.
  float outline_px = 0;
  glm::vec4 outline_colour{0.0F, 0.0F, 0.0F, 0.85F};
  // A soft shadow at this distance, 0, 0: none.
  glm::vec2 shadow_px{0.0F};
  glm::vec4 shadow_colour{0.0F, 0.0F, 0.0F, 0.6F};
};

// A rectangle: a bar, a panel, a crosshair.
struct HudArea {
  HudPlace at;  // of its upper left corner
  HudPlace size;
  glm::vec4 colour{0.0F, 0.0F, 0.0F, 0.6F};
};

// Everything over a picture: first the areas, then the texts, each in order.
struct HudDrawing {
  std::vector<HudArea> areas;
  std::vector<HudText> texts;

  // Returns true if it has no areas and no texts.
  bool empty() const { return areas.empty() && texts.empty(); }
};

// Width and height of a text in pixels, of all its lines, without outline and shadow. Any thread.
glm::vec2 measure(const HudText& text);

// The position of a panel. A panel on the right that would cover one on the left moves below it.
enum class Anchor : std::uint8_t { kTopLeft, kTopRight, kBottom, kMiddle };

// One line. If it is too long for the picture, it continues in the next row.
struct TextLine {
  std::string text;                          // UTF-8
  std::optional<std::uint32_t> swatch = {};  // 0xRRGGBB: a square of this colour before the text
  std::optional<float> bar = {};             // 0 … 1: a bar below the text, filled to this share
};

// One panel.
struct TextPanel {
  Anchor anchor = Anchor::kTopLeft;
  std::vector<TextLine> lines;  // none: the panel is not drawn
};

}  // namespace psygen::render
