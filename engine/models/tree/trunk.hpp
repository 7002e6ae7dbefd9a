// The trunk of a tree as a collider. Internal to trees. Pure, any thread, constant time: grows the
// trunk and no branch.
#pragma once

#include "engine/models/collider.hpp"
#include "engine/models/tree/plan.hpp"

namespace psygen::models {

// Capsules from the trunk's sunk base to its end, along its bends; each has the trunk's width at
// its middle. The drawn trunk differs from them by at most 0.1 of its length, its radius and the
// widening at its base together (trunk_test.cpp measures it). Branches have no collider. Needs 500
// KiB of stack.
Collider trunk_collider(const TreePlan& plan);

}  // namespace psygen::models
