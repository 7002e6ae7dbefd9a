// The font of text over the picture: letters as signed distances, baked at build time
// (text/bake_font.cpp). Latin letters of all European languages and common signs. Immutable, any
// thread; finding a letter is logarithmic. Private to engine/render.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/core/surface_provider.hpp"

namespace psygen::render {

// A letter, in texels of the font's texture; y is down, and 0 is the baseline.
struct BakedLetter {
  char32_t code;
  float advance;
  float x, y, width, height;  // of its picture, from where the letter is put
  float u, v;                 // of the picture's corner in the texture
};

// All of it, for the whole program. Letters ascend by code.
struct HudFont {
  core::Extent size;                  // of the texture
  std::span<const std::byte> texels;  // 128 on an edge, more inside
  std::span<const BakedLetter> letters;
  float em = 0;      // from ascender to descender
  float ascent = 0;  // from ascender to baseline
  float spread = 0;  // distance from 128 to 0

  // The letter, or one that stands for those that the font lacks.
  const BakedLetter& letter(char32_t code) const;
};
const HudFont& hud_font();

}  // namespace psygen::render
