// The horizon that the ground forms around the camera; rejects boxes hidden behind ridges. For each
// of kBins directions it stores the highest elevation up to which the ground is known to be solid
// within each of several distances, and the distance of the highest ground of all. Conservative:
// hides() is true only for boxes that are completely hidden, and may be false for others.
// Everything is relative to the camera. Knows no entities. Adding costs a few divisions per point
// and bin; a query costs a few operations per bin that the box spans. Allocates nothing; one thread
// at a time while adding.
//
// Use: call reset() for each camera position. Then, for the leaves of a cut from front to back
// (quadtree.hpp), first call hides() with the leaf's box, then add() lines of its surface if it is
// drawn. Correctness does not depend on the order, because distances are compared; but a line that
// is added late does not affect earlier queries. Afterwards hides() may be called for any box. Even
// below a higher, farther line, nearer lines still hide boxes that are at least twice as far as
// they are.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "engine/core/coordinates.hpp"

namespace psygen::visibility {

// Plain memory of fixed size, about 100 KiB.
class Horizon {
 public:
  static constexpr std::size_t kBins = 1024;  // bin borders lie on the axes; 0.22° to 0.45° wide

  // Starts without ground.
  Horizon();

  // Removes all ground.
  void reset();

  // Adds a line that lies in the drawn surface or below it, straight from point to point. Ground is
  // solid below it. Requires a camera above the drawn surface, and a surface without holes between
  // the camera and the line (skirts close cracks); otherwise add nothing. Lines of neighbouring
  // nodes whose ends meet, to a thousandth of a bin, count as one.
  void add(std::span<const glm::vec3> line);

  // Returns true if the whole box, which has finite corners, lies below and behind the horizon.
  // Never true for boxes above, below or around the camera.
  bool hides(const core::Bounds& box) const;

  // Elevation of the horizon (height per metre of horizontal distance) in the direction (x, z),
  // which is not (0, 0); −infinity where nothing was added. For views and tests.
  float elevation(float x, float z) const;

 private:
  struct Point;
  struct Piece;
  // A line that covers a bin from its left border up to `end`, or from `end` to its right border.
  struct Part {
    float end, tangent, distance_m;
  };

  void follow(const Point& from, const Point& to, bool forward, Piece& piece);
  void place(const Piece& piece, double other_end);
  void raise(std::size_t bin, float tangent, float distance_m);
  struct Box;
  bool hides_in(std::size_t first, std::size_t last, const Box& box) const;

  // Band b = 1 … kBands reaches 16 m · 2^(b − 1) from the camera; farther ground is in no band.
  static constexpr std::size_t kBands = 10;
  static constexpr float kFirstBandM = 16;
  static std::size_t bands_within(float distance_m);

  std::array<float, kBins> tangent_, distance_m_;  // of the highest ground that covers the bin
  // The highest ground that is no farther than each band, ascending; row 0 has no ground. The
  // padding keeps rows from starting in the same cache set.
  std::array<std::array<float, kBins + 16>, kBands + 1> within_;
  std::array<Part, kBins> left_, right_;  // the highest that covers part of the bin
  // The smallest 1 / |x| and 1 / |z| of unit vectors in the bin, and unit vectors along left
  // borders.
  std::array<float, kBins> inverse_x_, inverse_z_;
  std::array<glm::dvec2, kBins> border_;
};

}  // namespace psygen::visibility
