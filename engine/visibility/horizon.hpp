// The horizon that the ground makes around the camera, to find what lies hidden behind ridges: for
// each of kBins directions the highest elevation up to which ground is known to stand within each
// of some distances, and how far away the highest of all stands. Conservative: hides() is true only
// for boxes of which nothing can be seen; of others it may say so or not. Everything is relative to
// the camera. Knows no entities. Adding costs a few divisions per point and bin, asking a few
// operations per bin that the box reaches into. Nothing is allocated after construction; one thread
// at a time while adding.
//
// Use: reset() for each camera position; then, for the leaves of a cut from front to back
// (quadtree.hpp), first ask hides() with a leaf's box, then add() lines of its surface if it is
// drawn. The order is not needed for correctness, as distances are compared; but a line that is
// added late hides nothing in what was asked before. Afterwards anything can be asked for: where a
// higher line stands farther away, the nearer ones still hide what lies twice as far as they do.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "engine/core/coordinates.hpp"

namespace psygen::visibility {

class Horizon {
 public:
  static constexpr std::size_t kBins = 1024;  // borders on the axes; 0.22° to 0.45° wide

  Horizon();

  // Forgets all ground.
  void reset();

  // Points of a line that lies in the drawn surface or below it, straight from point to point.
  // Ground is solid below. Requires a camera above the drawn surface, and a surface without holes
  // between the camera and the line (skirts close cracks); otherwise add nothing. Lines of
  // neighbouring nodes whose ends meet, to a thousandth of a bin, are taken as one.
  void add(std::span<const glm::vec3> line);

  // Whether all of a box with finite corners lies below the horizon and behind it. Never for boxes
  // above, below or around the camera.
  bool hides(const core::Bounds& box) const;

  // Elevation of the horizon (height per metre of horizontal distance) in the direction (x, z) that
  // is not (0, 0); −infinity where nothing was added. For views and tests.
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

  // Within 16 m and each power of two times as much; farther ground is in no band.
  static constexpr std::size_t kBands = 10;
  static constexpr float kFirstBandM = 16;
  static std::size_t bands_within(float distance_m);

  std::array<float, kBins> tangent_, distance_m_;  // of the highest ground that covers the bin
  // The highest that is no farther than each band, growing; before them a row of no ground. Rows
  // do not all begin in the same set of a cache.
  std::array<std::array<float, kBins + 16>, kBands + 1> within_;
  std::array<Part, kBins> left_, right_;  // the highest that covers a part of it
  // The smallest 1 / |x| and 1 / |z| of unit vectors in the bin; unit vectors along left borders.
  std::array<float, kBins> inverse_x_, inverse_z_;
  std::array<glm::dvec2, kBins> border_;
};

}  // namespace psygen::visibility
