#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/core/mesh_data.hpp"

namespace psygen::core {
namespace {

TEST(MeshShapes, AnEllipsoidIsClosedAndItsTrianglesFaceOutwards) {
  MeshData mesh;
  const glm::vec3 middle(1, 2, 3), half(0.5F, 1, 2);
  add_ellipsoid(mesh, middle, half, {1, 1, 1}, {0, 0, 0});
  ASSERT_TRUE(check(mesh));
  EXPECT_EQ(mesh.indices.size(), 3 * kEllipsoidTriangles);
  double volume = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::vec3 a = mesh.positions[mesh.indices[i]] - middle,
                    b = mesh.positions[mesh.indices[i + 1]] - middle,
                    c = mesh.positions[mesh.indices[i + 2]] - middle;
    volume += static_cast<double>(glm::dot(a, glm::cross(b, c))) / 6;
  }
  const double whole = 4.0 / 3 * 3.14159 * 0.5 * 1 * 2;
  EXPECT_GT(volume, 0.7 * whole);
  EXPECT_LT(volume, whole);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::vec3 way = (mesh.positions[v] - middle) / half;
    EXPECT_NEAR(glm::length(way), 1, 1e-5);
    EXPECT_GT(glm::dot(mesh.normals[v], mesh.positions[v] - middle), 0);
    EXPECT_EQ(mesh.colours[v].x, way.y < -0.2F ? 0 : 1);
  }
}

TEST(MeshShapes, AreAppendedToTheMesh) {
  MeshData mesh;
  add_triangle(mesh, {glm::vec3(0, 0, 0), {0, 0, 1}, {1, 0, 0}}, {1, 0, 0});
  add_ellipsoid(mesh, {}, {1, 1, 1}, {}, {});
  add_triangle(mesh, {glm::vec3(0, 0, 0), {1, 0, 0}, {0, 0, 1}}, {1, 0, 0});
  EXPECT_TRUE(check(mesh));
  EXPECT_EQ(mesh.indices.size(), 3 * (kEllipsoidTriangles + 2));
  EXPECT_EQ(mesh.indices.back() + 1, mesh.positions.size());
  EXPECT_GT(mesh.normals.front().y, 0);
  EXPECT_GT(mesh.normals.back().y, 0) << "from either side";
}

}  // namespace
}  // namespace psygen::core
