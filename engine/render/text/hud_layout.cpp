#include "engine/render/text/hud_layout.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <string_view>

#include "engine/core/utf8.hpp"

namespace psygen::render {
namespace {

#include "hud_font_baked.h"

using Vertices = std::vector<shaders::OverlayVertex>;

constexpr float kMinSizePx = 4, kMaxSizePx = 2000;
constexpr float kMaxOffPx = 1e6F;
constexpr char32_t kReplacement = 0xFFFD;
constexpr float kShadowSoftness = 0.06F;  // of the size

bool is_finite(const glm::vec2& v) {
  return std::isfinite(v.x) && std::isfinite(v.y);
}

// Parameters of a glyph in shaders/overlay.glsl.
struct Look {
  float dilation_px = 0, softness_px = 1;
};

Box box_of(const glm::vec2& from, const glm::vec2& to) {
  return {from.x, from.y, to.x, to.y};
}

// Calls f(letter) for each of a line.
template <class F>
void each_letter(std::string_view line, const F& f) {
  while (!line.empty()) {
    const core::CodePoint point = core::first_code_point(line);
    line.remove_prefix(point.bytes);
    f(hud_font().letter(point.valid ? point.value : kReplacement));
  }
}

template <class F>
void each_line(std::string_view text, const F& f) {
  for (;;) {
    const std::size_t end = text.find('\n');
    f(text.substr(0, end));
    if (end == std::string_view::npos) return;
    text.remove_prefix(end + 1);
  }
}

float width_of(std::string_view line, float scale) {
  float width = 0;
  each_letter(line, [&](const BakedLetter& letter) { width += letter.advance; });
  return width * scale;
}

class TextLayout {
 public:
  TextLayout(const HudText& text, core::Extent picture, const HudAtlas& atlas, Vertices& out)
      : text_(text),
        atlas_(atlas),
        out_(out),
        size_px_(std::clamp(text.size_px, kMinSizePx, kMaxSizePx)),
        scale_(size_px_ / hud_font().em),
        picture_(picture.width, picture.height) {}

  void add() {
    if (!is_finite(text_.at.share) || !is_finite(text_.at.px)) return;
    // No farther than the distances of the font go.
    const float max_px = (hud_font().spread - 1) * scale_;
    const float bolder =
        std::isfinite(text_.bolder_px) ? std::clamp(text_.bolder_px, -max_px, max_px) : 0.0F;
    if (is_finite(text_.shadow_px) && text_.shadow_px != glm::vec2(0.0F)) {
      const float soft = std::clamp(kShadowSoftness * size_px_, 1.0F, max_px);
      add_letters(text_.shadow_px, text_.shadow_colour, {bolder, 1 + soft});
    }
    if (text_.outline_px > 0) {
      add_letters({}, text_.outline_colour, {std::min(bolder + text_.outline_px, max_px), 1});
    }
    add_letters({}, text_.colour, {bolder, 1});
  }

 private:
  void add_letters(const glm::vec2& moved, const glm::vec4& colour, const Look& look) {
    const HudFont& font = hud_font();
    glm::vec2 origin = text_.at.share * picture_ + text_.at.px;
    const float height = size_px_ * static_cast<float>(1 + std::ranges::count(text_.text, '\n'));
    if (text_.vertical == HudVertical::kMiddle) origin.y -= height / 2;
    if (text_.vertical == HudVertical::kBottom) origin.y -= height;
    // Whole pixels keep horizontal strokes sharp.
    origin.y = std::round(origin.y + font.ascent * scale_);
    const glm::vec4 sdf(2 * font.spread, look.dilation_px, look.softness_px, 0.0F);
    const glm::vec2 texture(atlas_.size.width, atlas_.size.height);
    each_line(text_.text, [&](std::string_view line) {
      glm::vec2 at = origin;
      const float width = width_of(line, scale_);
      if (text_.align == HudAlign::kCentre) at.x -= width / 2;
      if (text_.align == HudAlign::kRight) at.x -= width;
      at.x = std::round(at.x);
      at = glm::clamp(at + moved, -kMaxOffPx, kMaxOffPx);
      each_letter(line, [&](const BakedLetter& letter) {
        const glm::vec2 from = at + glm::vec2(letter.x, letter.y) * scale_;
        const glm::vec2 size(letter.width, letter.height);
        const glm::vec2 uv = atlas_.font_corner + glm::vec2(letter.u, letter.v);
        if (letter.width > 0 && out_.size() < kMaxHudQuads * 6) {
          add_quad(out_, box_of(from, from + size * scale_),
                   box_of(uv / texture, (uv + size) / texture), colour, sdf);
        }
        at.x += letter.advance * scale_;
      });
      origin.y += std::round(size_px_);
    });
  }

