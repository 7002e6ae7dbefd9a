#include "engine/models/rock/rock.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "engine/models/kit/packing.hpp"
#include "engine/models/rock/topology.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/models/oracle/rock.hpp"

namespace psygen::models {
namespace {

using core::ModelVertex;
using test::Mesh;
using test::synthesise;

class Rock : public ::testing::Test {
 protected:
  std::unique_ptr<ModelType> type = make_rock_type();

  // A rock with a random seed, and amplitude and decay below these bounds (`random` draws all
  // three).
  Parameters random_rock(core::RandomStream& random, int subdivisions, double amplitude) const {
    const auto seed = static_cast<std::int64_t>(random.next_u64());
    const double drawn = random.next_real(0, amplitude);
    return rock(seed, subdivisions, drawn, random.next_real(0, 1));
  }
  Parameters rock(std::int64_t seed, int subdivisions, double amplitude, double decay) const {
    Parameters p = default_parameters(*type);
    p.set_integer(kRockSeed, seed);
    p.set_integer(kRockSubdivisions, subdivisions);
    p.set_real(kRockAmplitude, amplitude);
    p.set_real(kRockDecay, decay);
    return p;
  }
};

// A number for each position of a packed vertex.
std::uint64_t place(const ModelVertex& v) {
  return (static_cast<std::uint64_t>(static_cast<std::uint16_t>(v.position[0])) << 32) |
         (static_cast<std::uint64_t>(static_cast<std::uint16_t>(v.position[1])) << 16) |
         static_cast<std::uint16_t>(v.position[2]);
}

TEST_F(Rock, HasFourTimesFourToTheNTriangles) {
  for (int n = 0; n <= kMaxSubdivisions; ++n) {
    const MeshSize size = type->mesh_size(rock(1, n, 0.2, 0.5), 0);
    EXPECT_EQ(size.triangle_count(), 4u << (2 * n));
    for (int level = 0; level < type->level_count(); ++level)
      EXPECT_EQ(type->mesh_size(rock(1, n, 0.2, 0.5), level).triangle_count(),
                4u << (2 * std::max(n - level, 0)));
  }
  EXPECT_DOUBLE_EQ(type->complexity(rock(1, 2, 0.2, 0.5), 0), 2 * 4);
  EXPECT_DOUBLE_EQ(type->complexity(rock(1, 5, 0.2, 0.5), 0), 5 * 256);
  EXPECT_GT(type->complexity(rock(1, 0, 0.2, 0.5), 0), 0);
}

TEST_F(Rock, TopologyIsClosedAtEveryStep) {
  const RockTopology topology;
  for (int n = 0; n <= kMaxSubdivisions; ++n) {
    const auto list = topology.indices(n);
    const std::vector<std::uint16_t> indices(list.begin(), list.end());
    EXPECT_EQ(indices.size(), rock_triangles(n) * 3);
    EXPECT_TRUE(test::is_watertight(indices, [](std::uint16_t v) { return v; }));
    EXPECT_EQ(std::set<std::uint16_t>(indices.begin(), indices.end()).size(), rock_vertices(n));
  }
}

TEST_F(Rock, PositionsEqualTheOracle) {
  core::RandomStream random(6, 0, 0, 0, core::Purpose::kParameters);
  for (int trial = 0; trial < 45; ++trial) {
    const int n = trial % 5;
    Parameters p = random_rock(random, n, 0.6);
    p.set_real(kRockRadiusM, random.next_real(0.05, 20));
    p.set_integer(kRockFamily, trial % kRockFamilyCount);
    const test::RockOracle oracle = test::rock_oracle(p);
    const core::Bounds box = type->bounds(p);
    const Mesh mesh = synthesise(*type, p, 0);
    const auto vertices = mesh.vertices<ModelVertex>();
    ASSERT_EQ(mesh.indices.size(), oracle.triangles.size() * 3);
    const glm::vec3 tolerance =
        box.half_extent() / 60000.0F + static_cast<float>(1e-5 * oracle.radius);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
      const glm::vec3 expected =
          oracle.places[static_cast<std::size_t>(oracle.triangles[i / 3][i % 3])];
      const glm::vec3 error = glm::abs(unpack_position(vertices[mesh.indices[i]], box) - expected);
      ASSERT_TRUE(error.x < tolerance.x && error.y < tolerance.y && error.z < tolerance.z);
    }
  }
}

TEST_F(Rock, SharedVerticesHaveTheMeanNormalOfTheirTriangles) {
  core::RandomStream random(8, 0, 0, 0, core::Purpose::kParameters);
  for (int trial = 0; trial < 42; ++trial) {
    Parameters p = random_rock(random, trial % 7, 0.4);
    p.set_real(kRockDecay, random.next_real(0.3, 0.8));
    p.set_integer(kRockFamily, trial % 2 == 0 ? kRockRounded : kRockLayered);
    const test::RockOracle oracle = test::rock_oracle(p);
    const auto expected = oracle.normals();
    const auto vertices = synthesise(*type, p, 0).vertices<ModelVertex>();
    ASSERT_EQ(vertices.size(), expected.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const glm::vec3 normal =
          decode_octahedral({vertices[v].normal[0] / 32767.0F, vertices[v].normal[1] / 32767.0F});
      ASSERT_GT(glm::dot(glm::dvec3(normal), glm::normalize(expected[v])), 0.99999);
    }
  }
}

TEST_F(Rock, IsWatertightAndFacesAwayFromItsCentreForLegalParameters) {
  core::RandomStream random(9, 0, 0, 0, core::Purpose::kParameters);
  for (int trial = 0; trial < 120; ++trial) {
    const bool extreme = trial % 3 == 0;
    Parameters p = random_rock(random, trial % 4, 0.6);
    if (extreme) {
      p.set_real(kRockAmplitude, 0.6);
      p.set_real(kRockDecay, 1);
    }
    p.set_integer(kRockFamily, trial / 4 % kRockFamilyCount);
    const Mesh mesh = synthesise(*type, p, 0);
    const auto v = mesh.vertices<ModelVertex>();
    EXPECT_TRUE(test::is_watertight(mesh.indices, [&](std::uint16_t i) { return place(v[i]); }));
    test::RockOracle oracle{.seed = static_cast<std::uint64_t>(p.integer(kRockSeed))};
    const double flat = p.integer(kRockFamily) == kRockLayered ? 0.75 : 1;
    const glm::vec3 centre{
        0, 0.45 * flat * (0.75 + 0.15 * oracle.random(1, 1)) * p.real(kRockRadiusM), 0};
    const core::Bounds box = type->bounds(p);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const glm::vec3 a = unpack_position(v[mesh.indices[i]], box);
      const glm::vec3 b = unpack_position(v[mesh.indices[i + 1]], box);
      const glm::vec3 c = unpack_position(v[mesh.indices[i + 2]], box);
      const glm::vec3 face = glm::cross(b - a, c - a);
      ASSERT_GT(glm::dot(face, (a + b + c) / 3.0F - centre), 0);
      const ModelVertex& corner = v[mesh.indices[i]];
      const glm::vec3 normal =
          decode_octahedral({corner.normal[0] / 32767.0F, corner.normal[1] / 32767.0F});
      // Shared normals of ledges and of the roughest rocks may face away from their triangle.
      const bool may_look_past = p.integer(kRockFamily) == kRockLayered ||
                                 (extreme && p.integer(kRockFamily) == kRockRounded);
      ASSERT_TRUE(glm::dot(normal, face) > 0 || may_look_past);
    }
  }
}

