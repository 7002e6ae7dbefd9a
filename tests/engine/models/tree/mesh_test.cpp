#include "engine/models/tree/mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "engine/models/kit/packing.hpp"
#include "engine/models/tree/tree.hpp"
#include "tests/engine/models/mesh_helpers.hpp"

namespace psygen::models {
namespace {

// Distance outside the capsules in metres, negative inside.
float outside(const Collider& collider, const glm::vec3& p) {
  float least = 1e9F;
  for (const Collider::Shape& shape : collider.shapes) {
    const auto& c = std::get<Collider::Capsule>(shape);
    const glm::vec3 axis = c.to - c.from;
    const float t = glm::clamp(glm::dot(p - c.from, axis) / glm::dot(axis, axis), 0.0F, 1.0F);
    least = std::min(least, glm::length(p - c.from - t * axis) - c.radius);
  }
  return least;
}

TEST(Trunk, IsDrawnAlongItsCapsules) {
  const auto type = make_tree_type();
  core::RandomStream random(1, 0, 0, 0, core::Purpose::kParameters);
  int checked = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Parameters p = test::random_parameters(*type, random);
    if (!validate(*type, p)) continue;
    ++checked;
    const TreePlan plan = plan_of_tree(p);
    const Collider collider = type->collider(p);
    ASSERT_FALSE(collider.empty());
    const auto mesh = test::synthesise(*type, p, 0);
    const auto vertices = mesh.vertices<core::ModelVertex>();
    // The trunk is the first tube of the mesh.
    const TubePlan& tube = tube_plan(plan, 0, 0, false);
    const float allowed =
        0.1F * (plan.size_m + plan.radius_m * (1 + plan.flare)) + plan.radius_m * plan.flare;
    for (std::uint32_t i = 0; i < tube.vertices(); ++i) {
      const float gap = outside(collider, unpack_position(vertices[i], type->bounds(p)));
      ASSERT_LT(gap, allowed);
      ASSERT_GT(gap, -allowed - plan.radius_m);
    }
  }
  EXPECT_GT(checked, 100);
}

TEST(Trunk, StartsInTheGroundAndReachesItsEnd) {
  const auto type = make_tree_type();
  const Parameters p = default_parameters(*type);
  const Collider collider = type->collider(p);
  ASSERT_EQ(collider.shapes.size(), 3U);
  const auto& foot = std::get<Collider::Capsule>(collider.shapes.front());
  const auto& end = std::get<Collider::Capsule>(collider.shapes.back());
  EXPECT_LT(foot.from.y, 0);
  EXPECT_GT(end.to.y, 0.7 * p.real(kTreeSizeM));
  EXPECT_GT(foot.radius, end.radius);
  for (std::size_t i = 1; i < 3; ++i)
    EXPECT_EQ(std::get<Collider::Capsule>(collider.shapes[i - 1]).to,
              std::get<Collider::Capsule>(collider.shapes[i]).from);
}

}  // namespace
}  // namespace psygen::models
