// Grass against the double-precision oracle: positions, normals, colours, light, sway and material
// of every vertex of every level.
#include <gtest/gtest.h>

#include "engine/models/kit/packing.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/models/oracle/grass.hpp"

namespace psygen::models {
namespace {

void expect_as_oracle(const ModelType& type, const Parameters& p, int level) {
  const auto expected = test::GrassOracle(p).mesh(level);
  const auto vertices = test::synthesise(type, p, level).vertices<core::ModelVertex>();
  ASSERT_EQ(vertices.size(), expected.size());
  const core::Bounds box = type.bounds(p);
  // Half a step of the packing, and single precision over the size of the patch.
  const glm::dvec3 tolerance = glm::dvec3(box.half_extent()) * (0.5 / 32767 + 1e-5);
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const glm::dvec3 found(unpack_position(vertices[k], box));
    ASSERT_TRUE(glm::all(glm::lessThan(glm::abs(found - expected[k].place), tolerance)))
        << "level " << level << " vertex " << k;
    ASSERT_EQ(test::fault_of(vertices[k], expected[k].look), "")
        << "level " << level << " vertex " << k;
  }
}

TEST(GrassOracle, EqualsEveryVertexOfEveryLevel) {
  const auto type = make_grass_type();
  core::RandomStream random(12, 0, 0, 0, core::Purpose::kParameters);
  for (int trial = 0; trial < 100; ++trial) {
    SCOPED_TRACE(trial);
    Parameters p = test::random_parameters(*type, random);
    p.set_integer(kGrassFlower, trial % kFlowerCount);
    if (trial % 4 == 0) {  // all colours in full sun, blades with the largest sway
      p.set_real(kGrassAlbedo, 0.9);
      p.set_real(kGrassDryness, trial % 8 == 0 ? 0 : 1);
      p.set_real(kGrassHeightM, 2);
    }
    for (int level = 0; level < type->level_count(); ++level)
      ASSERT_NO_FATAL_FAILURE(expect_as_oracle(*type, p, level));
  }
}

}  // namespace
}  // namespace psygen::models
