#include "engine/models/model_type.hpp"

#include <gtest/gtest.h>

#include <set>

namespace psygen::models {
namespace {

// Parameters whose first 16 values are 1, 2, 3 …
Parameters sixteen_values() {
  Parameters p;
  for (std::size_t i = 0; i < Parameters::kFirstOptional; ++i)
    p.set_integer(i, static_cast<std::int64_t>(i) + 1);
  return p;
}

// Saves, edits and golden hashes depend on this value.
TEST(Parameters, KeepTheHashOfTheirFirstSixteenValues) {
  std::uint64_t expected = 0;
  for (std::uint64_t value = 1; value <= 16; ++value)
    expected = core::combine(expected, value);
  EXPECT_EQ(sixteen_values().hash(), expected);
}

TEST(Parameters, CountLaterValuesOnlyIfTheyAreNotZero) {
  std::set<std::uint64_t> hashes{sixteen_values().hash()};
  for (std::size_t i = Parameters::kFirstOptional; i < Parameters::kMaxCount; ++i) {
    Parameters p = sixteen_values();
    p.set_real(i, 0.0);
    EXPECT_TRUE(hashes.contains(p.hash()));
    p.set_real(i, 0.5);
    EXPECT_TRUE(hashes.insert(p.hash()).second) << "value " << i << " at another place";
    EXPECT_FALSE(p == sixteen_values());
  }
}

}  // namespace
}  // namespace psygen::models
