// What is known of a mesh entity before it has a mesh: where it stands, and which levels of detail
// it has. Pure functions.
#pragma once

#include <climits>

#include "engine/scene/components.hpp"

namespace psygen::scene {

// `usual`: in what part of the box its mesh lies (WorldFacts::usual_boxes).
Placed placed_at(core::BlockCoord block, glm::vec3 position, const core::Bounds& box,
                 const core::Bounds& usual);

// Levels `first` … `last` of a model type, at most as many as differ.
Detail detail_of(const models::ModelType& type, const models::Parameters& parameters, int first = 0,
                 int last = INT_MAX);

// Metres from a point to the nearest of what is usually drawn of an entity, at least `least_m`.
// `foot` is the entity's, relative to the point.
float distance_to(const Placed& placed, const glm::vec3& foot, float least_m);

// Pixels that an entity at this distance covers at most, along any axis.
float size_pixels(const Placed& placed, const Detail& detail, float distance_m,
                  float pixels_per_radian, float least_m);

}  // namespace psygen::scene
