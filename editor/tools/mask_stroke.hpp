// A brush stroke over a mask: how far each pixel was covered, and the picture that comes of it.
// Soft towards its rim; going twice over a place in one stroke does no more. Knows no document.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "editor/document/paint_change.hpp"

namespace psygen::editor {

struct Brush {
  double radius_m = 20;  // beyond it nothing changes
  double strength = 1;   // share of the way to the colour, 0 … 1
  bool erases = false;   // black, else white
};

class MaskStroke {
 public:
  // Over a picture that lies on an area (ScatterMask::area_m).
  MaskStroke(PicturePtr before, const std::array<double, 4>& area_m, const Brush& brush);

  // The brush moves on in a straight line; the first point is the begin. False: it met no pixel.
  bool go_to(glm::dvec2 at_m);
  const PicturePtr& before() const { return before_; }
  // The picture with the stroke so far.
  const PicturePtr& now() const { return now_; }

 private:
  void cover(glm::dvec2 from_m, glm::dvec2 to_m, world::GreyPicture& picture);

  PicturePtr before_, now_;
  std::array<double, 4> area_m_;
  Brush brush_;
  glm::dvec2 pixel_m_;
  std::vector<std::uint8_t> covered_;  // 0 … 255, per pixel
  bool begun_ = false, met_ = false;
  glm::dvec2 last_m_{0.0};
};

// How far the brush covers a place at a share of its radius: 1 in the middle, 0 at the rim.
double brush_cover(double share);

}  // namespace psygen::editor
