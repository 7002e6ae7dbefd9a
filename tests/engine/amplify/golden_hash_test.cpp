// Worlds are the same on every machine and in every build: recorded hashes of a few blocks at all
// levels of detail. A change to the bits of geometry changes them and is noted in CHANGELOG.md.
#include <gtest/gtest.h>

#include <cfenv>
#include <cstdint>
#include <ostream>
#include <string>

#include "engine/amplify/block_synthesiser.hpp"
#include "engine/models/kit/simd_targets.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/world.hpp"
#include "tests/source_file.hpp"

namespace psygen::amplify {
namespace {

struct Golden {
  const char* world;
  core::BlockCoord block;
  std::uint64_t hash;
};

void PrintTo(const Golden& golden, std::ostream* out) {
  *out << golden.world << " " << golden.block.x << " " << golden.block.z;
}

class GoldenHash : public testing::TestWithParam<Golden> {
 protected:
  void TearDown() override { models::unpin_simd_target(); }
};

TEST_P(GoldenHash, IsTheSameInEveryBuildAndOnEveryInstructionSet) {
  models::Registry registry = models::make_standard_registry();
  const auto file = source_file("game/worlds/") + GetParam().world;
  const auto world = world::load_world(file, registry);
  ASSERT_TRUE(world) << world.error().message;
  for (const std::string_view target : models::simd_targets()) {
    models::pin_simd_target(target);
    Totals totals;
    BlockSynthesiser(*world, registry, kAllLevels).synthesise(GetParam().block, totals);
    EXPECT_EQ(totals.hash.value(), GetParam().hash)
        << target << " 0x" << std::hex << totals.hash.value();
    EXPECT_EQ(totals.failed, 0u);
  }
}

TEST_P(GoldenHash, IsTheSameInEveryRoundingModeOfTheProgram) {
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    ASSERT_EQ(std::fesetround(mode), 0);
    models::Registry registry = models::make_standard_registry();
    const auto world = world::load_world(source_file("game/worlds/") + GetParam().world, registry);
    Totals totals;
    if (world) BlockSynthesiser(*world, registry, kAllLevels).synthesise(GetParam().block, totals);
    EXPECT_EQ(std::fegetround(), mode) << "the program's mode is back";
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(totals.hash.value(), GetParam().hash) << mode;
  }
}

// Mountains with every part of the erosion.
constexpr const char* kErodedWorld = R"(format = 1
[world]
name = "eroded"
seed = 9
blocks = [0, 0]
block_vertices = 64
cell_m = 1
[terrain]
feature_m = 900
relief_m = 400
[erosion]
strength = 0.7
strata = 0.5
max_height_m = 350
)";

class ErodedGoldenHash : public testing::Test {
 protected:
  void TearDown() override { models::unpin_simd_target(); }
};

TEST_F(ErodedGoldenHash, IsTheSameOnEveryInstructionSetAndInEveryRoundingMode) {
  for (const std::string_view target : models::simd_targets()) {
    for (const int mode : {FE_TONEAREST, FE_UPWARD}) {
      models::pin_simd_target(target);
      std::fesetround(mode);
      models::Registry registry = models::make_standard_registry();
      const auto world = world::parse_world(kErodedWorld, "eroded.toml", registry);
      Totals totals;
      for (const core::BlockCoord block :
           {core::BlockCoord{0, 0}, core::BlockCoord{INT32_MAX, INT32_MIN}})
        if (world) BlockSynthesiser(*world, registry, kAllLevels).synthesise(block, totals);
      std::fesetround(FE_TONEAREST);
      ASSERT_TRUE(world) << world.error().message;
      EXPECT_EQ(totals.hash.value(), 0x5a23a0e9df63869au)
          << target << " 0x" << std::hex << totals.hash.value();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Worlds, GoldenHash,
    testing::Values(Golden{"paper.toml", {0, 0}, 0x32a11d2945f79676},
                    Golden{"paper.toml", {511, 300}, 0x8a96fb08e69b1686},
                    Golden{"five_species.toml", {3, 5}, 0x0240c56c53b7f634},
                    Golden{"silver_combe.toml", {40, 41}, 0xc74f476c63bb90a7},
                    Golden{"silver_combe.toml", {-45, 29}, 0x1a93d5a071099008},
                    Golden{"lakes.toml", {-30, -28}, 0x79d1f289ae8987f8},
                    Golden{"ember_pass.toml", {-9, 4}, 0x4e2c9933d3c045c8},
                    Golden{"thorn_country.toml", {2, -3}, 0x0488d9319952478d},
                    Golden{"frost_isle.toml", {-11, 0}, 0x07d6694ef7386724},
                    Golden{"endless.toml", {-7, 9}, 0x4c98949d3adb142e},
                    Golden{"endless.toml", {INT32_MAX, INT32_MIN}, 0xd9d578c3b3ad6ba1},
                    Golden{"watershed.toml", {-143, 143}, 0xf32dddf4b94842b6},
                    Golden{"watershed.toml", {2, -1}, 0xc6efd5ddc356548c}));

}  // namespace
}  // namespace psygen::amplify
