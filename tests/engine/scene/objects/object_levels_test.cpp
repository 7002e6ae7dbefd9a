#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "engine/scene/objects/packed_mesh.hpp"

namespace psygen::scene {
namespace {

// A sphere of 2 m with a seam, as code makes them.
core::MeshData sphere(std::uint32_t rings) {
  core::MeshData mesh;
  for (std::uint32_t r = 0; r <= rings; ++r) {
    for (std::uint32_t s = 0; s <= 2 * rings; ++s) {
      const double v = std::numbers::pi * r / rings, u = std::numbers::pi * s / rings;
      const glm::vec3 at(std::sin(v) * std::cos(u), std::cos(v), std::sin(v) * std::sin(u));
      mesh.positions.push_back(at);
      mesh.normals.push_back(at);
      if (r == rings || s == 2 * rings) continue;
      const std::uint32_t a = r * (2 * rings + 1) + s, below = a + 2 * rings + 1;
      for (const std::uint32_t i : {a, a + 1, below, below, a + 1, below + 1})
        mesh.indices.push_back(i);
    }
  }
  return mesh;
}

std::vector<ObjectLevel> levels_of(const core::MeshData& mesh, std::size_t most) {
  auto packed = pack(mesh);
  EXPECT_TRUE(packed.has_value());
  return object_levels(std::move(*packed), most);
}

TEST(ObjectLevels, HaveFewerTrianglesAndLargerErrors) {
  const core::MeshData mesh = sphere(24);
  const std::vector<ObjectLevel> levels = levels_of(mesh, 8);
  ASSERT_GE(levels.size(), 3U);
  EXPECT_EQ(levels[0].mesh.indices.size(), mesh.indices.size());
  EXPECT_EQ(levels[0].error_m, 0);
  for (std::size_t i = 1; i < levels.size(); ++i) {
    EXPECT_LE(2 * levels[i].mesh.indices.size(), levels[i - 1].mesh.indices.size());
    EXPECT_GE(levels[i].error_m, levels[i - 1].error_m);
    EXPECT_GT(levels[i].error_m, 0);
    EXPECT_LT(levels[i].error_m, 2);  // of the sphere's size
    EXPECT_EQ(levels[i].mesh.box.max, levels[0].mesh.box.max);
    EXPECT_EQ(levels[i].mesh.vertices.capacity(), levels[i].mesh.vertices.size());
    EXPECT_EQ(levels[i].mesh.indices.capacity(), levels[i].mesh.indices.size());
  }
}

TEST(ObjectLevels, UseOnlyVerticesOfTheFinest) {
  const std::vector<ObjectLevel> levels = levels_of(sphere(16), 8);
  const auto& all = levels[0].mesh.vertices;
  for (const ObjectLevel& level : levels) {
    std::vector<bool> used(level.mesh.vertices.size());
    for (const std::uint16_t i : level.mesh.indices) {
      ASSERT_LT(i, used.size());
      used[i] = true;
    }
    for (std::size_t v = 0; v < used.size() && &level != &levels[0]; ++v) {
      EXPECT_TRUE(used[v]);
      const auto same = [&](const core::ObjectVertex& other) {
        return std::memcmp(&other, &level.mesh.vertices[v], sizeof(other)) == 0;
      };
      EXPECT_TRUE(std::any_of(all.begin(), all.end(), same));
    }
  }
}

// A lid of 2 m, all of whose triangles meet in one vertex.
core::MeshData lid(std::uint32_t triangles) {
  core::MeshData mesh;
  mesh.positions.assign(1, {0, 0, 0});
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const double turn = 2 * std::numbers::pi * i / triangles;
    mesh.positions.emplace_back(std::cos(turn), 0, std::sin(turn));
    for (const std::uint32_t corner : {0U, i + 1, (i + 1) % triangles + 1})
      mesh.indices.push_back(corner);
  }
  return mesh;
}

TEST(ObjectLevels, MeshesWithTooManyTrianglesAtAVertexHaveOneLevel) {
  EXPECT_GT(levels_of(lid(2'000), 8).size(), 1U);
  EXPECT_EQ(levels_of(lid(60'000), 8).size(), 1U);
}

TEST(ObjectLevels, AreAtMostAsManyAsWantedAndOneForSmallMeshes) {
  EXPECT_EQ(levels_of(sphere(24), 1).size(), 1U);
  EXPECT_EQ(levels_of(sphere(24), 2).size(), 2U);
  EXPECT_EQ(levels_of(sphere(3), 8).size(), 1U);
}

// Loose triangles share no edge that could give way: what is left reaches as far.
TEST(ObjectLevels, OfLooseTrianglesReachAsFar) {
  core::MeshData mesh;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const auto x = static_cast<float>(i);
    for (const glm::vec3& corner :
         {glm::vec3(x, 0, 0), glm::vec3(x + 0.5F, 0, 0), glm::vec3(x, 1, 0)}) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(corner);
    }
  }
  const std::vector<ObjectLevel> levels = levels_of(mesh, 8);
  const auto reach = [](const ObjectLevel& level) {
    int least = 32767, most = -32767;
    for (const core::ObjectVertex& vertex : level.mesh.vertices) {
      least = std::min(least, int{vertex.model.position[0]});
      most = std::max(most, int{vertex.model.position[0]});
    }
    return most - least;
  };
  for (const ObjectLevel& level : levels)
    EXPECT_GT(reach(level), 0.8 * reach(levels[0]));
}

}  // namespace
}  // namespace psygen::scene
