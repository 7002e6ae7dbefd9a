#include "engine/save/database.hpp"

#include <gtest/gtest.h>

#include "tests/engine/save/support.hpp"

namespace psygen::save {
namespace {

TEST(Database, ValuesKeepTheirTypes) {
  auto database = Database::in_memory();
  ASSERT_TRUE(database);
  auto echo = database->prepare("SELECT ?", "test");
  ASSERT_TRUE(echo);
  const std::string with_nul("a\0b", 3);
  for (const Value& value :
       {Value(), Value(std::int64_t{INT64_MIN}), Value(-0.5), Value(std::string()), Value(with_nul),
        Value(Bytes()), Value(testing::bytes_of("bytes"))}) {
    echo->bind(1, value);
    ASSERT_EQ(echo->step(), SQLITE_ROW);
    EXPECT_EQ(echo->value(0), value);
    echo->reset();
  }
}

TEST(Database, AFullFileIsAnErrorWithAMessage) {
  auto database = Database::in_memory();
  ASSERT_TRUE(database);
  ASSERT_TRUE(database->run("CREATE TABLE t(b); PRAGMA max_page_count=3", "test"));
  const auto full = database->run("INSERT INTO t VALUES(zeroblob(100000))", "cannot be saved");
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().code, core::ErrorCode::kIo);
  EXPECT_EQ(full.error().message, "memory: cannot be saved: the disk is full");
}

TEST(Database, WrongSqlIsAnErrorWithAMessage) {
  auto database = Database::in_memory();
  ASSERT_TRUE(database);
  const auto wrong = database->prepare("SELEC 1", "cannot be read");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().message, "memory: cannot be read: near \"SELEC\": syntax error");
}

}  // namespace
}  // namespace psygen::save
