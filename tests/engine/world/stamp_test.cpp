// Heightmaps that a world file stamps into its ground.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/engine/world/shaped_worlds.hpp"

namespace psygen::world {
namespace {

using testing::each_vertex;
using testing::height_at;
using testing::kQuantumM;
using testing::kSmallWorld;
using testing::parsed;
using testing::shaped_world;

TEST(Stamp, TheGroundHasTheHeightsOfThePictureAtItsPixels) {
  const World world = shaped_world(
      "[[stamp]]\nimage = \"ramp.png\"\ncentre_m = [128, 96]\nsize_m = 64\nbase_m = 5\n"
      "height_m = 40\nborder_m = 0\nmode = \"set\"\n");
  for (int row = 0; row < 17; ++row) {
    for (int column = 0; column < 17; ++column) {
      const double grey = (row * 17 + column) * 65'535 / 288;
      EXPECT_NEAR(height_at(world, 96 + 4 * column, 64 + 4 * row), 5 + 40 * grey / 65'535,
                  0.51 * kQuantumM)
          << column << ' ' << row;
    }
  }
  // Half-way between two pixels it is their mean.
  EXPECT_NEAR(height_at(world, 98, 64), 5 + 40 * 0.5 / 288, 2 * kQuantumM);
}

TEST(Stamp, IsAddedToTheGroundAndChangesNothingElse) {
  const World base = parsed(kSmallWorld);
  const World world = shaped_world(
      "[[stamp]]\nimage = \"white.png\"\ncentre_m = [100, 100]\nsize_m = 40\nheight_m = -2\n"
      "border_m = 0\n");
  each_vertex([&](double x, double z) {
    const bool inside = std::abs(x - 100) <= 20 && std::abs(z - 100) <= 20;
    const double change = height_at(world, x, z) - height_at(base, x, z);
    if (inside)
      EXPECT_NEAR(change, std::max(-2.0, -height_at(base, x, z)), 1.01 * kQuantumM)
          << x << ' ' << z;
    else
      EXPECT_EQ(change, 0) << x << ' ' << z;
  });
}

TEST(Stamp, ItsBorderIsMonotone) {
  const World base = parsed(kSmallWorld);
  const World world = shaped_world(
      "[[stamp]]\nimage = \"white.png\"\ncentre_m = [200, 128]\nsize_m = 160\nheight_m = 8\n"
      "border_m = 50\n");
  double before = 0;
  for (double x = 120; x <= 200; x += 2) {
    const double change = height_at(world, x, 128) - height_at(base, x, 128);
    EXPECT_GE(change, before - 1.01 * kQuantumM) << x;
    EXPECT_LE(change, 8 + kQuantumM);
    before = change;
  }
  EXPECT_NEAR(before, 8, 1.01 * kQuantumM);
  EXPECT_LT(height_at(world, 122, 128) - height_at(base, 122, 128), 0.1);
}

TEST(Stamp, IsTurnedLikeAModel) {
  const std::string stamp =
      "[[stamp]]\nimage = \"ramp.png\"\ncentre_m = [128, 128]\nsize_m = 64\nheight_m = 30\n"
      "border_m = 0\nmode = \"set\"\n";
  const World world = shaped_world(stamp), turned = shaped_world(stamp + "turn_deg = 90\n");
  const World half = shaped_world(stamp + "turn_deg = 180\n");
  for (int z = -30; z <= 30; z += 6) {
    for (int x = -30; x <= 30; x += 6) {
      const double height_m = height_at(world, 128 + x, 128 + z);
      // About +Y by 90 degrees: x becomes -z, z becomes x.
      EXPECT_NEAR(height_at(turned, 128 + z, 128 - x), height_m, 1.01 * kQuantumM);
      EXPECT_NEAR(height_at(half, 128 - x, 128 - z), height_m, 1.01 * kQuantumM);
    }
  }
  // A square turned by 45 degrees extends further along the axes.
  const World corner = shaped_world(stamp + "turn_deg = 45\n");
  const World base = parsed(kSmallWorld);
  EXPECT_NE(height_at(corner, 128 + 44, 128), height_at(base, 128 + 44, 128));
  EXPECT_EQ(height_at(corner, 128 + 30, 128 + 30), height_at(base, 128 + 30, 128 + 30));
}

constexpr const char* kInMetres =
    "[[stamp]]\nimage = \"metres.exr\"\ncentre_m = [128, 96]\nsize_m = [64, 32]\nunit = \"m\"\n"
    "no_data = -9999\nborder_m = 0\nbase_m = 5\nmode = \"set\"\n";

TEST(Stamp, HeightsInMetresLieOnARectangle) {
  const World base = parsed(kSmallWorld), world = shaped_world(kInMetres);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 5; ++column) {
      const double x = 96 + 16 * column, z = 80 + 16 * row;
      const bool hole = column == 2 && row == 1;
      EXPECT_NEAR(height_at(world, x, z), hole ? height_at(base, x, z) : 15 + column + 5 * row,
                  0.51 * kQuantumM)
          << column << ' ' << row;
    }
  }
  each_vertex([&](double x, double z) {
    if (std::abs(x - 128) <= 32 && std::abs(z - 96) <= 16) return;
    EXPECT_EQ(height_at(world, x, z), height_at(base, x, z)) << x << ' ' << z;
  });
}

TEST(Stamp, FadesOutTowardsAPixelWithoutHeight) {
  const World base = parsed(kSmallWorld), world = shaped_world(kInMetres);
  // Half-way between pixel (1, 1) and the pixel without height.
  EXPECT_NEAR(height_at(world, 120, 96), (height_at(base, 120, 96) + 21) / 2, 1.01 * kQuantumM);
}

TEST(Stamp, OfARectangleFadesAlongAllItsSidesAndTurns) {
  const World base = parsed(kSmallWorld);
  const std::string stamp =
      "[[stamp]]\nimage = \"white.png\"\ncentre_m = [128, 96]\nsize_m = [80, 40]\nheight_m = 8\n"
      "border_m = 10\n";
  const World world = shaped_world(stamp), turned = shaped_world(stamp + "turn_deg = 90\n");
  const auto change = [&](const World& w, double x, double z) {
    return height_at(w, x, z) - height_at(base, x, z);
  };
  for (const auto& [x, z, metres] : {std::array{0.0, 0.0, 8.0},
                                     {30, 0, 8},
                                     {0, 10, 8},
                                     {36, 0, 8 * 0.352},
                                     {0, -16, 8 * 0.352},
                                     {-36, 0, 8 * 0.352},
                                     {40, 0, 0},
                                     {0, 20, 0},
                                     {42, 0, 0},
                                     {0, 22, 0}}) {
    EXPECT_NEAR(change(world, 128 + x, 96 + z), metres, 1.01 * kQuantumM) << x << ' ' << z;
    EXPECT_NEAR(change(turned, 128 + z, 96 - x), metres, 1.01 * kQuantumM) << x << ' ' << z;
  }
}

}  // namespace
}  // namespace psygen::world
