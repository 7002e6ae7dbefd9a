// Lays HudDrawings out as quads of the overlay, and the font of their text: letters as signed
// distances, baked at build time (text/bake_font.cpp), Latin letters of all European languages and
// common signs. Pure, any thread; linear in the letters, and finding one is logarithmic. No Vulkan,
// no texture: the caller says where the font's texture lies in its atlas. Private to engine/render.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/surface_provider.hpp"
#include "engine/render/hud_drawing.hpp"
#include "shaders/shared.h"

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

// The atlas as text sees it, in texels.
struct HudAtlas {
  core::Extent size;
  glm::vec2 font_corner{0.0F};  // of hud_font()'s texture
  glm::vec2 white_uv{0.0F};     // a point of full coverage
};

// A rectangle in pixels, or of texture coordinates.
struct Box {
  float x0, y0, x1, y1;
};
// Appends a quad, six vertices. `look`: of a letter (shaders::OverlayVertex).
void add_quad(std::vector<shaders::OverlayVertex>& out, const Box& at, const Box& uv,
              const glm::vec4& colour, const glm::vec4& look = glm::vec4(0.0F));

inline constexpr std::size_t kMaxHudQuads = 65'536;  // further ones are left out

// Appends six vertices a quad. Values that are not finite, and texts smaller than 4 or larger than
// 2000 pixels, are left out or clamped.
void lay_out_hud(const HudDrawing& drawing, core::Extent picture, const HudAtlas& atlas,
                 std::vector<shaders::OverlayVertex>& out);

}  // namespace psygen::render
