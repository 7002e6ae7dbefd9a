// The system "poses": plays the animations of instances, then places what is Attached, parents
// first. Private to engine/prefab.
#pragma once

#include "engine/prefab/prefab.hpp"
#include "engine/scene/state.hpp"

namespace psygen::prefab {

// Reads and writes in any order of entities and at any depth; O(Attached + keys found).
using PoseQuery = ecs::Query<const ecs::Children, Instance, Attached, scene::Transform>;
void poses_system(const Library& library, const scene::FixedStep& step, const scene::Clock& clock,
                  PoseQuery entities);

}  // namespace psygen::prefab
