#include <gtest/gtest.h>

#include <glm/ext/matrix_transform.hpp>
#include <set>

#include "engine/core/camera.hpp"
#include "engine/scene/draws/models.hpp"
#include "engine/scene/meshes/mesh_annotations.hpp"
#include "engine/world/far/merged_models.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

// `count` triangles in a row along x, one metre each, in a box of `count` metres.
struct Row {
  std::vector<core::ModelVertex> vertices;
  std::vector<std::uint16_t> indices;
  core::Bounds box;

  explicit Row(int count) : box{{0, 0, 0}, {static_cast<float>(count), 1, 1}} {
    for (int i = 0; i < count; ++i) {
      for (const float x : {0.0F, 1.0F, 0.5F}) {
        core::ModelVertex v{};
        const float place = (static_cast<float>(i) + x) / static_cast<float>(count);
        v.position[0] = static_cast<std::int16_t>((2 * place - 1) * 32767);
        v.position[1] = x == 0.5F ? 32767 : -32767;
        v.position[2] = 0;
        indices.push_back(static_cast<std::uint16_t>(vertices.size()));
        vertices.push_back(v);
      }
    }
  }
  MeshParts parts() const { return mesh_parts(vertices, indices, box); }
};

constexpr float kSideM = 160;  // of the node that a row stands on

View looking_north() {
  View view;
  view.frustum = visibility::make_frustum(core::projection_matrix(core::Projection{}) *
                                          core::view_rotation(core::CameraPose{}));
  return view;
}

std::vector<render::MeshDraw> draws_of(const MeshParts& parts, const View& view, glm::vec3 at,
                                       const GroundSunlight& sun = {}) {
  render::MeshDraw draw;
  draw.origin = at;
  std::vector<render::MeshDraw> draws;
  add_parts(parts, &view, sun, kSideM, draw, draws);
  return draws;
}

TEST(MeshParts, ContainBillboardsAtAnyRotation) {
  Row row(4);
  for (core::ModelVertex& v : row.vertices) {
    v.material = core::kBillboardBit;
    v.normal[0] = -1280;
    v.normal[1] = 128;
  }
  const MeshParts flat = Row(4).parts(), turning = row.parts();
  const float reach = 1408 * core::kBillboardReachM / 32767;
  for (std::uint32_t i = 0; i < flat.count; ++i) {
    EXPECT_NEAR(turning.boxes[i].min.x, flat.boxes[i].min.x - reach, 1e-3F);
    EXPECT_NEAR(turning.boxes[i].max.z, flat.boxes[i].max.z + reach, 1e-3F);
    EXPECT_EQ(turning.boxes[i].min.y, flat.boxes[i].min.y);
    EXPECT_EQ(turning.boxes[i].max.y, flat.boxes[i].max.y);
  }
}

TEST(MeshParts, EveryTriangleIsInOnePartAndTheBoxesAreTight) {
  for (const int count : {1, 15, 16, 17, 100, 1000}) {
    const MeshParts parts = Row(count).parts();
    ASSERT_LE(parts.count, MeshParts::kMax);
    EXPECT_EQ(parts.index_count, static_cast<std::uint32_t>(3 * count));
    EXPECT_GE(parts.count * parts.indices_each, parts.index_count);
    EXPECT_LT((parts.count - 1) * parts.indices_each, parts.index_count);
    for (std::uint32_t i = 0; i < parts.count; ++i) {
      const float first = static_cast<float>(i * parts.indices_each / 3);
      const float end =
          std::min(first + static_cast<float>(parts.indices_each / 3), static_cast<float>(count));
      EXPECT_NEAR(parts.boxes[i].min.x, first, 0.01F * static_cast<float>(count));
      EXPECT_NEAR(parts.boxes[i].max.x, end, 0.01F * static_cast<float>(count));
      EXPECT_NEAR(parts.boxes[i].max.y, 1, 1e-3F);
      EXPECT_NEAR(parts.boxes[i].min.z, 0.5F, 1e-3F);
    }
  }
}

