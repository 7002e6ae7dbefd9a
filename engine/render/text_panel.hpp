// Text over a picture: panels of lines, optionally with a colour swatch or a bar. Plain values, any
// thread. overlay.hpp does the layout.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace psygen::render {

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
