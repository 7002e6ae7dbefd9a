// A tool's marks in the view: lines that follow the ground, and handles of constant size. Finds the
// mark under the pointer. Computes heights only where marks or ground change. Knows no renderer:
// lines and areas are values. Main thread.
#pragma once

#include <QPointF>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "editor/view/surface_shape.hpp"
#include "editor/view/view_tool.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/surface_provider.hpp"
#include "engine/render/hud_drawing.hpp"
#include "engine/render/types.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {

// The camera of a frame: projects points of the world to pixels. Immutable.
struct ViewProjection {
  ViewProjection(const core::CameraPose& from, const core::Projection& by, core::Extent pixels,
                 double block_size_m);

  core::CameraPose pose;
  core::Projection projection;
  core::Extent size;  // pixels
  double block_m = 1;

  // The pixel of a world position; nullopt behind the camera.
  std::optional<glm::vec2> pixel_of(const core::WorldPosition& at) const;
  // The pixel of a point relative to the camera; nullopt behind it.
  std::optional<glm::vec2> pixel_of(const glm::vec3& from_eye) const;

 private:
  glm::mat4 to_clip_;  // from points relative to the camera
};

// The point (x and z in metres of the world) on the ground, or on the water above it.
core::WorldPosition on_surface(glm::dvec2 at_m, const world::World& world);

// The distance of a point from a line between two points. Vec is glm::vec2 or glm::dvec2. Both ends
// may be the same point.
template <class Vec>
typename Vec::value_type distance_to_segment(const Vec& p, const Vec& a, const Vec& b) {
  using T = typename Vec::value_type;
  const Vec along = b - a;
  const T length2 = glm::dot(along, along);
  const T t = length2 > 0 ? glm::clamp(glm::dot(p - a, along) / length2, T(0), T(1)) : T(0);
  return glm::length(p - (a + t * along));
}

class ToolOverlay {
 public:
  // Sets the marks, on the ground of this world.
  void set(const ToolMarks& marks, const world::World& world);
  // To be called after a change of the world. Heights on unchanged ground stay.
  void note_world() { world_is_new_ = true; }
  // Number of computed heights so far, for tests.
  std::size_t lookups() const { return lookups_; }

  // Appends the lines relative to a camera.
  void add_lines(const core::WorldPosition& eye, double block_m,
                 std::vector<render::Line>& lines) const;
  // Appends the handles.
  void add_handles(const ViewProjection& view, render::HudDrawing& hud) const;
  // Sets the handle or the line under a pixel in `point`.
  void hit(QPointF pixel, const ViewProjection& view, ToolPoint& point) const;

 private:
  // A drawn point of a line, and the preceding point of the tool's line.
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
  std::optional<SurfaceShape> ground_;  // under the marks
  double marks_block_m_ = 0;
  std::size_t lookups_ = 0;
  std::vector<core::WorldPosition> handles_;  // of marks_.handles
  std::vector<std::vector<OnGround>> lines_;  // of marks_.lines
};

}  // namespace psygen::editor
