// Lays HudDrawings out as quads of the overlay. Pure; linear in the letters. No Vulkan, no texture:
// the caller says where the font's texture lies in its atlas. Private to engine/render.
#pragma once

#include <vector>

#include "engine/core/surface_provider.hpp"
#include "engine/render/hud_drawing.hpp"
#include "shaders/shared.h"

namespace psygen::render {

// The atlas as text sees it, in texels.
struct HudAtlas {
  core::Extent size;
  glm::vec2 font_corner{0.0F};  // of hud_font()'s texture
  glm::vec2 white_uv{0.0F};     // a point of full coverage
};

inline constexpr std::size_t kMaxHudQuads = 65'536;  // further ones are left out

// Appends six vertices a quad. Values that are not finite, and texts smaller than 4 or larger than
// 2000 pixels, are left out or clamped.
void lay_out_hud(const HudDrawing& drawing, core::Extent picture, const HudAtlas& atlas,
                 std::vector<shaders::OverlayVertex>& out);

}  // namespace psygen::render
