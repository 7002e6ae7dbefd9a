// The soft dark spots that models near the camera leave on the ground, so that nothing floats: one
// around the foot, and one where the sun would cast the shadow, unless shadows are drawn. Also of
// models beside the picture, whose spots may be in it. Main thread; linear in the models of near
// blocks.
#pragma once

#include <vector>

#include "engine/scene/state.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {

// Adds the spots of a model: `tight` is the box of its mesh from the foot, which is at `foot`
// relative to the camera; `sun` points towards the sun. Without `shadow`, only the one around the
// foot. Of grass (`grass`) there is a faint one.
void add_spots(const core::Bounds& tight, bool grass, glm::vec3 foot, glm::vec3 sun, bool shadow,
               std::vector<render::GroundSpot>& spots);

// Those of all single models of the nodes of the cut. `entities_of_cut`: DrawLists::entities.
void add_spots_near(const Camera& camera, const WorldFacts& facts, const View& view,
                    std::span<const ecs::Entity> entities_of_cut, const RenderQuery& entities,
                    glm::vec3 sun, std::vector<render::GroundSpot>& spots);

}  // namespace psygen::scene
