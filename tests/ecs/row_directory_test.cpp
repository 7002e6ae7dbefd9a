#include "ecs/row_directory.hpp"

#include <gtest/gtest.h>

namespace psygen::ecs::detail {
namespace {

TEST(RowDirectory, ALocationNamesOneRowOfOneTable) {
  RowDirectory directory;
  const std::uint32_t a = directory.add_chunk(1, 0);
  const std::uint32_t b = directory.add_chunk(2, 0);
  const std::uint32_t c = directory.add_chunk(1, 4096);
  EXPECT_EQ(directory.place_of(a + 4095).table, 1U);
  EXPECT_EQ(directory.place_of(a + 4095).row, 4095U);
  EXPECT_EQ(directory.place_of(b + 17).table, 2U);
  EXPECT_EQ(directory.place_of(b + 17).row, 17U);
  EXPECT_EQ(directory.place_of(c + 5).table, 1U);
  EXPECT_EQ(directory.place_of(c + 5).row, 4101U);
}

TEST(RowDirectory, NowhereBelongsToNoTable) {
  RowDirectory directory;
  directory.add_chunk(1, 0);
  EXPECT_EQ(directory.place_of(kNowhere).table, 0U);
}

}  // namespace
}  // namespace psygen::ecs::detail
