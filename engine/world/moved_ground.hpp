// Measures how far the edit of a road, a river or a lake moves the ground, because queries and
// horizon culling need a bound of all heights (models::GroundEdit::max_m). The same bits on every
// machine. A pure function. Internal to world.
#pragma once

#include "engine/models/edits.hpp"

namespace psygen::world {

struct World;

// Returns the largest distance, in metres, by which a piece of a road, a river or a lake moves a
// vertex of the finest ground of `before`. Looks at all vertices in small edits. In large ones,
// roads return the height range, and water looks at about 5,000 vertices and adds a reserve. Takes
// up to 1 µs for each vertex. Requires the centre, the radius and the piece of the edit.
double max_moved_m(const World& world, const models::GroundEdit& edit,
                   const models::Parameters& before);

}  // namespace psygen::world
