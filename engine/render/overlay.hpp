// A few lines of text over the picture: glyphs of ImGui's built-in font as quads. Only the font and
// its atlas are used, no ImGui context, hence no global state. No Vulkan here.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/core/surface_provider.hpp"
#include "shaders/shared.h"

namespace psygen::render {

class Overlay {
 public:
  static constexpr std::size_t kMaxQuads = 4096;  // further text is cut off

  Overlay();
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  // One byte of coverage a texel.
  core::Extent atlas_size() const;
  std::span<const std::byte> atlas() const;

  // Replaces `out` with six vertices a quad: a dark panel in the top left and the lines on it.
  void lay_out(std::span<const std::string> lines, std::vector<shaders::OverlayVertex>& out) const;

 private:
  struct Font;
  std::unique_ptr<Font> font_;
};

}  // namespace psygen::render
