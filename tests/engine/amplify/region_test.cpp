#include "engine/amplify/region.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/engine/world/shipped.hpp"

namespace psygen::amplify {
namespace {

using world::testing::kSmallWorld;
using world::testing::parsed;

TEST(Region, IsReadFromFourIntegers) {
  EXPECT_EQ(*parse_region("0,0,1,1"), (Region{0, 0, 1, 1}));
  EXPECT_EQ(*parse_region("-2147483648,-2,2147483648,7"),
            (Region{INT32_MIN, -2, std::int64_t{INT32_MAX} + 1, 7}));
}

TEST(Region, RejectsInvalidRegionsWithOneSentence) {
  for (const char* text : {"", "1", "1,2,3", "1,2,3,", "1,2,3,4,5", "a,b,c,d", "1 ,2,3,4",
                           "1,2,3,4 ", "1.5,2,3,4", "0,0,0,1", "0,0,1,0", "3,0,2,1",
                           "0,0,2147483649,1", "-2147483649,0,1,1", "0,0,99999999999999999999,1"}) {
    const auto region = parse_region(text);
    ASSERT_FALSE(region) << text;
    EXPECT_NE(region.error().message.find("X0,Z0,X1,Z1"), std::string::npos);
  }
}

TEST(Region, NumbersEachOfItsBlocksOnce) {
  const Region region{-2, 5, 1, 7};
  ASSERT_EQ(region.block_count(), 6u);
  std::set<core::BlockCoord> blocks;
  for (std::uint64_t i = 0; i < region.block_count(); ++i) {
    blocks.insert(region.block(i));
    EXPECT_EQ(region.number_of(region.block(i)), i);
  }
  for (const core::BlockCoord outside : {core::BlockCoord{-3, 5}, {1, 5}, {0, 4}, {0, 7}})
    EXPECT_EQ(region.number_of(outside), std::nullopt);
  EXPECT_EQ(blocks.size(), 6u);
  EXPECT_EQ(*blocks.begin(), (core::BlockCoord{-2, 5}));
  EXPECT_EQ(*blocks.rbegin(), (core::BlockCoord{0, 6}));
  const Region all = *parse_region("-2147483648,-2147483648,2147483648,2147483648");
  EXPECT_EQ(all.block_count(), UINT64_MAX);
  EXPECT_EQ(all.block(0), (core::BlockCoord{INT32_MIN, INT32_MIN}));
}

TEST(Region, MustLieInsideTheWorld) {
  const world::World world = parsed(kSmallWorld);  // 8 × 4 blocks
  EXPECT_EQ(*whole(world), (Region{0, 0, 8, 4}));
  EXPECT_TRUE(check_region(world, {7, 3, 8, 4}));
  for (const Region& region : {Region{7, 3, 9, 4}, Region{-1, 0, 1, 1}, Region{0, 3, 1, 5}}) {
    const auto ok = check_region(world, region);
    ASSERT_FALSE(ok);
    EXPECT_NE(ok.error().message.find("x 0 to 7, z 0 to 3"), std::string::npos)
        << ok.error().message;
  }
}

TEST(Region, OfAnEndlessWorldMustBeGiven) {
  world::World world = parsed(kSmallWorld);
  world.blocks_x = 0;
  const auto endless = whole(world);
  ASSERT_FALSE(endless);
  EXPECT_NE(endless.error().message.find("is endless: choose a region"), std::string::npos);
  EXPECT_TRUE(check_region(world, {INT32_MIN, 0, -5, 4}));
  EXPECT_FALSE(check_region(world, {0, 0, 1, 5}));
}

}  // namespace
}  // namespace psygen::amplify
