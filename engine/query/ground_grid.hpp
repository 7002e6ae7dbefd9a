// The ground of one block as in its finest mesh: quantised heights and two triangles per cell, cut
// from (x, z + 1) to (x + 1, z). Returns heights and intersections of rays. It knows no neighbours,
// materials or water. Immutable after construction; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/models/terrain/terrain.hpp"
#include "engine/query/march.hpp"

namespace psygen::query {

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
