// A grid of lines on the ground around the camera, to judge sizes and distances. Every tenth line
// has another colour; the borders of blocks are a grid too. Knows no renderer: lines are values.
// Recomputed, in some milliseconds, when the camera has moved some cells or the ground has changed.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "editor/view/surface_shape.hpp"
#include "engine/render/types.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {

class GridOverlay {
 public:
  // Width of a cell in metres; 0: no grid. Lines are at multiples of the width in the world.
  static constexpr double kBlocks = -1;  // the width of a block
  void set_spacing(double spacing_m);
  double spacing_m() const { return spacing_m_; }
  // To be called after a change of the world. Lines on unchanged ground stay.
  void note_world() { world_is_new_ = true; }
  // Number of recomputations, for tests.
  std::size_t times_made() const { return times_made_; }
  // The lines relative to a camera. Valid until the next call.
  std::span<const render::Line> lines(const world::World& world, const core::WorldPosition& eye);

 private:
  void make(const world::World& world, const core::WorldPosition& eye, double cell_m);

  double spacing_m_ = 0;
  bool differs_from(const world::World& world, double cell_m);

  bool stale_ = true, world_is_new_ = true;
  std::size_t times_made_ = 0;
  std::optional<SurfaceShape> ground_;  // under the lines
  core::WorldPosition anchor_;          // lines are kept relative to it
  std::vector<render::Line> kept_, shown_;
};

}  // namespace psygen::editor
