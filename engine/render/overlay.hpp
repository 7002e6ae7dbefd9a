// Panels of text over the picture: glyphs of ImGui's built-in font as quads. The font is scaled by
// whole numbers, which keeps it sharp. Uses only the font and its atlas, but no ImGui context, so
// there is no global state. No Vulkan. Immutable, any thread; linear in the text.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/surface_provider.hpp"
#include "engine/render/text_panel.hpp"
#include "shaders/shared.h"

namespace psygen::render {

// The fonts and the layout.
class Overlay {
 public:
  static constexpr std::size_t kMaxQuads = 4096;  // further quads are left out
  static constexpr int kMaxScale = 4;

  // Builds the font atlas of all scales.
  Overlay();
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  // The font atlas: one byte of coverage per texel, row by row. Valid while this object lives.
  core::Extent atlas_size() const;
  std::span<const std::byte> atlas() const;

  // Replaces `out` by the quads of all panels, six vertices each: a dark area, then its lines.
  // `picture` is in pixels. `scale` is that of the text, rounded and limited to 1 … kMaxScale.
  void lay_out(std::span<const TextPanel> panels, core::Extent picture, float scale,
               std::vector<shaders::OverlayVertex>& out) const;
  // Inserts a dark background of the whole picture before all of `out`.
  void put_ground_under(core::Extent picture, std::vector<shaders::OverlayVertex>& out) const;

 private:
  struct Fonts;
  std::unique_ptr<Fonts> fonts_;
};

}  // namespace psygen::render
