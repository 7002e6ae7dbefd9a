// Draws of parts of one index list: tiles of ground, and runs of a merged mesh. Adjacent parts
// become one draw, so that few draws cover the visible parts. Main thread only.
#pragma once

#include <vector>

#include "engine/core/geometry_memory.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/components.hpp"
#include "engine/scene/nodes/ground_sunlight.hpp"
#include "engine/scene/view/view.hpp"

namespace psygen::scene {

// `Draw`: render::TerrainDraw or render::MeshDraw. The destructor adds the last draw.
template <class Draw>
class DrawParts {
 public:
  DrawParts(const Draw& draw, std::vector<Draw>& draws) : draw_(draw), draws_(draws) {
    draw_.part = {};
  }
  ~DrawParts() { flush(); }
  DrawParts(const DrawParts&) = delete;
  DrawParts& operator=(const DrawParts&) = delete;

  // Adds a part. Parts come in the order of the list.
  void add(core::IndexPart part) {
    if (part.first != draw_.part.first + draw_.part.count) {
      flush();
      draw_.part = {part.first, 0};
    }
    draw_.part.count += part.count;
  }
  // For render::MeshDraw: the fraction of sunlight on the parts that follow.
  void set_sun(float sun) {
    if (sun == draw_.sun) return;
    flush();
    draw_.part = {};
    draw_.sun = sun;
  }
  // For render::TerrainDraw: true if the parts that follow are near.
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

// Adds draws for the parts of a merged mesh that may be visible, or for all parts if `view` is
// null. Each part gets the sunlight of the ground under it; `side_m` is the side of the node.
// `draw` is that of the whole mesh. Returns true if it added any.
bool add_parts(const MeshParts& parts, const View* view, const GroundSunlight& sun, float side_m,
               const render::MeshDraw& draw, std::vector<render::MeshDraw>& draws);

}  // namespace psygen::scene
