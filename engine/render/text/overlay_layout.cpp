#include "engine/render/text/overlay_layout.hpp"

#include <imgui/imgui.h>
#include <imgui/imgui_internal.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "engine/core/assert.hpp"

namespace psygen::render {

struct OverlayLayout::Fonts {
  ImFontAtlas atlas;
  std::array<ImFont*, kMaxScale> by_scale{};
  unsigned char* pixels = nullptr;  // owned by the atlas
  int width = 0, height = 0;
  glm::vec2 hud_corner{0.0F};  // texels
};

namespace {

// In pixels of scale 1.
constexpr float kFontSize = 13.0F;
constexpr float kMargin = 8.0F;  // around a panel, and between it and its text
constexpr float kBarHeight = 10.0F;
constexpr float kSwatch = 9.0F;

constexpr std::size_t kMinColumns = 8, kBarColumns = 40;
constexpr std::size_t kSwatchColumns = 2;     // of a swatch before its text
constexpr std::size_t kContinuedColumns = 2;  // indentation of continued rows

constexpr glm::vec4 kTextColour{0.96F, 0.97F, 0.94F, 1.0F};
constexpr glm::vec4 kPanelColour{0.03F, 0.04F, 0.06F, 0.70F};
constexpr glm::vec4 kGroundColour{0.06F, 0.08F, 0.11F, 1.0F};
constexpr glm::vec4 kBarColour{0.45F, 0.66F, 0.85F, 1.0F};
constexpr glm::vec4 kBarGroundColour{0.25F, 0.27F, 0.30F, 1.0F};

void add_area(std::vector<shaders::OverlayVertex>& out, const Box& at, const ImFontAtlas& atlas,
              const glm::vec4& colour) {
  const ImVec2 white = atlas.TexUvWhitePixel;
  add_quad(out, at, {white.x, white.y, white.x, white.y}, colour);
}

glm::vec4 colour_of(std::uint32_t rgb) {
  const auto part = [rgb](unsigned shift) {
    return static_cast<float>(rgb >> shift & 0xFF) / 255.0F;
  };
  return {part(16), part(8), part(0), 1.0F};
}

// Bytes that are not UTF-8 become the font's replacement character.
std::vector<ImWchar> characters_of(const std::string& text) {
  std::vector<ImWchar> characters;
  const char* const end = text.data() + text.size();
  for (const char* at = text.data(); at < end;) {
    unsigned character = 0;
    at += std::max(ImTextCharFromUtf8(&character, at, end), 1);
    characters.push_back(
        static_cast<ImWchar>(character <= 0xFFFF ? character : 0xFFFDU));  // else U+FFFD
  }
  return characters;
}

// One row of a panel on screen: a line, or a part of one.
struct Row {
  std::vector<ImWchar> characters = {};
  std::size_t indent = 0;  // columns before it
  std::optional<std::uint32_t> swatch = {};
  std::optional<float> bar = {};

  std::size_t columns() const {
    return std::max(indent + characters.size(), bar ? kBarColumns : 0);
  }
};

// Breaks a line into rows, at the last space that fits, or within a word longer than a row.
void add_rows(const TextLine& line, std::size_t columns, std::vector<Row>& rows) {
  std::vector<ImWchar> rest = characters_of(line.text);
  Row row{.indent = line.swatch ? kSwatchColumns : 0, .swatch = line.swatch};
  while (row.indent + rest.size() > columns) {
    const auto room = static_cast<std::ptrdiff_t>(columns - row.indent);
    const auto space = std::find(std::make_reverse_iterator(rest.begin() + room + 1),
                                 std::make_reverse_iterator(rest.begin() + 1), ImWchar{' '});
    const bool found = space.base() != rest.begin() + 1;
    const auto end = found ? space.base() - 1 : rest.begin() + room;
    row.characters.assign(rest.begin(), end);
    rows.push_back(row);
    rest.erase(rest.begin(), found ? end + 1 : end);
    row = {.indent = kContinuedColumns + (line.swatch ? kSwatchColumns : 0)};
  }
  row.characters = std::move(rest);
  row.bar = line.bar;
  rows.push_back(std::move(row));
}

// Lays out panels one after the other, each where the previous ones leave room.
class Layout {
 public:
  Layout(const ImFontAtlas& atlas, ImFont& font, float scale, core::Extent picture,
         std::vector<shaders::OverlayVertex>& out)
      : atlas_(atlas),
        font_(font),
        scale_(scale),
        advance_(font.FindGlyph(' ')->AdvanceX),
        width_(static_cast<float>(picture.width)),
        height_(static_cast<float>(picture.height)),
        max_(out.size() + OverlayLayout::kMaxQuads * 6),
        out_(out) {}

