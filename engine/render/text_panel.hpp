// Text over a picture: panels of lines, some with a colour or a bar beside their words. Plain
// values; overlay.hpp lays them out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace psygen::render {

// Where a panel stands. One on the right that would cover one on the left stands below it.
enum class Anchor : std::uint8_t { kTopLeft, kTopRight, kBottom, kMiddle };

// A line that is too long for the picture goes on in the next row.
struct TextLine {
  std::string text;                          // UTF-8
  std::optional<std::uint32_t> swatch = {};  // 0xRRGGBB: a square of this colour before the text
  std::optional<float> bar = {};             // 0 to 1: a bar below the text, filled so far
};

struct TextPanel {
  Anchor anchor = Anchor::kTopLeft;
  std::vector<TextLine> lines;  // none: the panel is not drawn
};

}  // namespace psygen::render
