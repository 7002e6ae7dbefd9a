// What is known of a mesh entity before it has a mesh: where it stands, which levels of detail it
// has, and how the cache names them. Pure functions.
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

// MeshKey::parameters_hash of an entity's meshes; of quads it says also which pictures they name.
std::uint64_t hash_of(const Source& source, bool picture);

// The mesh of a level of an entity, as the cache names it.
synthesis::MeshKey key_of(const Placed& placed, const Detail& detail, const Source& source,
                          std::uint8_t level);
// The level of an entity that a mesh of it is; kNoLevel for a picture that it does not have (any
// more).
std::uint8_t level_of(const Detail& detail, const Source& source, const synthesis::MeshKey& key);

// Metres from a point to the nearest of what is usually drawn of an entity, at least `min_m`.
// `foot` is the entity's, relative to the point.
float distance_to(const Placed& placed, const glm::vec3& foot, float min_m);

// Pixels that an entity at this distance covers at most, along any axis.
float size_pixels(const Placed& placed, const Detail& detail, float distance_m,
                  float pixels_per_radian, float min_m);

}  // namespace psygen::scene