TEST_F(Rock, LevelsKeepThePositionsOfTheirCorners) {
  for (int family = 0; family < kRockFamilyCount; ++family) {
    Parameters p = rock(77, 3, 0.3, 0.6);
    p.set_integer(kRockFamily, family);
    std::set<std::uint64_t> finer;
    for (int level = 0; level < 4; ++level) {
      std::set<std::uint64_t> places;
      for (const ModelVertex& v : synthesise(*type, p, level).vertices<ModelVertex>())
        places.insert(place(v));
      EXPECT_EQ(places.size(), rock_vertices(3 - level));
      if (level > 0) {
        EXPECT_TRUE(std::includes(finer.begin(), finer.end(), places.begin(), places.end()));
      }
      finer = places;
    }
  }
}

TEST_F(Rock, FamiliesDifferInShadingShapeAndColour) {
  std::array<double, kRockFamilyCount> bend{}, height{}, contrast{};
  for (int family = 0; family < kRockFamilyCount; ++family) {
    for (int seed = 0; seed < 40; ++seed) {
      Parameters p = rock(seed, 3, 0.24, 0.55);
      p.set_integer(kRockFamily, family);
      p.set_real(kRockMoss, 0);
      const Mesh mesh = synthesise(*type, p, 0);
      const auto v = mesh.vertices<ModelVertex>();
      const core::Bounds box = type->bounds(p);
      const auto index = static_cast<std::size_t>(family);
      double sum = 0, squares = 0;
      const double count = mesh.size.triangle_count();
      for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const ModelVertex& corner = v[mesh.indices[i]];
        const glm::vec3 a = unpack_position(corner, box);
        const glm::vec3 face =
            glm::normalize(glm::cross(unpack_position(v[mesh.indices[i + 1]], box) - a,
                                      unpack_position(v[mesh.indices[i + 2]], box) - a));
        const glm::vec3 normal =
            decode_octahedral({corner.normal[0] / 32767.0F, corner.normal[1] / 32767.0F});
        bend[index] += static_cast<double>(1 - glm::dot(face, normal)) / count;
        sum += corner.colour[1];
        squares += corner.colour[1] * corner.colour[1];
      }
      contrast[index] += std::sqrt(squares / count - std::pow(sum / count, 2)) / (sum / count);
      height[index] += static_cast<double>(mesh.box.max.y - mesh.box.min.y);
    }
  }
  EXPECT_GT(bend[kRockRounded], 1.5 * bend[kRockFaceted]) << "smooth shading leaves the planes";
  EXPECT_LT(height[kRockLayered], 0.85 * height[kRockFaceted]) << "slabs are flat";
  EXPECT_GT(contrast[kRockLayered], 1.15 * contrast[kRockFaceted]) << "layers show";
}

