// Parts of one index list as draws, one for those that follow each other: tiles of ground and runs
// of a merged mesh are drawn with as few draws as what is seen of them allows. Knows nothing of
// what is in view.
#pragma once

#include <vector>

#include "engine/core/geometry_memory.hpp"

namespace psygen::scene {

// `Draw`: render::TerrainDraw or render::MeshDraw. What was added is drawn when this is destroyed.
template <class Draw>
class DrawParts {
 public:
  DrawParts(const Draw& draw, std::vector<Draw>& draws) : draw_(draw), draws_(draws) {
    draw_.part = {};
  }
  ~DrawParts() { flush(); }
  DrawParts(const DrawParts&) = delete;
  DrawParts& operator=(const DrawParts&) = delete;

  // Draws a part too. Parts come in the order of the list.
  void add(core::IndexPart part) {
    if (part.first != draw_.part.first + draw_.part.count) {
      flush();
      draw_.part = {part.first, 0};
    }
    draw_.part.count += part.count;
  }
  // Of render::MeshDraw: what comes from here on is drawn with this share of the sun.
  void set_sun(float sun) {
    if (sun == draw_.sun) return;
    flush();
    draw_.part = {};
    draw_.sun = sun;
  }
  // Of render::TerrainDraw: whether what comes from here on is near.
  void set_near(bool near) {
    if (near == draw_.near) return;
    flush();
    draw_.part = {};
    draw_.near = near;
  }

 private:
  void flush() {
    if (draw_.part.count > 0) draws_.push_back(draw_);
  }

  Draw draw_;
  std::vector<Draw>& draws_;
};

}  // namespace psygen::scene
