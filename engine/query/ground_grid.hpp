// The ground of one block as in its finest mesh: quantised heights and two triangles per cell, cut
// from (x, z + 1) to (x + 1, z). Returns heights and intersections of rays. It knows no neighbours,
// materials or water. Immutable after construction; any thread.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/models/terrain/terrain.hpp"

namespace psygen::query {

// The points from + t · step. The absolute value of a component of `step` is 0 or at least
// kMinStep, so products with `inverse` are finite.
struct PlaneLine {
  static constexpr double kMinStep = 1e-15;
  glm::dvec2 from{0.0}, step{0.0}, inverse{0.0};

  // `direction` may have any length; components below kMinStep become 0.
  PlaneLine(glm::dvec2 first, glm::dvec2 direction) : from(first), step(direction) {
    for (int i = 0; i < 2; ++i) {
      if (std::abs(step[i]) < kMinStep) step[i] = 0;
      inverse[i] = step[i] == 0 ? 0 : 1 / step[i];
    }
  }
  // The point at parameter `t`.
  glm::dvec2 at(double t) const { return from + t * step; }
  // The parameter at which coordinate `axis` leaves the square `index` of this side length;
  // infinite if the line does not move along the axis.
  double leaves(int axis, std::int64_t index, double side) const {
    if (step[axis] == 0) return std::numeric_limits<double>::infinity();
    const auto border = static_cast<double>(step[axis] > 0 ? index + 1 : index) * side;
    return (border - from[axis]) * inverse[axis];
  }
};

// Calls visit(x, z, from, to) for each square [x · side, (x + 1) · side) × … that `line` crosses
// for t in [from, to], in order. Successive intervals touch; some may be empty. Ends when `visit`
// returns false. Rounding may start the walk in a neighbour of the first square. Linear in the
// squares (Amanatides and Woo, "A fast voxel traversal algorithm", Eurographics 1987).
template <class Visit>
void march(const PlaneLine& line, double side, double from, double to, Visit&& visit) {
  const glm::dvec2 first = line.at(from) / side;
  auto x = static_cast<std::int64_t>(std::floor(first.x));
  auto z = static_cast<std::int64_t>(std::floor(first.y));
  while (true) {
    const double leaves_x = line.leaves(0, x, side), leaves_z = line.leaves(1, z, side);
    const double until = std::clamp(std::min(leaves_x, leaves_z), from, std::max(from, to));
    if (!visit(x, z, from, until) || until >= to) return;
    from = until;
    if (leaves_x <= leaves_z)
      x += line.step.x > 0 ? 1 : -1;
    else
      z += line.step.y > 0 ? 1 : -1;
  }
}

// The side of the ground on which a ray is.
enum class Side : std::uint8_t {
  kUnknown,  // before the start of the ray
  kAbove,    // the ray is above the ground
  kBelow,
};

// A ray in metres from a block's corner: plane · t along x and z, and the height height + rise · t.
struct GroundRay {
  PlaneLine plane;
  double height = 0, rise = 0;
  // Height in metres at parameter `t`.
  double height_at(double t) const { return height + rise * t; }
};

// Intersection of a ray with the surface.
struct GroundHit {
  double t = 0;
  glm::vec3 normal{0, 1, 0};  // of the triangle, upwards
  bool from_below = false;
};

// The heights of a block, with the lowest and highest of each tile of cells.
class GroundGrid {
 public:
  // A ray that begins within this vertical distance of the ground begins on the ground.
  static constexpr double kTouchM = 1e-6;

  // `heights` are size² values as models::BlockGround::heights() returns them. `relief_m` is the
  // height of the value 65535, `cell_m` the distance between vertices. Linear in the vertices.
  GroundGrid(std::vector<std::uint16_t> heights, double cell_m, double relief_m);

  int size() const { return size_; }  // vertices per side
  // Metres between vertices, and all heights in rows along x.
  double cell_m() const { return cell_m_; }
  std::span<const std::uint16_t> heights() const { return heights_; }
  // Metres of a quantised height; the same bits as models::BlockGround::at().
  double metres(std::uint16_t height) const { return relief_m_ * height / 65535.0; }
  // Lowest and highest height in metres.
  double lowest_m() const { return lowest_m_; }
  double highest_m() const { return highest_m_; }
  // Memory of this object.
  std::size_t bytes() const;

  // Height and normal at a point in metres from the corner. Points outside are clamped to the
  // border. Constant time.
  models::GroundPoint at(glm::dvec2 local_xz) const;

  // Returns the first point of [from, to] where the ray hits the surface. `side` is the ray's side
  // before `from`; on return, its side at `to`. A ray that begins on the ground (kTouchM) and does
  // not rise above it hits it at its origin. Linear in the cells below the ray that reach its
  // height.
  std::optional<GroundHit> cast(const GroundRay& ray, double from, double to, Side& side) const;

 private:
  struct Tile {
    std::uint16_t low = UINT16_MAX, high = 0;
  };
  struct Plane {
    double height, slope_x, slope_z;  // at the corner of the cell, and the rise per metre
  };
  Plane plane_of(std::int64_t x, std::int64_t z, bool lower) const;
  std::optional<GroundHit> cast_cell(const GroundRay& ray, std::int64_t x, std::int64_t z,
                                     double from, double to, Side& side) const;
  std::optional<GroundHit> cast_triangle(const GroundRay& ray, std::int64_t x, std::int64_t z,
                                         bool lower, double from, double to, Side& side) const;

  std::vector<std::uint16_t> heights_;
  int size_, tiles_;  // per side
  double cell_m_, relief_m_, lowest_m_, highest_m_;
  std::vector<Tile> tile_heights_;
};

}  // namespace psygen::query
