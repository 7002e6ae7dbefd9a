// A brush stroke over a mask: how far each pixel was covered, and the picture that comes of it.
// Soft towards its rim; going twice over a place in one stroke does no more. A move costs what the
// pixels under it cost (changing_picture.hpp). Knows no document.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "editor/document/paint_change.hpp"
#include "editor/tools/changing_picture.hpp"

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
  const PicturePtr& now() const { return picture_.now(); }
  // Whether it met any pixel so far.
  bool has_met() const { return has_met_; }
  // Where it may differ from before.
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

// How far the brush covers a place at a share of its radius: 1 in the middle, 0 at the rim.
double brush_cover(double share);

}  // namespace psygen::editor
