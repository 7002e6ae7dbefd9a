#include "engine/sqlite/database.hpp"

#include <gtest/gtest.h>

namespace psygen::sqlite {
namespace {

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
}  // namespace psygen::sqlite