  void add(const TextPanel& panel) {
    const float room = (width_ - 4 * margin()) / advance_;
    const std::size_t columns =
        std::max(kMinColumns, static_cast<std::size_t>(std::max(room, 0.0F)));
    std::vector<Row> rows;
    for (const TextLine& line : panel.lines)
      add_rows(line, columns, rows);
    if (rows.empty()) return;
    std::size_t widest = 0;
    float height = 2 * margin();
    for (const Row& row : rows) {
      widest = std::max(widest, std::min(row.columns(), columns));
      height += row_height(row);
    }
    const float width = 2 * margin() + static_cast<float>(widest) * advance_;
    const Box box = place(panel.anchor, width, height);
    add_area(out_, box, atlas_, kPanelColour);
    float y = box.y0 + margin();
    for (const Row& row : rows) {
      if (out_.size() >= max_) break;
      draw(row, box.x0 + margin(), box.x1 - margin(), y);
      y += row_height(row);
    }
  }

  // Leaves out what is too much.
  void cut_off() {
    if (out_.size() > max_) out_.resize(max_);
  }

 private:
  float margin() const { return kMargin * scale_; }
  float line_height() const { return (kFontSize + 2) * scale_; }
  float row_height(const Row& row) const {
    return line_height() + (row.bar ? (kBarHeight + 4) * scale_ : 0);
  }

  Box place(Anchor anchor, float width, float height) {
    float x = margin(), y = margin();
    if (anchor == Anchor::kTopRight) x = width_ - margin() - width;
    if (anchor == Anchor::kBottom || anchor == Anchor::kMiddle) x = (width_ - width) / 2;
    if (anchor == Anchor::kBottom) y = height_ - margin() - height;
    if (anchor == Anchor::kMiddle) y = (height_ - height) / 2;
    x = std::floor(std::max(x, 0.0F));
    y = std::floor(std::max(y, 0.0F));
    if (anchor == Anchor::kTopRight && x < left_.x1 + margin())
      y = std::max(y, left_.y1 + margin());
    const Box box{x, y, x + width, y + height};
    if (anchor == Anchor::kTopLeft) left_ = box;
    return box;
  }

  void draw(const Row& row, float x, float right, float y) {
    if (row.swatch) {
      const float top = y + 2 * scale_, size = kSwatch * scale_;
      add_area(out_, {x, top, x + size, top + size}, atlas_, kTextColour);
      add_area(out_, {x + scale_, top + scale_, x + size - scale_, top + size - scale_}, atlas_,
               colour_of(*row.swatch));
    }
    float at = x + static_cast<float>(row.indent) * advance_;
    for (const ImWchar character : row.characters) {
      const ImFontGlyph* glyph = font_.FindGlyph(character);
      if (glyph->Visible) {
        add_quad(out_, {at + glyph->X0, y + glyph->Y0, at + glyph->X1, y + glyph->Y1},
                 {glyph->U0, glyph->V0, glyph->U1, glyph->V1}, kTextColour);
      }
      at += advance_;
    }
    if (!row.bar) return;
    const float top = y + line_height() + 2 * scale_, bottom = top + kBarHeight * scale_;
    const float done = std::isfinite(*row.bar) ? std::clamp(*row.bar, 0.0F, 1.0F) : 0.0F;
    add_area(out_, {x, top, right, bottom}, atlas_, kBarGroundColour);
    add_area(out_, {x, top, std::round(x + (right - x) * done), bottom}, atlas_, kBarColour);
  }

