// Where meshes of a model type usually lie within their box. A type's box holds all that its
// parameters could lead to, for a tree several times as much as it takes: good for what must never
// be missed, not for how near or how large something is. Runs models; at start only.
#pragma once

#include <span>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/models/registry.hpp"
#include "engine/synthesis/cost_model.hpp"

namespace psygen::scene {

// For each type the box around the coarsest meshes of its first few samples, in units of −1 … 1
// along each axis of ModelType::bounds(); the whole box of types without samples, and of those that
// fail.
std::vector<core::Bounds> usual_boxes(const models::Registry& registry,
                                      std::span<const synthesis::CostSample> samples);

}  // namespace psygen::scene
