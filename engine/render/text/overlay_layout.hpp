// Everything over the picture as triangles: panels of text in ImGui's built-in font, which is
// scaled by whole numbers and stays sharp; a game's HUD (hud_layout.hpp); and what ImGui drew. Has
// the one font atlas of all three, but no ImGui context, so there is no global state (app/gui.hpp
// has one). No Vulkan. Immutable, any thread; linear in what is laid out.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/surface_provider.hpp"
#include "engine/render/hud_drawing.hpp"
#include "engine/render/text/hud_layout.hpp"
#include "shaders/shared.h"

struct ImDrawData;
struct ImFontAtlas;

namespace psygen::render {

// Triangles of ImGui that share a clip rectangle, in pixels.
struct GuiRun {
  std::uint32_t first_vertex = 0, vertex_count = 0;
  std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

// The fonts and the layout.
class OverlayLayout {
 public:
  static constexpr std::size_t kMaxQuads = 4096;  // further quads are left out
  static constexpr int kMaxScale = 4;
  static constexpr std::size_t kMaxGuiVertices = 600'000;  // further draws are left out

  // Builds the font atlas of all scales.
  OverlayLayout();
  ~OverlayLayout();
  OverlayLayout(const OverlayLayout&) = delete;
  OverlayLayout& operator=(const OverlayLayout&) = delete;

  // The font atlas: one byte of coverage per texel, row by row. Valid while this object lives.
  core::Extent atlas_size() const;
  std::span<const std::byte> atlas() const;

  // Appends the quads of all panels, six vertices each: a dark area, then its lines.
  // `picture` is in pixels. `scale` is that of the text, rounded and limited to 1 … kMaxScale.
  void lay_out(std::span<const TextPanel> panels, core::Extent picture, float scale,
               std::vector<shaders::OverlayVertex>& out) const;
  // Appends a game's texts and areas.
  void lay_out(const HudDrawing& drawing, core::Extent picture,
               std::vector<shaders::OverlayVertex>& out) const;
  // Appends what ImGui drew with a context on font_atlas(), and replaces `runs`. Draw callbacks and
  // textures other than the atlas are not supported: their triangles are left out.
  void lay_out(const ImDrawData& drawn, core::Extent picture,
               std::vector<shaders::OverlayVertex>& out, std::vector<GuiRun>& runs) const;
  // The atlas for an ImGui context; its first font is that of the HUD. Valid while this object
  // lives.
  ImFontAtlas& font_atlas() const;

  // Inserts a dark background of the whole picture before all of `out`.
  void put_ground_under(core::Extent picture, std::vector<shaders::OverlayVertex>& out) const;

 private:
  struct Fonts;
  void put_hud_font();
  std::unique_ptr<Fonts> fonts_;
};

}  // namespace psygen::render
