#include "engine/models/grass/grass.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/models/kit/packing.hpp"
#include "tests/engine/models/mesh_helpers.hpp"

namespace psygen::models {
namespace {

using core::ModelVertex;
using test::Mesh;
using test::random_parameters;
using test::synthesise;
using ::testing::HasSubstr;

class Grass : public ::testing::Test {
 protected:
  std::unique_ptr<ModelType> type = make_grass_type();

  // Positions of a level's vertices in metres.
  std::vector<glm::vec3> places(const Parameters& p, const Mesh& mesh) const {
    std::vector<glm::vec3> result;
    for (const ModelVertex& v : mesh.vertices<ModelVertex>())
      result.push_back(unpack_position(v, type->bounds(p)));
    return result;
  }
  Parameters patch(std::int64_t seed, std::int64_t blades, std::int64_t flowers = 0) const {
    Parameters p = default_parameters(*type);
    p.set_integer(kGrassSeed, seed);
    p.set_integer(kGrassBlades, blades);
    p.set_integer(kGrassFlowers, flowers);
    return p;
  }
};

TEST_F(Grass, HasExactSizesForAnyParameters) {
  core::RandomStream random(7, 0, 0, 0, core::Purpose::kParameters);
  for (int trial = 0; trial < 20'000; ++trial) {
    const Parameters p = random_parameters(*type, random);
    const auto blades = static_cast<std::uint32_t>(p.integer(kGrassBlades));
    const auto flowers = static_cast<std::uint32_t>(p.integer(kGrassFlowers));
    EXPECT_EQ(type->mesh_size(p, 0).triangle_count(), 3 * blades + 7 * flowers);
    EXPECT_EQ(type->mesh_size(p, 0).vertex_count, 5 * blades + 10 * flowers);
    EXPECT_EQ(type->mesh_size(p, 1).triangle_count(), blades + flowers);
    EXPECT_EQ(type->mesh_size(p, 2).triangle_count(), (blades + 2) / 3 + (flowers + 2) / 3);
    EXPECT_EQ(type->mesh_size(p, 3).triangle_count(), (blades + 8) / 9 + (flowers + 8) / 9);
    if (trial % 200 != 0) continue;
    for (int level = 0; level < type->level_count(); ++level)
      synthesise(*type, p, level);  // between canaries, of exactly this size
  }
}

TEST_F(Grass, StaysWithinItsBoundsAtTheCornersOfItsRanges) {
  const auto specs = type->parameters();
  for (std::uint32_t corner = 0; corner < 1U << kGrassParameterCount; corner += 7) {
    Parameters p = default_parameters(*type);
    for (std::size_t i = kGrassSlopeX; i < kGrassParameterCount; ++i) {
      const double value = (corner >> i & 1) != 0 ? specs[i].hard_max : specs[i].hard_min;
      if (specs[i].type == ParameterType::kReal)
        p.set_real(i, value);
      else
        p.set_integer(i, static_cast<std::int64_t>(std::min(value, 60.0)));
    }
    p.set_integer(kGrassSeed, corner);
    const core::Bounds box = type->bounds(p);
    for (int level = 0; level < type->level_count(); ++level) {
      const core::Bounds tight = synthesise(*type, p, level).box;
      ASSERT_TRUE(glm::all(glm::lessThanEqual(box.min, tight.min)) &&
                  glm::all(glm::lessThanEqual(tight.max, box.max)))
          << "corner " << corner << " level " << level;
    }
  }
}

TEST_F(Grass, GrowsUpOutOfSlopingGround) {
  Parameters p = patch(3, 200);
  p.set_real(kGrassSlopeX, 0.5);
  p.set_real(kGrassSlopeZ, -0.3);
  const auto above_ground = [](const glm::vec3& at) { return at.y - 0.5F * at.x + 0.3F * at.z; };
  const Mesh mesh = synthesise(*type, p, 0);
  const std::vector<glm::vec3> at = places(p, mesh);
  const std::vector<ModelVertex> vertices = mesh.vertices<ModelVertex>();
  for (std::size_t i = 0; i < at.size(); i += 5) {
    EXPECT_LT(above_ground(at[i]), -0.02F);
    EXPECT_LT(above_ground(at[i + 1]), -0.02F);
    EXPECT_GT(at[i + 2].y, at[i].y);
    EXPECT_GT(at[i + 4].y, at[i + 2].y);
    // Only vertices above the ground sway, most of all the tip; the base is in the shade.
    EXPECT_EQ(vertices[i].sway, 0);
    EXPECT_LT(vertices[i + 2].sway, vertices[i + 4].sway);
    EXPECT_LT(vertices[i].ambient, vertices[i + 4].ambient);
    // It has the light of the ground.
    const glm::vec3 normal =
        decode_octahedral(glm::vec2(vertices[i].normal[0], vertices[i].normal[1]) / 32767.0F);
    EXPECT_GT(glm::dot(normal, glm::normalize(glm::vec3(-0.5F, 1, 0.3F))), 0.999F);
  }
}

// Area of a mesh's triangles, as a mean over all directions of view.
float area(const std::vector<glm::vec3>& at, const Mesh& mesh) {
  float sum = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    sum += glm::length(glm::cross(at[mesh.indices[i + 1]] - at[mesh.indices[i]],
                                  at[mesh.indices[i + 2]] - at[mesh.indices[i]])) /
           2;
  return sum;
}

TEST_F(Grass, CoversAboutAsMuchAtEveryLevel) {
  for (int seed = 0; seed < 8; ++seed) {
    const Parameters p = patch(seed, 270);
    const Mesh full = synthesise(*type, p, 0);
    for (int level = 1; level < type->level_count(); ++level) {
      const Mesh mesh = synthesise(*type, p, level);
      EXPECT_NEAR(area(places(p, mesh), mesh) / area(places(p, full), full), 1, 0.25)
          << "level " << level;
    }
  }
}

// From points of the blades to the nearest of a dense set of points of the coarser level.
TEST_F(Grass, DeviatesByTheErrorOfItsLevel) {
  core::RandomStream random(4, 0, 0, 0, core::Purpose::kParameters);
  for (int trial = 0; trial < 12; ++trial) {
    Parameters p = random_parameters(*type, random);
    p.set_integer(kGrassFlowers, 0);
    const std::vector<glm::vec3> full = places(p, synthesise(*type, p, 0));
    for (int level = 1; level < type->level_count(); ++level) {
      const Mesh mesh = synthesise(*type, p, level);
      const std::vector<glm::vec3> at = places(p, mesh);
      std::vector<glm::vec3> points;
      for (std::size_t i = 0; i < at.size(); i += 3) {
        for (int k = 0; k <= 16; ++k) {
          for (const float side : {0.0F, 0.5F, 1.0F})
            points.push_back(glm::mix(glm::mix(at[i], at[i + 1], side), at[i + 2],
                                      static_cast<float>(k) / 16.0F));
        }
      }
      double sum = 0, most = 0;
      for (const glm::vec3& v : full) {
        float nearest = 1e9F;
        for (const glm::vec3& point : points)
          nearest = std::min(nearest, glm::dot(point - v, point - v));
        sum += std::sqrt(nearest);
        most = std::max(most, static_cast<double>(std::sqrt(nearest)));
      }
      const double error = type->level_error_m(p, level);
      EXPECT_LT(sum / static_cast<double>(full.size()), error) << "level " << level;
      EXPECT_LT(most, (level == 1 ? 1.0 : 2.0) * error) << "level " << level;
      EXPECT_GT(most, 0.1 * error) << "level " << level;
    }
  }
}

TEST_F(Grass, WithFewBladesHasFewLevels) {
  EXPECT_EQ(type->level_count_of(patch(1, 1)), 2);
  EXPECT_EQ(type->level_count_of(patch(1, 3, 2)), 3);
  EXPECT_EQ(type->level_count_of(patch(1, 4)), 4);
  EXPECT_EQ(type->level_count_of(patch(1, 1, 9)), 4);
  const Parameters one = patch(5, 1, 1);
  EXPECT_EQ(synthesise(*type, one, 1).vertex_bytes, synthesise(*type, one, 3).vertex_bytes);
  EXPECT_EQ(type->level_error_m(one, 1), type->level_error_m(one, 3));
}

TEST_F(Grass, HasTheSameBytesEveryTimeAndOthersForEverySeed) {
  const Parameters p = patch(-42, 150, 12);
  for (int level = 0; level < type->level_count(); ++level) {
    const Mesh a = synthesise(*type, p, level), b = synthesise(*type, p, level);
    EXPECT_EQ(a.vertex_bytes, b.vertex_bytes);
    EXPECT_EQ(a.indices, b.indices);
    EXPECT_NE(a.vertex_bytes, synthesise(*type, patch(-43, 150, 12), level).vertex_bytes);
  }
}

TEST_F(Grass, HostileParametersAreRejected) {
  const auto refusal = [&](const Parameters& p) {
    const auto result = validate(*type, p);
    return result ? std::string() : result.error().message;
  };
  EXPECT_THAT(refusal(patch(1, std::numeric_limits<std::int64_t>::max())), HasSubstr("blades"));
  EXPECT_THAT(refusal(patch(1, -1)), HasSubstr("from 1 to 4096"));
  EXPECT_THAT(refusal(patch(1, 1, -5)), HasSubstr("flowers"));
  Parameters p = patch(1, 10);
  p.set_real(kGrassHeightM, std::nan(""));
  EXPECT_THAT(refusal(p), HasSubstr("height_m"));
  EXPECT_EQ(refusal(patch(1, 4096, 1024)), "");
  EXPECT_LE(type->mesh_size(patch(1, 4096, 1024), 0).vertex_count, 65536U);
}

TEST_F(Grass, IsInvisibleFromFar) {
  EXPECT_FALSE(type->is_seen_from_far());
}

}  // namespace
}  // namespace psygen::models
