#include "engine/physics/shapes.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace psygen::physics {
namespace {

using models::Collider;

Collider of(Collider::Shape shape) {
  Collider c;
  c.shapes.push_back(std::move(shape));
  return c;
}

core::Bounds box_of(const OwnedShape& shape) {
  btVector3 low, high;
  shape.get()->getAabb(btTransform::getIdentity(), low, high);
  return {glm::vec3(to_glm(low)), glm::vec3(to_glm(high))};
}

TEST(Shapes, HaveTheBoundsOfTheirColliders) {
  const std::vector<glm::vec3> corners{{1, 0, 0}, {-1, 0, 0}, {0, 2, 0}, {0, -1, 0}, {0, 0, 3}};
  for (const Collider::Shape& shape :
       {Collider::Shape(Collider::Sphere{{1, 2, 3}, 0.5F}),
        Collider::Shape(Collider::Capsule{{0, -1, 0}, {2, 1, 1}, 0.25F}),
        Collider::Shape(Collider::Box{{-1, -2, -3}, {2, 1, 1}}),
        Collider::Shape(Collider::Hull{corners})}) {
    const auto made = make_shape(of(shape));
    ASSERT_TRUE(made) << made.error().message;
    const core::Bounds expected = models::bounds_of(shape), got = box_of(*made);
    for (int i = 0; i < 3; ++i) {  // Bullet's boxes have margins
      EXPECT_NEAR(got.min[i], expected.min[i], 0.2) << shape.index();
      EXPECT_NEAR(got.max[i], expected.max[i], 0.2) << shape.index();
    }
  }
}

TEST(Shapes, OfSeveralPartsHaveEveryPart) {
  Collider c = of(Collider::Sphere{{0, 0, 0}, 1});
  c.shapes.emplace_back(Collider::Box{{3, 0, 0}, {4, 1, 1}});
  const auto made = make_shape(c);
  ASSERT_TRUE(made);
  EXPECT_NEAR(box_of(*made).min.x, -1, 0.1);
  EXPECT_NEAR(box_of(*made).max.x, 4, 0.1);
  EXPECT_NEAR(made->inner_m, 1, 1e-6);
}

TEST(Shapes, RejectIllegalColliders) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(make_shape({}));
  for (const Collider::Shape& shape :
       {Collider::Shape(Collider::Sphere{{0, 0, 0}, 0}),
        Collider::Shape(Collider::Sphere{{0, 0, 0}, -1}),
        Collider::Shape(Collider::Sphere{{kNan, 0, 0}, 1}),
        Collider::Shape(Collider::Sphere{{0, 0, 0}, 5000}),
        Collider::Shape(Collider::Capsule{{0, 0, 0}, {0, 1, 0}, 0}),
        Collider::Shape(Collider::Box{{1, 1, 1}, {0, 0, 0}}),
        Collider::Shape(Collider::Hull{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}),
        Collider::Shape(Collider::Hull{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, kNan, 1}}})}) {
    const auto made = make_shape(of(shape));
    ASSERT_FALSE(made) << shape.index();
    EXPECT_EQ(made.error().code, core::ErrorCode::kInvalidArgument);
  }
}

}  // namespace
}  // namespace psygen::physics
