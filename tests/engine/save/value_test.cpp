#include "engine/save/value.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace psygen::save {
namespace {

TEST(Value, NaNIsRejectedAndInfinityIsNot) {
  const auto nan = check_value(std::numeric_limits<double>::quiet_NaN(), "value 'speed'");
  ASSERT_FALSE(nan);
  EXPECT_EQ(nan.error().message, "value 'speed': NaN cannot be stored");
  EXPECT_TRUE(check_value(std::numeric_limits<double>::infinity(), ""));
}

TEST(Value, AbsurdSizesAreRejected) {
  EXPECT_TRUE(check_value(Bytes(kMaxValueBytes), "map"));
  const auto large = check_value(std::string(kMaxValueBytes + 1, 'x'), "map");
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, core::ErrorCode::kOverBudget);
  EXPECT_EQ(large.error().message,
            "map: a value has 268435457 bytes; at most 268435456 are allowed");
}

}  // namespace
}  // namespace psygen::save
