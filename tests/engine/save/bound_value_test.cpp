#include "engine/save/bound_value.hpp"

#include <gtest/gtest.h>

#include "tests/engine/save/support.hpp"

namespace psygen::save {
namespace {

TEST(BoundValue, ValuesKeepTheirTypes) {
  auto database = Database::in_memory();
  ASSERT_TRUE(database);
  auto echo = database->prepare("SELECT ?", "test");
  ASSERT_TRUE(echo);
  const std::string with_nul("a\0b", 3);
  for (const Value& value :
       {Value(), Value(std::int64_t{INT64_MIN}), Value(-0.5), Value(std::string()), Value(with_nul),
        Value(Bytes()), Value(testing::bytes_of("bytes"))}) {
    bind_value(*echo, 1, value);
    ASSERT_EQ(echo->step(), SQLITE_ROW);
    EXPECT_EQ(value_of(*echo, 0), value);
    echo->reset();
  }
}

}  // namespace
}  // namespace psygen::save
