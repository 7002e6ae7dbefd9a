#include "engine/render/overlay.hpp"

#include <imgui/imgui.h>

#include <algorithm>

namespace psygen::render {

struct Overlay::Font {
  ImFontAtlas atlas;
  ImFont* font = nullptr;
  unsigned char* pixels = nullptr;  // owned by the atlas
  int width = 0, height = 0;
};

namespace {

constexpr float kMargin = 8.0F;
constexpr glm::vec4 kTextColour{0.96F, 0.97F, 0.94F, 1.0F};
constexpr glm::vec4 kPanelColour{0.03F, 0.04F, 0.06F, 0.55F};

struct Box {
  float x0, y0, x1, y1;
};

void add_quad(std::vector<shaders::OverlayVertex>& out, const Box& at, const Box& uv,
              const glm::vec4& colour) {
  const auto corner = [&](bool right, bool bottom) {
    return shaders::OverlayVertex{{right ? at.x1 : at.x0, bottom ? at.y1 : at.y0,
                                   right ? uv.x1 : uv.x0, bottom ? uv.y1 : uv.y0},
                                  colour};
  };
  for (const auto& [right, bottom] : {std::pair{false, false},
                                      {false, true},
                                      {true, true},
                                      {false, false},
                                      {true, true},
                                      {true, false}}) {
    out.push_back(corner(right, bottom));
  }
}

}  // namespace

Overlay::Overlay() : font_(std::make_unique<Font>()) {
  font_->font = font_->atlas.AddFontDefault();
  font_->atlas.GetTexDataAsAlpha8(&font_->pixels, &font_->width, &font_->height);
}

Overlay::~Overlay() = default;

core::Extent Overlay::atlas_size() const {
  return {static_cast<std::uint32_t>(font_->width), static_cast<std::uint32_t>(font_->height)};
}

std::span<const std::byte> Overlay::atlas() const {
  return {reinterpret_cast<const std::byte*>(font_->pixels),
          static_cast<std::size_t>(font_->width) * static_cast<std::size_t>(font_->height)};
}

void Overlay::lay_out(std::span<const std::string> lines,
                      std::vector<shaders::OverlayVertex>& out) const {
  out.clear();
  if (lines.empty()) return;
  const ImVec2 white = font_->atlas.TexUvWhitePixel;
  add_quad(out, {}, {white.x, white.y, white.x, white.y}, kPanelColour);
  const float line_height = font_->font->FontSize + 2.0F;
  float y = 2.0F * kMargin, widest = 0.0F;
  for (const std::string& line : lines) {
    float x = 2.0F * kMargin;
    for (const char c : line) {
      const ImFontGlyph* glyph =
          font_->font->FindGlyph(static_cast<ImWchar>(static_cast<unsigned char>(c)));
      if (glyph->Visible && out.size() < kMaxQuads * 6) {
        add_quad(out, {x + glyph->X0, y + glyph->Y0, x + glyph->X1, y + glyph->Y1},
                 {glyph->U0, glyph->V0, glyph->U1, glyph->V1}, kTextColour);
      }
      x += glyph->AdvanceX;
    }
    widest = std::max(widest, x);
    y += line_height;
  }
  const Box panel{kMargin, kMargin, widest + kMargin, y + kMargin - 2.0F};
  std::vector<shaders::OverlayVertex> quad;
  add_quad(quad, panel, {white.x, white.y, white.x, white.y}, kPanelColour);
  std::copy(quad.begin(), quad.end(), out.begin());
}

}  // namespace psygen::render
