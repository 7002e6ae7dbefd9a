#include "editor/tools/mask_stroke.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "editor/view/tool_overlay.hpp"

namespace psygen::editor {
namespace {

constexpr double kHardFraction = 0.5;  // of the radius: full coverage
constexpr double kMinRadiusPx = 0.75;  // so that the smallest brush touches a pixel

}  // namespace

double brush_cover(double fraction) {
  const double t = std::clamp((1 - fraction) / (1 - kHardFraction), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

MaskStroke::MaskStroke(PicturePtr before, const std::array<double, 4>& area_m, const Brush& brush)
    : before_(std::move(before)),
      picture_(before_),
      area_m_(area_m),
      brush_(brush),
      pixel_m_((area_m[2] - area_m[0]) / before_->width, (area_m[3] - area_m[1]) / before_->height),
      covered_(before_->pixels.size()) {
  brush_.radius_m = std::max(brush_.radius_m, kMinRadiusPx * std::max(pixel_m_.x, pixel_m_.y));
}

bool MaskStroke::go_to(glm::dvec2 at_m) {
  const glm::dvec2 from_m = begun_ ? last_m_ : at_m;
  begun_ = true;
  last_m_ = at_m;
  const PixelRect rect = around(from_m, at_m);
  if (rect.empty()) return false;
  bool met = false;
  picture_.change(rect,
                  [&](world::GreyPicture& picture) { met = cover(from_m, at_m, rect, picture); });
  touched_.add(rect);
  has_met_ = has_met_ || met;
  return met;
}

// The pixels that the brush can touch on its way.
PixelRect MaskStroke::around(glm::dvec2 from_m, glm::dvec2 to_m) const {
  const glm::dvec2 corner_m(area_m_[0], area_m_[1]);
  const glm::dvec2 low = (glm::min(from_m, to_m) - brush_.radius_m - corner_m) / pixel_m_;
  const glm::dvec2 high = (glm::max(from_m, to_m) + brush_.radius_m - corner_m) / pixel_m_;
  const auto bound = [](double at, std::uint32_t size) {
    return static_cast<std::uint32_t>(std::clamp(std::floor(at), 0.0, double{1} * size));
  };
  return {bound(low.x, before_->width), bound(low.y, before_->height),
          bound(high.x + 1, before_->width), bound(high.y + 1, before_->height)};
}

bool MaskStroke::cover(glm::dvec2 from_m, glm::dvec2 to_m, const PixelRect& rect,
                       world::GreyPicture& picture) {
  const glm::dvec2 corner_m(area_m_[0], area_m_[1]);
  const double target = brush_.erases ? 0 : 65535;
  bool met = false;
  for (std::uint32_t y = rect.top; y < rect.bottom; ++y) {
    for (std::uint32_t x = rect.left; x < rect.right; ++x) {
      const glm::dvec2 middle_m = corner_m + (glm::dvec2(x, y) + 0.5) * pixel_m_;
      const double cover =
          255 * brush_cover(distance_to_segment(middle_m, from_m, to_m) / brush_.radius_m);
      const std::size_t i = std::size_t{y} * picture.width + x;
      if (cover <= 0) continue;
      met = true;
      if (cover <= covered_[i]) continue;
      covered_[i] = static_cast<std::uint8_t>(std::ceil(cover));
      const double was = before_->pixels[i];
      const double blend = brush_.strength * covered_[i] / 255;
      picture.pixels[i] = static_cast<std::uint16_t>(std::lround(was + (target - was) * blend));
    }
  }
  return met;
}

}  // namespace psygen::editor
