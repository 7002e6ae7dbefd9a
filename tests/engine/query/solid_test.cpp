#include "engine/query/solid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/core/hash.hpp"
#include "tests/engine/query/triangles.hpp"

namespace psygen::query {
namespace {

using models::Collider;
using testing::kNan;

Solid solid_of(Collider::Shape shape) {
  Collider collider;
  collider.shapes.push_back(std::move(shape));
  return Solid(std::move(collider));
}

std::vector<glm::vec3> octahedron() {
  return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
}

double distance_to_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const double t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
  return glm::length(p - a - t * (b - a));
}

// Checks rays against the definition of a shape: inside(p) is negative inside, and changes sign at
// the hit and not before.
void expect_as_defined(Solid solid, const std::function<double(const glm::dvec3&)>& inside) {
  core::RandomStream random(7, 0, 0, 0, core::Purpose::kPosition);
  const auto r = [&](double size) { return random.next_real(-size, size); };
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 origin(r(4), r(4), r(4)), target(r(1.5), r(1.5), r(1.5));
    const Line line{origin, glm::normalize(target - origin)};
    const auto hit = solid.cast(line, 10);
    double first = 10;
    for (double t = 0; t < 10 && first == 10; t += 0.002)
      if (inside(origin + t * line.direction) < -1e-4) first = t;
    if (!hit) {
      ASSERT_EQ(first, 10) << i;
      continue;
    }
    ++hits;
    ASSERT_NEAR(glm::length(hit->normal), 1, 1e-4);
    ASSERT_EQ(hit->from_inside, inside(origin) < 0);
    if (hit->from_inside) {
      ASSERT_EQ(hit->t, 0);
      continue;
    }
    ASSERT_NEAR(inside(origin + hit->t * line.direction), 0, 1e-5);
    ASSERT_LE(hit->t, first + 1e-3);
    ASSERT_LE(glm::dot(glm::dvec3(hit->normal), line.direction), 1e-3);
  }
  EXPECT_GT(hits, 200);
}

TEST(Solid, RaysEnterASphereAtItsSurface) {
  const glm::dvec3 centre(0.2, -0.3, 0.5);
  expect_as_defined(solid_of(Collider::Sphere{glm::vec3(centre), 1.1F}),
                    [&](const glm::dvec3& p) { return glm::length(p - centre) - 1.1; });
}

TEST(Solid, RaysEnterACapsuleAtItsSurface) {
  const glm::dvec3 a(-0.5, -1, 0), b(0.5, 1.25, 0.75);
  expect_as_defined(solid_of(Collider::Capsule{glm::vec3(a), glm::vec3(b), 0.5F}),
                    [&](const glm::dvec3& p) { return distance_to_segment(p, a, b) - 0.5; });
}

TEST(Solid, RaysEnterABoxAtItsSurface) {
  expect_as_defined(solid_of(Collider::Box{{-1, -0.5F, -0.25F}, {1, 0.75F, 0.5F}}),
                    [](const glm::dvec3& p) {
                      const glm::dvec3 q =
                          glm::abs(p - glm::dvec3(0, 0.125, 0.125)) - glm::dvec3(1, 0.625, 0.375);
                      return std::max({q.x, q.y, q.z});
                    });
}

TEST(Solid, RaysEnterAHullAtItsSurface) {
  expect_as_defined(solid_of(Collider::Hull{octahedron()}), [](const glm::dvec3& p) {
    return (std::abs(p.x) + std::abs(p.y) + std::abs(p.z) - 1) / std::sqrt(3.0);
  });
}

TEST(Solid, ACapsuleWithoutLengthIsASphere) {
  expect_as_defined(solid_of(Collider::Capsule{{0, 1, 0}, {0, 1, 0}, 1}),
                    [](const glm::dvec3& p) { return glm::length(p - glm::dvec3(0, 1, 0)) - 1; });
}

TEST(Solid, RaysHitTheNearestOfSeveralShapes) {
  Collider collider;
  for (const float x : {6.0F, 2.0F, 4.0F})
    collider.shapes.emplace_back(Collider::Sphere{{x, 0, 0}, 0.5F});
  collider.shapes.emplace_back(Collider::Hull{octahedron()});
  Solid solid(std::move(collider));
  EXPECT_EQ(solid.box().min, glm::vec3(-1));
  EXPECT_EQ(solid.box().max.x, 6.5F);
  const auto ahead = solid.cast({{1.2, 0, 0}, {1, 0, 0}}, 100);
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(ahead->t, 0.3, 1e-6);
  const auto back = solid.cast({{1.2, 0, 0}, {-1, 0, 0}}, 100);
  ASSERT_TRUE(back);
  EXPECT_NEAR(back->t, 0.2, 1e-6);
  EXPECT_FALSE(solid.cast({{1.2, 0, 0}, {1, 0, 0}}, 0.25));
}

TEST(Solid, SkipsInvalidShapes) {
  Collider collider;
  collider.shapes.emplace_back(Collider::Sphere{{0, kNan, 0}, 1});
  collider.shapes.emplace_back(Collider::Sphere{{0, 0, 0}, -1});
  collider.shapes.emplace_back(Collider::Capsule{{0, 0, 0}, {0, 1, 0}, 0});
  collider.shapes.emplace_back(Collider::Box{{1, 1, 1}, {0, 2, 2}});
  collider.shapes.emplace_back(Collider::Hull{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
  collider.shapes.emplace_back(Collider::Hull{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, kNan, 1}}});
  EXPECT_TRUE(Solid(std::move(collider)).collider().empty());
}

TEST(Solid, RaysPassThroughAHullWithoutVolume) {
  std::vector<glm::vec3> flat;
  for (int i = 0; i < 9; ++i)
    flat.emplace_back(i % 3, 0, i / 3);
  Solid solid = solid_of(Collider::Hull{flat});
  EXPECT_FALSE(solid.cast({{1, 5, 1}, {0, -1, 0}}, 100));
}

}  // namespace
}  // namespace psygen::query
