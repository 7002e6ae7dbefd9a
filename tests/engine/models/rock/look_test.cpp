// Looks of rocks: normals, colours, light, sway and material of packed vertices, compared with the
// double-precision oracle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/models/kit/simd_targets.hpp"
#include "engine/models/rock/rock.hpp"
#include "engine/models/rock/topology.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/models/oracle/rock.hpp"

namespace psygen::models {
namespace {

class RockLook : public ::testing::Test {
 protected:
  ~RockLook() override { unpin_simd_target(); }

  std::unique_ptr<ModelType> type = make_rock_type();
  core::RandomStream random{8, 0, 0, 0, core::Purpose::kParameters};

  void expect_as_oracle(const Parameters& p, int level) const {
    const test::RockOracle oracle = test::rock_oracle(p, level);
    const std::vector<test::Look> expected = oracle.looks();
    // Normals come from differences of positions, which halve with every subdivision.
    const test::LookTolerance tolerance{.normal =
                                            std::ldexp(1e-5, std::max(oracle.subdivisions - 4, 0))};
    for (const std::string_view target : simd_targets()) {
      SCOPED_TRACE(target);
      pin_simd_target(target);
      const test::Mesh mesh = test::synthesise(*type, p, level);
      const auto vertices = mesh.vertices<core::ModelVertex>();
      ASSERT_EQ(mesh.indices.size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i)
        ASSERT_EQ(test::fault_of(vertices[mesh.indices[i]], expected[i], tolerance), "")
            << "level " << level << " corner " << i;
    }
  }
};

TEST_F(RockLook, EqualsTheOracleOnEveryInstructionSetForEveryFamily) {
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    Parameters p = test::random_parameters(*type, random);
    p.set_integer(kRockFamily, trial % kRockFamilyCount);
    p.set_integer(kRockSubdivisions, trial / kRockFamilyCount % 5);
    for (int level = 0; level < type->level_count_of(p); ++level)
      ASSERT_NO_FATAL_FAILURE(expect_as_oracle(p, level));
  }
}

// Colours that reach their largest byte, no moss or full moss, and all subdivisions.
TEST_F(RockLook, EqualsTheOracleAtTheEndsOfItsRanges) {
  for (int trial = 0; trial < 24; ++trial) {
    SCOPED_TRACE(trial);
    Parameters p = test::random_parameters(*type, random);
    p.set_integer(kRockFamily, trial % kRockFamilyCount);
    p.set_integer(kRockSubdivisions, kMaxSubdivisions);
    p.set_real(kRockAlbedo, trial % 2 == 0 ? 0.9 : 0.02);
    p.set_real(kRockWarmth, trial % 4 < 2 ? 1 : -1);
    p.set_real(kRockMoss, trial % 8 < 4 ? 0 : 1);
    for (const int level : {0, 3, kMaxSubdivisions})
      ASSERT_NO_FATAL_FAILURE(expect_as_oracle(p, level));
  }
}

}  // namespace
}  // namespace psygen::models
