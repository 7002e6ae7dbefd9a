#include "engine/core/mesh_data.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace psygen::core {
namespace {

MeshData triangle() {
  MeshData mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.indices = {0, 1, 2};
  return mesh;
}

std::string complaint(const MeshData& mesh) {
  const auto checked = check(mesh);
  return checked ? "" : checked.error().message;
}

TEST(MeshData, IsRejectedWithAMessageThatNamesTheList) {
  EXPECT_EQ(complaint(triangle()), "");
  EXPECT_EQ(complaint({}), "a mesh has no triangles");
  MeshData mesh = triangle();
  mesh.indices[1] = 3;
  EXPECT_EQ(complaint(mesh), "indices[1] of a mesh is 3, but it has 3 vertices");
  mesh = triangle();
  mesh.indices.pop_back();
  EXPECT_EQ(complaint(mesh), "a mesh has 2 indices; three make a triangle");
  mesh = triangle();
  mesh.normals.resize(2);
  EXPECT_EQ(complaint(mesh), "a mesh has 3 positions but 2 normals");
  mesh = triangle();
  mesh.positions[2].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(complaint(mesh).find("positions[2] of a mesh is nan"), std::string::npos);
  mesh = triangle();
  mesh.positions[0].x = 2 * kMaxMeshReachM;
  EXPECT_NE(complaint(mesh), "");
  mesh = triangle();
  mesh.uvs = {{0, 0}, {0, std::numeric_limits<float>::infinity()}, {1, 1}};
  EXPECT_NE(complaint(mesh).find("uvs[1]"), std::string::npos);
}

TEST(MeshData, SplitsIntoPartsWithTheSameTriangles) {
  MeshData strip;
  for (std::uint32_t i = 0; i < 100; ++i) {
    strip.positions.push_back({static_cast<float>(i), 0, 0});
    strip.uvs.push_back({static_cast<float>(i), 1});
    if (i >= 2) strip.indices.insert(strip.indices.end(), {i - 2, i - 1, i});
  }
  const std::vector<MeshData> parts = split(strip, 10);
  EXPECT_GE(parts.size(), 10u);
  std::size_t at = 0;
  for (const MeshData& part : parts) {
    EXPECT_LE(part.positions.size(), 10u);
    ASSERT_EQ(part.uvs.size(), part.positions.size());
    ASSERT_TRUE(check(part));
    for (const std::uint32_t index : part.indices)
      EXPECT_EQ(part.positions[index], strip.positions[strip.indices[at++]]);
  }
  EXPECT_EQ(at, strip.indices.size());
  EXPECT_EQ(split(strip).size(), 1u);
}

}  // namespace
}  // namespace psygen::core
