// A grid of lines on the ground around the camera, for judging sizes and distances. Every tenth
// line has another colour; the borders of blocks are a grid too. Knows no renderer: lines are
// values. Made anew when the camera has moved some cells, which takes some milliseconds.
#pragma once

#include <span>
#include <vector>

#include "engine/render/types.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {

class GroundGrid {
 public:
  // Cells are so many metres wide; 0: no grid. Lines are at multiples of it in the world.
  static constexpr double kBlocks = -1;  // as wide as blocks
  void set_spacing(double spacing_m);
  double spacing_m() const { return spacing_m_; }
  // The ground is another one.
  void forget() { stale_ = true; }
  // The lines from a camera. Valid until the next call.
  std::span<const render::Line> lines(const world::World& world, const core::WorldPosition& eye);

 private:
  void make(const world::World& world, const core::WorldPosition& eye, double cell_m);

  double spacing_m_ = 0;
  bool stale_ = true;
  core::WorldPosition anchor_;  // lines are kept relative to it
  std::vector<render::Line> kept_, shown_;
};

}  // namespace psygen::editor