  const HudText& text_;
  const HudAtlas& atlas_;
  Vertices& out_;
  const float size_px_, scale_;
  const glm::vec2 picture_;
};

glm::vec2 pixels_of(const HudPlace& place, core::Extent picture) {
  return place.share * glm::vec2(picture.width, picture.height) + place.px;
}

}  // namespace

const HudFont& hud_font() {
  static const HudFont font{{kBakedWidth, kBakedHeight},
                            std::as_bytes(std::span(kBakedTexels)),
                            kBakedLetters,
                            kBakedEm,
                            kBakedAscent,
                            kBakedSpread};
  return font;
}

const BakedLetter& HudFont::letter(char32_t code) const {
  const auto find = [this](char32_t wanted) {
    const auto found = std::ranges::lower_bound(letters, wanted, {}, &BakedLetter::code);
    return found != letters.end() && found->code == wanted ? &*found : nullptr;
  };
  if (const BakedLetter* found = find(code)) return *found;
  const BakedLetter* const replacement = find(0xFFFD);
  return replacement != nullptr ? *replacement : letters.front();
}

void add_quad(Vertices& out, const Box& at, const Box& uv, const glm::vec4& colour,
              const glm::vec4& look) {
  const auto corner = [&](bool right, bool bottom) {
    return shaders::OverlayVertex{{right ? at.x1 : at.x0, bottom ? at.y1 : at.y0,
                                   right ? uv.x1 : uv.x0, bottom ? uv.y1 : uv.y0},
                                  colour,
                                  look};
  };
  for (const auto& [right, bottom] : {std::pair{false, false},
                                      {false, true},
                                      {true, true},
                                      {false, false},
                                      {true, true},
                                      {true, false}})
    out.push_back(corner(right, bottom));
}

void lay_out_hud(const HudDrawing& drawing, core::Extent picture, const HudAtlas& atlas,
                 Vertices& out) {
  for (const HudArea& area : drawing.areas) {
    const glm::vec2 from = glm::round(pixels_of(area.at, picture));
    const glm::vec2 to = glm::round(from + pixels_of(area.size, picture));
    if (!is_finite(from) || !is_finite(to) || out.size() >= kMaxHudQuads * 6) continue;
    add_quad(out,
             box_of(glm::clamp(from, -kMaxOffPx, kMaxOffPx), glm::clamp(to, -kMaxOffPx, kMaxOffPx)),
             box_of(atlas.white_uv, atlas.white_uv), area.colour);
  }
  for (const HudText& text : drawing.texts)
    if (std::isfinite(text.size_px)) TextLayout(text, picture, atlas, out).add();
}

glm::vec2 measure(const HudText& text) {
  if (!std::isfinite(text.size_px)) return {};
  const float size_px = std::clamp(text.size_px, kMinSizePx, kMaxSizePx);
  glm::vec2 extent{0.0F};
  each_line(text.text, [&](std::string_view line) {
    extent.x = std::max(extent.x, width_of(line, size_px / hud_font().em));
    extent.y += std::round(size_px);
  });
  return extent;
}

}  // namespace psygen::render
