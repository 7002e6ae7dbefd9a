// Panels of text over the picture: glyphs of ImGui's built-in font as quads, in whole multiples of
// its size, so that they are sharp. Only the font and its atlas are used, no ImGui context, hence
// no global state. No Vulkan here.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/surface_provider.hpp"
#include "engine/render/text_panel.hpp"
#include "shaders/shared.h"

namespace psygen::render {

class Overlay {
 public:
  static constexpr std::size_t kMaxQuads = 4096;  // further text is cut off
  static constexpr int kMaxScale = 4;

  Overlay();
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  // One byte of coverage a texel.
  core::Extent atlas_size() const;
  std::span<const std::byte> atlas() const;

  // Replaces `out` with six vertices a quad: a dark panel behind the lines of each. `picture` in
  // pixels. `scale` of the text, 1 to kMaxScale, is rounded.
  void lay_out(std::span<const TextPanel> panels, core::Extent picture, float scale,
               std::vector<shaders::OverlayVertex>& out) const;
  // A dark ground over the whole picture, before all of `out`.
  void put_ground_under(core::Extent picture, std::vector<shaders::OverlayVertex>& out) const;

 private:
  struct Fonts;
  std::unique_ptr<Fonts> fonts_;
};

}  // namespace psygen::render
