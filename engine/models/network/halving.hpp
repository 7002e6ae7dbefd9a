// Halves the edges of a river network. A river's edge becomes two edges of the same river, so
// rivers never change once made. A new node off the rivers lies above the lower end of its edge and
// drains to a lower neighbour. So no river can rise, run in a circle or end on land, and no
// triangle can fold. Pure functions; any thread; about 0.2 µs a node.
#pragma once

#include "engine/models/network/lattice.hpp"
#include "engine/models/network/root.hpp"

namespace psygen::models::network {

// Largest displacement of a middle and largest length of an edge, in spacings of its level.
constexpr double kLargestShift = 0.42, kLongestEdge = 2.0;

// The nodes of a level that nodes of the level below it in `fine` depend on.
Rect coarse_for(const Rect& fine);

// Makes the nodes `want` of the level below `coarse`, which must hold coarse_for(want); an
// assertion fails if it does not, also in release.
NodePatch halve(const Scale& scale, LandFields& fields, const NodePatch& coarse, const Rect& want);

// An axis-aligned square of units.
struct Square {
  std::int64_t x = 0, z = 0, side = 0;
};

// A square whose nodes are wanted, those within `margin` units included.
struct Surroundings {
  Square square;
  std::int64_t margin = 0;
};

// Makes all nodes of a level in a square and its margin, with at least one ring of nodes around
// them, or as many as nodes_from() needs to make those of level `finest`.
NodePatch nodes_around(const Scale& scale, RootNodes& root, int level, const Surroundings& around,
                       int finest);
// The same from nodes of a coarser level, made with this finest level for a square and margin that
// hold these. An assertion fails if they do not suffice, as in halve().
NodePatch nodes_from(const Scale& scale, RootNodes& root, const NodePatch& coarse, int level,
                     const Surroundings& around, int finest);

}  // namespace psygen::models::network
