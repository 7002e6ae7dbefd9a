// Contact shadows of models near the camera, so that no model seems to float: one around the base
// point, and one in place of the sun's shadow unless shadows are drawn. Includes models outside the
// frustum, because their contact shadows may be inside. Main thread; linear in the models of near
// blocks.
#pragma once

#include <vector>

#include "engine/scene/draws/draw_lists.hpp"

namespace psygen::scene {

// Adds the contact shadows of a model. `tight`: bounds of its mesh, relative to the base point
// `foot`, which is relative to the camera; `sun` points towards the sun. `shadow` is true if a spot
// stands in for the sun's shadow. Grass gets one faint spot.
void add_spots(const core::Bounds& tight, bool grass, glm::vec3 foot, glm::vec3 sun, bool shadow,
               std::vector<render::GroundSpot>& spots);

// Adds those of all individual models on the nodes of the cut. `entities_of_cut`:
// DrawLists::entities.
void add_spots_near(const RenderContext& context, std::span<const ecs::Entity> entities_of_cut,
                    const RenderQuery& entities, glm::vec3 sun,
                    std::vector<render::GroundSpot>& spots);

}  // namespace psygen::scene
