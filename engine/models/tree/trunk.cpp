#include "engine/models/tree/trunk.hpp"

#include <algorithm>
#include <array>

#include "engine/models/tree/mesh.hpp"
#include "engine/models/tree/skeleton.hpp"

namespace psygen::models {

Collider trunk_collider(const TreePlan& plan) {
  constexpr std::array kEnds{0.0F, 0.15F, 0.5F, 1.0F};
  TreeSkeleton trunk;
  grow_tree(plan, 0, 1, trunk);
  const float end = plan.grammar->grows(plan.axiom) ? plan.taper : 0.0F;
  Collider collider;
  for (std::size_t i = 0; i + 1 < kEnds.size(); ++i) {
    const float middle = 0.5F * (kEnds[i] + kEnds[i + 1]);
    const float near_foot =
        std::max(1.0F - 3.0F * middle, 0.0F);  // as places_of_rings() in bark.cpp
    const float radius = trunk.rows[kRadius][0] * (1.0F - middle * (1.0F - end)) *
                         (1.0F + plan.flare * near_foot * near_foot);
    glm::vec3 from = trunk.point(0, kEnds[i]);
    if (i == 0) from.y -= sink_m(plan);
    collider.shapes.emplace_back(Collider::Capsule{from, trunk.point(0, kEnds[i + 1]), radius});
  }
  return collider;
}

}  // namespace psygen::models