TEST(MeshParts, DegenerateTrianglesAtTheEndAreLeftOut) {
  Row row(20);
  row.indices.insert(row.indices.end(), 30, 0);
  EXPECT_EQ(row.parts().index_count, 60u);
  row.indices.assign(30, 0);
  EXPECT_EQ(row.parts().count, 0u);
  EXPECT_EQ(mesh_parts({}, {}, {}).count, 0u);
}

TEST(MeshParts, OnlyVisiblePartsAreDrawnAndNeighboursShareADraw) {
  const MeshParts parts = Row(160).parts();
  const View view = looking_north();
  const auto all = draws_of(parts, view, {-80, 0, -200});
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].part.first, 0u);
  EXPECT_EQ(all[0].part.count, 480u);
  EXPECT_TRUE(draws_of(parts, view, {-80, 0, 200}).empty());
  // 50 m ahead the picture is 86 m wide: of the parts of 10 m five reach into it.
  const auto some = draws_of(parts, view, {0, 0, -50});
  ASSERT_EQ(some.size(), 1u);
  EXPECT_EQ(some[0].part.first, 0u);
  EXPECT_EQ(some[0].part.count, 30u * 5);
}

TEST(MeshParts, PartsInTheShadeHaveSeparateDraws) {
  const MeshParts parts = Row(160).parts();  // ten metres each
  GroundSunlight sun;
  for (std::size_t i = 0; i < sun.share.size(); ++i)
    sun.share[i] = i % GroundSunlight::kSide < 8 ? 0 : 255;
  const auto draws = draws_of(parts, looking_north(), {-80, 0, -200}, sun);
  ASSERT_GE(draws.size(), 2u);
  EXPECT_EQ(draws.front().sun, 0.0F);
  EXPECT_EQ(draws.back().sun, 1.0F);
  std::uint32_t next = 0, dark = 0;
  for (const render::MeshDraw& draw : draws) {
    EXPECT_EQ(draw.part.first, next);
    next += draw.part.count;
    dark += draw.sun < 0.5F ? draw.part.count : 0;
  }
  EXPECT_EQ(next, 480u);
  EXPECT_NEAR(dark, 240, 60);
}

TEST(MeshParts, PartsBehindARidgeAreDrawnOnlyIfTheyReachOverIt) {
  const MeshParts parts = Row(160).parts();
  View view = looking_north();
  const std::vector<glm::vec3> ridge{{-400, -6, -150}, {0, -6, -150}};  // on the left only
  view.horizon.add(ridge);
  const auto half = draws_of(parts, view, {-80, -15, -200});
  ASSERT_EQ(half.size(), 1u);
  EXPECT_GT(half[0].part.first, 0u);
  EXPECT_EQ(half[0].part.first + half[0].part.count, 480u);
  EXPECT_EQ(draws_of(parts, view, {-80, -8, -200})[0].part.count, 480u);
}

// The order of the mesh makes its 16 parts compact: each covers a small part of the node, or one of
// four blocks if there are no more.
TEST(MeshParts, OfAMergedMeshAreCompact) {
  models::Registry registry = models::make_standard_registry();
  const auto world = std::make_shared<const world::World>(paper_world(registry));
  const auto type = world::make_merged_type(world, registry);
  for (int level = 1; level <= world::kMaxMergedLevel; ++level) {
    const models::Parameters p = world::merged_parameters({5, 7}, level);
    const models::test::Mesh mesh = models::test::synthesise(*type, p, 0);
    const core::Bounds box = type->bounds(p);
    const auto vertices = mesh.vertices<core::ModelVertex>();
    const MeshParts parts = mesh_parts(vertices, mesh.indices, box);
    ASSERT_EQ(parts.count, MeshParts::kMax);
    double area = 0;
    for (const core::Bounds& part : std::span(parts.boxes).first(parts.count)) {
      area += double{part.max.x - part.min.x} * (part.max.z - part.min.z);
      EXPECT_GE(part.min.y, box.min.y - 0.01F);
      EXPECT_LE(part.max.y, box.max.y + 0.01F);
    }
    const double side_m = std::ldexp(world->block_size_m(), level);
    EXPECT_LT(area, (level == 1 ? 4.5 : 2.5) * side_m * side_m) << level;
  }
}

}  // namespace
}  // namespace psygen::scene
