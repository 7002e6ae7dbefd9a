// The system "poses": plays the animations of instances, then places Attached entities, parents
// first. Private to engine/prefab.
#pragma once

#include "ecs/ecs.hpp"
#include "engine/prefab/prefab.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/objects/components.hpp"
#include "engine/scene/scene.hpp"

namespace psygen::prefab {

// Accepts entities in any order and at any depth; O(Attached + keys found).
using PoseQuery = ecs::Query<const ecs::Children, Instance, Attached, scene::Transform>;
void poses_system(const Library& library, const scene::FixedStep& step, const scene::Clock& clock,
                  PoseQuery entities);

}  // namespace psygen::prefab
