#include "engine/world/far/outline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "engine/models/kit/packing.hpp"
#include "engine/models/registry.hpp"
#include "engine/models/tree/tree.hpp"

namespace psygen::world {
namespace {

constexpr core::Bounds kBox{{-10, -10, -10}, {10, 10, 10}};
constexpr float kPrecision = 0.001F;

std::vector<std::byte> vertices_of(
    std::initializer_list<std::pair<glm::vec3, std::uint8_t>> corners) {
  const models::BoxPacker packer(kBox);
  std::vector<std::byte> bytes(corners.size() * sizeof(core::ModelVertex));
  std::size_t i = 0;
  for (const auto& [place, material] : corners) {
    core::ModelVertex v{};
    packer.pack(place, v.position);
    v.material = material;
    v.ambient = 51;
    v.colour[1] = 102;
    std::memcpy(bytes.data() + i++ * sizeof v, &v, sizeof v);
  }
  return bytes;
}

void expect_near(const glm::vec3& a, const glm::vec3& b) {
  EXPECT_NEAR(a.x, b.x, kPrecision);
  EXPECT_NEAR(a.y, b.y, kPrecision);
  EXPECT_NEAR(a.z, b.z, kPrecision);
}

TEST(Outline, OfACrownIsItsExtremeCornersAndTheTrunkIsApart) {
  const auto outline = outline_of(vertices_of({{{0.3F, -0.2F, 0}, 0},
                                               {{-0.3F, -0.2F, 0}, 0},
                                               {{0, 4, 0}, 0},
                                               {{0.1F, 6, 0}, 1},
                                               {{2, 4, 0.2F}, 1},
                                               {{0, 3.5F, 1.5F}, 1},
                                               {{-1, 4, 0}, 1},
                                               {{0, 4.5F, -2.5F}, 1},
                                               {{0, 2, 0}, 1}}),
                                  kBox);
  ASSERT_TRUE(outline);
  EXPECT_TRUE(outline->leafy);
  expect_near(outline->top.position, {0.1F, 6, 0});
  expect_near(outline->bottom.position, {0, 2, 0});
  expect_near(outline->ring[0].position, {2, 4, 0.2F});
  expect_near(outline->ring[1].position, {0, 3.5F, 1.5F});
  expect_near(outline->ring[2].position, {-1, 4, 0});
  expect_near(outline->ring[3].position, {0, 4.5F, -2.5F});
  EXPECT_NEAR(outline->ring_height(), 4, kPrecision);
  EXPECT_NEAR(outline->trunk_radius, 0.3F, kPrecision);
  EXPECT_NEAR(outline->foot.position.y, -0.2F, kPrecision);
  EXPECT_NEAR(outline->top.ambient, 0.2F, kPrecision);
  EXPECT_NEAR(outline->top.colour.y, 0.4F, kPrecision);
}

TEST(Outline, WithoutLeavesIsThatOfEverything) {
  const auto outline =
      outline_of(vertices_of({{{1, 0, 0}, 0}, {{-1, 2, 1}, 0}, {{0, 1, -1}, 0}}), kBox);
  ASSERT_TRUE(outline);
  EXPECT_FALSE(outline->leafy);
  EXPECT_EQ(outline->trunk_radius, 0);
  expect_near(outline->top.position, {-1, 2, 1});
  expect_near(outline->ring[1].position, {-1, 2, 1});
  expect_near(outline->ring[3].position, {0, 1, -1});
  EXPECT_FALSE(outline_of({}, kBox));
}

TEST(Outline, ScalesAboutTheFoot) {
  const auto outline = outline_of(vertices_of({{{1, 1, 0}, 0}, {{-1, 3, 2}, 0}}), kBox);
  const Outline twice = outline->scaled(2, 3);
  expect_near(twice.top.position, {-2, 9, 4});
  EXPECT_NEAR(twice.ring_radius(), 2 * outline->ring_radius(), kPrecision);
}

// A box of 2 × 3 × 4 m whose lower metre is in the ground. Turned by 45° it is as wide as the mean
// of its diagonals.
TEST(Silhouette, OfABoxIsItsAreaAboveTheGround) {
  std::vector<glm::vec3> places;
  for (int i = 0; i < 8; ++i)
    places.emplace_back((i & 1) == 0 ? -1 : 1, (i & 2) == 0 ? -1 : 2, (i & 4) == 0 ? -2 : 2);
  const std::vector<std::uint16_t> indices{0, 1, 2, 1, 3, 2, 4, 6, 5, 5, 6, 7, 0, 4, 1, 1, 4, 5,
                                           2, 3, 6, 3, 7, 6, 0, 2, 4, 2, 6, 4, 1, 5, 3, 3, 5, 7};
  const Silhouette area = silhouette_of(places, indices);
  const double side = (2 * 2 + 4 * 2 + 2 * (6 * std::sqrt(0.5) * 2)) / 4;
  EXPECT_NEAR(area.side_m2, side, 0.03 * side);
  EXPECT_NEAR(area.plan_m2, 8, 0.03 * 8);
  EXPECT_EQ(silhouette_of({}, {}).side_m2, 0);
}

TEST(Silhouette, CountsOverlappingTrianglesOnce) {
  const std::vector<glm::vec3> places{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 1}};
  const std::vector<std::uint16_t> one{0, 1, 2}, two{0, 1, 2, 0, 1, 2};
  EXPECT_EQ(silhouette_of(places, one).side_m2, silhouette_of(places, two).side_m2);
}

TEST(SampleMesh, OfATreeHasItsCrownAsOutline) {
  const models::Registry registry = models::make_standard_registry();
  const models::ModelType& tree = registry[2];
  SampleMesh mesh;
  mesh.make(tree, models::default_parameters(tree));
  const auto outline = mesh.outline();
  ASSERT_TRUE(outline);
  EXPECT_TRUE(outline->leafy);
  EXPECT_GT(outline->top.position.y, outline->ring_height());
  EXPECT_GT(outline->ring_height(), outline->bottom.position.y);
  EXPECT_GT(outline->trunk_radius, 0.1F);
  const Silhouette area = mesh.silhouette(tree);
  const float height = outline->top.position.y - outline->bottom.position.y;
  EXPECT_NEAR(area.side_m2, 0.9F * outline->ring_radius() * height, 0.3F * area.side_m2);
  EXPECT_NEAR(area.plan_m2, 2 * outline->ring_radius() * outline->ring_radius(),
              0.2F * area.plan_m2);
}

}  // namespace
}  // namespace psygen::world