  const ImFontAtlas& atlas_;
  ImFont& font_;                 // ImGui 1.91 finds glyphs in fonts that are not constant
  const float scale_, advance_;  // all characters of the font have the same advance
  const float width_, height_;   // of the picture
  Box left_{0, 0, -1e9F, 0};     // the last panel on the left
  const std::size_t max_;        // vertices
  std::vector<shaders::OverlayVertex>& out_;
};

}  // namespace

OverlayLayout::OverlayLayout() : fonts_(std::make_unique<Fonts>()) {
  ImFontAtlas& atlas = fonts_->atlas;
  const HudFont& hud = hud_font();
  atlas.Flags |= ImFontAtlasFlags_NoPowerOfTwoHeight;
  atlas.TexDesiredWidth = static_cast<int>(std::bit_ceil(hud.size.width + 2));
  // ImGui's default font is the first one. Its letters are replaced by those of the HUD below.
  constexpr ImWchar kOneLetter[] = {' ', ' ', 0};
  ImFontConfig first_font;
  first_font.GlyphRanges = kOneLetter;
  atlas.AddFontDefault(&first_font);
  for (std::size_t i = 0; i < fonts_->by_scale.size(); ++i) {
    ImFontConfig config;
    config.OversampleH = config.OversampleV = 1;
    config.PixelSnapH = true;
    config.SizePixels = kFontSize * static_cast<float>(i + 1);
    fonts_->by_scale[i] = atlas.AddFontDefault(&config);
  }
  const int place = atlas.AddCustomRectRegular(static_cast<int>(hud.size.width),
                                               static_cast<int>(hud.size.height));
  atlas.GetTexDataAsAlpha8(&fonts_->pixels, &fonts_->width, &fonts_->height);
  const ImFontAtlasCustomRect& rect = *atlas.GetCustomRectByIndex(place);
  PSYGEN_ASSERT(rect.IsPacked(), "the atlas has room for the font of the HUD");
  fonts_->hud_corner = {rect.X, rect.Y};
  put_hud_font();
}

// Copies the letters into the atlas, and makes a font of ImGui from them.
void OverlayLayout::put_hud_font() {
  const HudFont& hud = hud_font();
  const auto width = static_cast<std::size_t>(fonts_->width);
  const auto left = static_cast<std::size_t>(fonts_->hud_corner.x);
  const auto top = static_cast<std::size_t>(fonts_->hud_corner.y);
  for (std::size_t row = 0; row < hud.size.height; ++row) {
    std::memcpy(fonts_->pixels + (top + row) * width + left,
                hud.texels.data() + row * hud.size.width, hud.size.width);
  }
  ImFont& font = *fonts_->atlas.Fonts[0];
  font.ClearOutputData();
  font.ContainerAtlas = &fonts_->atlas;
  font.FontSize = hud.em;
  font.Ascent = hud.ascent;
  font.Descent = hud.ascent - hud.em;
  const glm::vec2 texels(fonts_->width, fonts_->height);
  for (const BakedLetter& letter : hud.letters) {
    const glm::vec2 from = (fonts_->hud_corner + glm::vec2(letter.u, letter.v)) / texels;
    const glm::vec2 to = from + glm::vec2(letter.width, letter.height) / texels;
    const float y = hud.ascent + letter.y;
    font.AddGlyph(nullptr, static_cast<ImWchar>(letter.code), letter.x, y, letter.x + letter.width,
                  y + letter.height, from.x, from.y, to.x, to.y, letter.advance);
  }
  font.EllipsisChar = 0x2026;
  font.BuildLookupTable();
}

ImFontAtlas& OverlayLayout::font_atlas() const {
  return fonts_->atlas;
}

void OverlayLayout::lay_out(const HudDrawing& drawing, core::Extent picture,
                            std::vector<shaders::OverlayVertex>& out) const {
  const ImVec2 white = fonts_->atlas.TexUvWhitePixel;
  lay_out_hud(drawing, picture, {atlas_size(), fonts_->hud_corner, {white.x, white.y}}, out);
}

namespace {

// A clip rectangle in whole pixels inside the picture; empty where nothing of it is.
GuiRun clip_of(const ImDrawCmd& command, const ImDrawData& drawn, core::Extent picture) {
  const auto in = [](float at, std::uint32_t most) {
    return static_cast<std::uint32_t>(std::clamp(at, 0.0F, static_cast<float>(most)));
  };
  const ImVec4& clip = command.ClipRect;
  const std::uint32_t x = in(std::floor(clip.x - drawn.DisplayPos.x), picture.width);
  const std::uint32_t y = in(std::floor(clip.y - drawn.DisplayPos.y), picture.height);
  const std::uint32_t right = in(std::ceil(clip.z - drawn.DisplayPos.x), picture.width);
  const std::uint32_t bottom = in(std::ceil(clip.w - drawn.DisplayPos.y), picture.height);
  return {0, 0, x, y, right > x ? right - x : 0, bottom > y ? bottom - y : 0};
}

}  // namespace

void OverlayLayout::lay_out(const ImDrawData& drawn, core::Extent picture,
                            std::vector<shaders::OverlayVertex>& out,
                            std::vector<GuiRun>& runs) const {
  runs.clear();
  const HudFont& hud = hud_font();
  // The place of the HUD's letters in the atlas.
  const glm::vec2 texels(fonts_->width, fonts_->height);
  const glm::vec2 from = fonts_->hud_corner / texels;
  const glm::vec2 to = from + glm::vec2(hud.size.width, hud.size.height) / texels;
  const std::size_t most = out.size() + kMaxGuiVertices;
  for (int i = 0; i < drawn.CmdListsCount; ++i) {
    const ImDrawList& list = *drawn.CmdLists[i];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      GuiRun run = clip_of(command, drawn, picture);
      const bool shown = command.UserCallback == nullptr &&
                         command.GetTexID() == fonts_->atlas.TexID && run.width > 0 &&
                         run.height > 0;
      if (!shown || out.size() + command.ElemCount > most) continue;
      run.first_vertex = static_cast<std::uint32_t>(out.size());
      run.vertex_count = command.ElemCount;
      for (unsigned int k = 0; k < command.ElemCount; ++k) {
        const int index = list.IdxBuffer[static_cast<int>(command.IdxOffset + k)];
        const ImDrawVert& v = list.VtxBuffer[static_cast<int>(command.VtxOffset) + index];
        const ImVec4 colour = ImGui::ColorConvertU32ToFloat4(v.col);
        const bool letter =
            v.uv.x >= from.x && v.uv.x <= to.x && v.uv.y >= from.y && v.uv.y <= to.y;
        out.push_back({{v.pos.x - drawn.DisplayPos.x, v.pos.y - drawn.DisplayPos.y, v.uv.x, v.uv.y},
                       {colour.x, colour.y, colour.z, colour.w},
                       {letter ? 2 * hud.spread : 0.0F, 0, 1, 0}});
      }
      runs.push_back(run);
    }
  }
}

