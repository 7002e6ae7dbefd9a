// A brush stroke over a mask: the coverage of each pixel, and the resulting image. The brush is
// soft towards its rim; a second pass over a pixel in one stroke has no effect. A move costs as
// much as the pixels under it (changing_picture.hpp). Knows no document.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "editor/document/paint_change.hpp"
#include "editor/tools/changing_picture.hpp"

namespace psygen::editor {

struct Brush {
  double radius_m = 20;
  double strength = 1;  // 0 … 1: fraction of the way to the colour
  bool erases = false;  // black, else white
};

class MaskStroke {
 public:
  // A stroke over an image that covers an area (ScatterMask::area_m).
  MaskStroke(PicturePtr before, const std::array<double, 4>& area_m, const Brush& brush);

  // Moves the brush in a straight line; the first call starts the stroke. Returns false if the
  // brush touched no pixel.
  bool go_to(glm::dvec2 at_m);
  const PicturePtr& before() const { return before_; }
  // The image with the stroke so far.
  const PicturePtr& now() const { return picture_.now(); }
  // True if the stroke has touched a pixel.
  bool has_met() const { return has_met_; }
  // The rectangle that may differ from before().
  const PixelRect& touched() const { return touched_; }

 private:
  PixelRect around(glm::dvec2 from_m, glm::dvec2 to_m) const;
  bool cover(glm::dvec2 from_m, glm::dvec2 to_m, const PixelRect& rect,
             world::GreyPicture& picture);

  PicturePtr before_;
  ChangingPicture picture_;
  PixelRect touched_;
  std::array<double, 4> area_m_;
  Brush brush_;
  glm::dvec2 pixel_m_;
  std::vector<std::uint8_t> covered_;  // 0 … 255, per pixel
  bool begun_ = false, has_met_ = false;
  glm::dvec2 last_m_{0.0};
};

// Coverage of a point at a fraction of the brush's radius: 1 in the middle, 0 at the rim.
double brush_cover(double fraction);

}  // namespace psygen::editor
