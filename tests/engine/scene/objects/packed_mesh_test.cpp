#include "engine/scene/objects/packed_mesh.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/models/kit/packing.hpp"

namespace psygen::scene {
namespace {

core::MeshData roof() {
  core::MeshData mesh;
  mesh.positions = {{-2, 0, 1}, {2, 0, 1}, {0, 3, 0}, {2, 0, -1}, {-2, 0, -1}};
  mesh.indices = {0, 1, 2, 3, 4, 2};
  mesh.uvs = {{0, 1}, {1, 1}, {0.5F, 0}, {3, 1}, {-2, 1}};
  mesh.colours.assign(5, {0.25F, 1, 0});
  return mesh;
}

TEST(PackedMesh, KeepsPositionsWithinAFractionOfItsBounds) {
  const core::MeshData mesh = roof();
  const auto packed = pack(mesh);
  ASSERT_TRUE(packed) << packed.error().message;
  EXPECT_EQ(packed->box, (core::Bounds{{-2, 0, -1}, {2, 3, 1}}));
  const glm::vec3 centre = packed->box.centre(), half = packed->box.half_extent();
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const auto& p = packed->vertices[i].model.position;
    const glm::vec3 at = centre + half * glm::vec3(p[0], p[1], p[2]) * (1.0F / 32767.0F);
    EXPECT_LT(glm::distance(at, mesh.positions[i]), 1e-3F);
    EXPECT_EQ(packed->vertices[i].uv[0], mesh.uvs[i].x);
    EXPECT_EQ(packed->vertices[i].model.colour[0], 128);
    EXPECT_EQ(packed->vertices[i].model.colour[1], 255);
  }
  EXPECT_EQ(packed->indices, (std::vector<std::uint16_t>{0, 1, 2, 3, 4, 2}));
}

TEST(PackedMesh, TakesMissingNormalsFromItsTriangles) {
  const auto packed = pack(roof());
  ASSERT_TRUE(packed);
  const auto normal = [&](std::size_t i) {
    const auto& n = packed->vertices[i].model.normal;
    return models::decode_octahedral(glm::vec2(n[0], n[1]) / 32767.0F);
  };
  const glm::vec3 front = glm::normalize(glm::vec3(0, 1, 3));
  EXPECT_LT(glm::distance(normal(0), front), 1e-3F);
  EXPECT_LT(glm::distance(normal(2), glm::vec3(0, 1, 0)), 1e-3F) << "the mean of both sides";
}

TEST(PackedMesh, SurvivesAMeshWithoutExtent) {
  core::MeshData mesh;
  mesh.positions.assign(3, {1, 2, 3});
  mesh.indices = {0, 1, 2};
  const auto packed = pack(mesh);
  ASSERT_TRUE(packed);
  EXPECT_EQ(packed->box.half_extent(), glm::vec3(0));
}

TEST(PackedMesh, RejectsMeshesThatCannotBeDrawn) {
  core::MeshData mesh = roof();
  mesh.indices[0] = 9;
  EXPECT_FALSE(pack(mesh));
  mesh = roof();
  mesh.positions.resize(70'000);
  mesh.uvs.clear();
  mesh.colours.clear();
  const auto packed = pack(mesh);
  ASSERT_FALSE(packed);
  EXPECT_EQ(packed.error().code, core::ErrorCode::kOverBudget);
}

}  // namespace
}  // namespace psygen::scene
