// Area and resolution of a new mask: defaults that fit a world, limits, and the resulting image
// size. Pure; it knows no document and no image.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>

#include "engine/core/camera.hpp"
#include "engine/core/error.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {

struct NewMask {
  static constexpr double kMinSideM = 16, kMaxSideM = 65'536;
  static constexpr double kMinPixelM = 0.1, kMaxPixelM = 256;
  static constexpr std::uint32_t kMinPixels = 2, kMaxPixels = 4096;  // a side

  bool whole_world = false;  // else a square around a point; ignored for endless worlds
  double side_m = 1024;      // of that square
  double pixel_m = 2;        // side of a pixel

  friend bool operator==(const NewMask&, const NewMask&) = default;
};

// The whole world up to 4,096 m, else a square of 1,024 m. A pixel has 2 m, doubled until a side
// has at most 1,024 pixels.
NewMask default_new_mask(const world::World& world);

// A rectangle of the world in metres, as ScatterMask::area_m, and the size of its image.
struct MaskPlan {
  std::array<double, 4> area_m{};
  std::uint32_t width = 0, height = 0;
};

// The rectangle, also of an invalid mask. A square is aligned to a grid of a 16th of its side, so
// that it stays in place while the camera moves a little.
std::array<double, 4> area_of(const NewMask& mask, const world::World& world, glm::dvec2 around_m);
// Fails with kInvalidArgument for a side or a pixel beyond the limits, and with kOverBudget for
// more than kMaxPixels a side.
core::Result<MaskPlan> plan_of(const NewMask& mask, const world::World& world, glm::dvec2 around_m);

// The point of the ground in the middle of a view (x and z in metres of the world), at most
// `max_m` metres in front of the camera.
glm::dvec2 middle_of_view(const core::CameraPose& pose, const world::World& world, double max_m);

}  // namespace psygen::editor
