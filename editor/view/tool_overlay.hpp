// A tool's marks in a picture: lines that follow the ground and handles of constant size, and which
// of them is under the mouse. Looks up heights only where marks or ground change. Knows no
// renderer: lines and areas are values. Main thread.
#pragma once

#include <QPointF>
#include <span>
#include <vector>

#include "editor/view/surface_shape.hpp"
#include "editor/view/view_tool.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/surface_provider.hpp"
#include "engine/render/hud_drawing.hpp"
#include "engine/render/types.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {

// Through what a picture is seen. Its values stay as they were given.
struct Lens {
  Lens(const core::CameraPose& from, const core::Projection& by, core::Extent picture,
       double block_size_m);

  core::CameraPose pose;
  core::Projection projection;
  core::Extent size;  // pixels
  double block_m = 1;

  // The pixel of a place; nothing behind the camera.
  std::optional<glm::vec2> pixel_of(const core::WorldPosition& at) const;
  // The same for a place relative to the camera.
  std::optional<glm::vec2> pixel_of(const glm::vec3& from_eye) const;

 private:
  glm::mat4 to_clip_;  // of places relative to the camera; for thousands of points of lines
};

// A place of the world (x and z in metres) on the ground, or on the water over it.
core::WorldPosition on_surface(glm::dvec2 at_m, const world::World& world);

class ToolOverlay {
 public:
  // What is drawn from now on, on the ground of this world.
  void set(const ToolMarks& marks, const world::World& world);
  // The world is another one. Heights where its ground is the same stay.
  void note_world() { world_is_new_ = true; }
  // How many heights were looked up so far.
  std::size_t lookups() const { return lookups_; }

  // The lines from a camera, at the end of `lines`.
  void add_lines(const core::WorldPosition& eye, double block_m,
                 std::vector<render::Line>& lines) const;
  // The handles.
  void add_handles(const Lens& lens, render::HudDrawing& hud) const;
  // Completes a point: what is under a pixel.
  void hit(QPointF pixel, const Lens& lens, ToolPoint& point) const;

 private:
  // A point of a line as it is drawn, and the point of the tool's line that it lies behind.
  struct OnGround {
    core::WorldPosition at;
    std::size_t part = 0;
  };
  core::WorldPosition look_up(glm::dvec2 at_m, const world::World& world);
  std::vector<OnGround> line_on_ground(const std::vector<glm::dvec2>& points,
                                       const world::World& world);
  void take_ground(const world::World& world);

  ToolMarks marks_;
  bool world_is_new_ = true;
  std::optional<SurfaceShape> ground_;  // on which they lie
  double marks_block_m_ = 0;
  std::size_t lookups_ = 0;
  std::vector<core::WorldPosition> handles_;  // of marks_.handles
  std::vector<std::vector<OnGround>> lines_;  // of marks_.lines
};

}  // namespace psygen::editor