OverlayLayout::~OverlayLayout() = default;

core::Extent OverlayLayout::atlas_size() const {
  return {static_cast<std::uint32_t>(fonts_->width), static_cast<std::uint32_t>(fonts_->height)};
}

std::span<const std::byte> OverlayLayout::atlas() const {
  return {reinterpret_cast<const std::byte*>(fonts_->pixels),
          static_cast<std::size_t>(fonts_->width) * static_cast<std::size_t>(fonts_->height)};
}

void OverlayLayout::lay_out(std::span<const TextPanel> panels, core::Extent picture, float scale,
                            std::vector<shaders::OverlayVertex>& out) const {
  const float whole =
      std::isfinite(scale) ? std::clamp(std::round(scale), 1.0F, float{kMaxScale}) : 1.0F;
  ImFont& font = *fonts_->by_scale[static_cast<std::size_t>(whole) - 1];
  Layout layout(fonts_->atlas, font, whole, picture, out);
  for (const TextPanel& panel : panels)
    layout.add(panel);
  layout.cut_off();
}

void OverlayLayout::put_ground_under(core::Extent picture,
                                     std::vector<shaders::OverlayVertex>& out) const {
  std::vector<shaders::OverlayVertex> ground;
  add_area(ground, {0, 0, static_cast<float>(picture.width), static_cast<float>(picture.height)},
           fonts_->atlas, kGroundColour);
  out.insert(out.begin(), ground.begin(), ground.end());
}

}  // namespace psygen::render
