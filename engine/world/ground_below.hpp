// The ground and the water on which a shape of a world is laid, and the edit of a piece of that
// shape. The same bits on every machine. Internal to world.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "engine/models/edits.hpp"
#include "engine/models/model_type.hpp"
#include "engine/world/curve.hpp"

namespace psygen::world {

struct World;

// The world and a layer of edits over it, which must outlive it unchanged. Places are x and z in
// metres of the world.
class GroundBelow {
 public:
  GroundBelow(const World& world, const models::EditLayer& layer);

  // The height of the ground, in metres. About 1 µs, and more with erosion or a river network.
  double ground_m(glm::dvec2 at_m) const;
  // The river or lake that covers a place, with the names of the layer; nothing: it is dry, or
  // under the sea.
  std::optional<models::BodySurface> water_over(glm::dvec2 at_m) const;

  // An edit with the square around a piece of a road or a river. `box` encloses the curve of the
  // piece, in metres from `origin`, and the piece acts up to `reach_m` from it.
  models::GroundEdit square_around(const FlatBox& box, const core::WorldPosition& origin,
                                   double reach_m) const;
  // The largest distance, in metres, by which an edit with a piece of a road, a river or a lake
  // moves a vertex of the finest ground. Looks at all vertices in small edits. For large ones it
  // returns the height range for a road, and looks at about 5,000 vertices for water, and adds a
  // reserve.
  double max_moved_m(const models::GroundEdit& edit) const;

 private:
  const World& world_;
  const models::EditLayer& layer_;
  models::Parameters terrain_;  // with the layer
};

}  // namespace psygen::world