TEST_F(Rock, StepsOfFacetedRocksCountTheirOwnVertices) {
  Parameters p = rock(1, 4, 0.3, 0.5);
  p.set_integer(kRockFamily, 0);
  const double rounded = type->steps(p, 0);
  p.set_integer(kRockFamily, 1);
  EXPECT_GT(type->steps(p, 0), 2.5 * rounded);  // 4.7 µs and 1.5 µs
  EXPECT_LT(type->steps(p, 0), 3.5 * rounded);
  EXPECT_LT(type->steps(p, 4), 1.5 * type->steps(rock(1, 0, 0.3, 0.5), 0));
}

TEST_F(Rock, SharesOneIndexListPerSubdivisionAndShading) {
  const MeshSize a = type->mesh_size(rock(1, 3, 0.2, 0.5), 1);
  const MeshSize b = type->mesh_size(rock(2, 2, 0.3, 0.6), 0);
  EXPECT_EQ(a.shared_indices, b.shared_indices);
  EXPECT_NE(a.shared_indices, 0u);
  EXPECT_NE(a.shared_indices, type->mesh_size(rock(1, 3, 0.2, 0.5), 0).shared_indices);
  Parameters faceted = rock(1, 2, 0.2, 0.5);
  faceted.set_integer(kRockFamily, kRockFaceted);
  EXPECT_NE(b.shared_indices, type->mesh_size(faceted, 0).shared_indices);
}

TEST_F(Rock, StartsInTheGroundAndIsDarkerBelow) {
  for (int seed = 0; seed < 20; ++seed) {
    const Parameters p = rock(seed, 2, 0.24, 0.55);
    const Mesh mesh = synthesise(*type, p, 0);
    EXPECT_LT(mesh.box.min.y, 0);
    EXPECT_GT(mesh.box.max.y, -mesh.box.min.y);
    int lowest = 255, highest = 0;
    for (const ModelVertex& v : mesh.vertices<ModelVertex>()) {
      const float y = unpack_position(v, type->bounds(p)).y;
      if (y < 0) lowest = std::min<int>(lowest, v.ambient);
      if (y > mesh.box.max.y * 0.7F) highest = std::max<int>(highest, v.ambient);
      EXPECT_EQ(v.sway, 0);
    }
    EXPECT_LT(lowest, highest / 2);
  }
}

TEST_F(Rock, ColliderHoldsItsMeshUpToASmallError) {
  for (int seed = 0; seed < 30; ++seed) {
    for (const int subdivisions : {0, 1, 2, 3, 4}) {
      Parameters p = rock(seed, subdivisions, 0.24, 0.55);
      p.set_integer(kRockFamily, seed % kRockFamilyCount);
      const Collider collider = type->collider(p);
      ASSERT_EQ(collider.shapes.size(), 1U);
      const auto& hull = std::get<Collider::Hull>(collider.shapes[0]);
      if (subdivisions <= 2) {
        EXPECT_EQ(hull.points.size(), rock_vertices(subdivisions));
      } else {
        EXPECT_LE(hull.points.size(), 56U);
      }
      const double error_m = subdivisions <= 2 ? 1e-3 : 0.15 * p.real(kRockRadiusM);
      // No corner of the whole mesh is outside the hull by more than that, along the line from its
      // base point.
      const Mesh mesh = synthesise(*type, p, 0);
      for (const ModelVertex& v : mesh.vertices<ModelVertex>()) {
        const glm::vec3 at = unpack_position(v, type->bounds(p));
        double support = -1e9;
        const glm::vec3 out = glm::normalize(at);
        for (const glm::vec3& c : hull.points)
          support = std::max(support, static_cast<double>(glm::dot(out, c)));
        ASSERT_LE(static_cast<double>(glm::dot(out, at)), support + error_m)
            << seed << " " << subdivisions;
      }
    }
  }
}

}  // namespace
}  // namespace psygen::models
