// SQL of games on their own tables.
#include "engine/save/game_tables.hpp"

#include <gtest/gtest.h>

#include "tests/engine/save/support.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::save {
namespace {

std::string refusal(SaveGame& save, std::string_view sql, const std::vector<Value>& values = {}) {
  const auto done = save.execute(sql, values);
  if (done) return "it was executed";
  EXPECT_EQ(done.error().code, core::ErrorCode::kInvalidArgument);
  return done.error().message;
}

TEST(GameTables, KeepRowsBetweenRuns) {
  const TemporaryFolder folder;
  {
    SaveGame save = testing::opened(folder / "game.save");
    ASSERT_TRUE(
        save.execute("CREATE TABLE game_chest(id INTEGER PRIMARY KEY AUTOINCREMENT, "
                     "item TEXT UNIQUE, weight_kg REAL)"));
    ASSERT_TRUE(save.execute("CREATE INDEX game_by_weight ON game_chest(weight_kg)"));
    ASSERT_TRUE(save.execute("INSERT INTO game_chest(item, weight_kg) VALUES(?, ?)",
                             {std::string("axe"), 1.5}));
    EXPECT_TRUE(save.has_unsaved());
    EXPECT_EQ(save.query("SELECT count(*) FROM game_chest")->rows[0][0], Value(std::int64_t{1}));
    ASSERT_TRUE(save.save());
  }
  SaveGame save = testing::opened(folder / "game.save");
  const auto rows = save.query("SELECT item, weight_kg FROM game_chest WHERE weight_kg > ?", {1.0});
  ASSERT_TRUE(rows) << rows.error().message;
  EXPECT_EQ(rows->columns, (std::vector<std::string>{"item", "weight_kg"}));
  ASSERT_EQ(rows->rows.size(), 1U);
  EXPECT_EQ(rows->rows[0], (std::vector<Value>{std::string("axe"), 1.5}));
  ASSERT_TRUE(save.execute("ALTER TABLE game_chest ADD COLUMN owner TEXT"));
  ASSERT_TRUE(save.execute("DROP TABLE game_chest"));
  ASSERT_TRUE(save.save());
}

TEST(GameTables, UnsavedChangesAreLost) {
  const TemporaryFolder folder;
  {
    SaveGame save = testing::opened(folder / "game.save");
    ASSERT_TRUE(save.execute("CREATE TABLE game_a(x)"));
    ASSERT_TRUE(save.save());
    ASSERT_TRUE(save.execute("INSERT INTO game_a VALUES(1)"));
  }
  SaveGame save = testing::opened(folder / "game.save");
  EXPECT_TRUE(save.query("SELECT x FROM game_a")->rows.empty());
  ASSERT_TRUE(save.execute("INSERT INTO game_a VALUES(2)"));
  save.discard();
  EXPECT_TRUE(save.query("SELECT x FROM game_a")->rows.empty());
  EXPECT_FALSE(save.has_unsaved());
}

TEST(GameTables, ReachNoOtherTables) {
  const TemporaryFolder folder;
  SaveGame save = testing::opened(folder / "game.save");
  ASSERT_TRUE(save.execute("CREATE TABLE game_a(x)"));
  for (const char* sql : {"DELETE FROM psygen_edits",
                          "CREATE TABLE chest(x)",
                          "DROP TABLE psygen_facts",
                          "UPDATE psygen_facts SET value = 1",
                          "INSERT INTO game_a SELECT value FROM psygen_facts",
                          "PRAGMA user_version=7",
                          "COMMIT",
                          "BEGIN",
                          "SAVEPOINT s",
                          "VACUUM",
                          "ANALYZE",
                          "ATTACH 'other' AS other",
                          "CREATE TRIGGER game_t AFTER INSERT ON game_a BEGIN SELECT 1; END",
                          "CREATE VIEW game_v AS SELECT 1",
                          "CREATE TEMP TABLE game_t(x)",
                          "CREATE VIRTUAL TABLE game_f USING fts5(x)",
                          "CREATE INDEX other ON game_a(x)",
                          "CREATE INDEX game_i ON psygen_edits(x)",
                          "DELETE FROM sqlite_schema",
                          "ALTER TABLE game_a RENAME TO psygen_b",
                          "SELECT load_extension('x')"}) {
    const std::string message = refusal(save, sql);
    EXPECT_EQ(message.find(std::string("SQL \"") + sql), 0U) << message;
  }
  EXPECT_FALSE(save.query("SELECT * FROM psygen_edits"));
  ASSERT_TRUE(save.execute("ALTER TABLE game_a RENAME TO game_b"));
  ASSERT_TRUE(save.save());
  EXPECT_TRUE(save.query("SELECT x FROM game_b"));
}

TEST(GameTables, MistakesAreErrorsWithAMessage) {
  const TemporaryFolder folder;
  SaveGame save = testing::opened(folder / "game.save");
  ASSERT_TRUE(save.execute("CREATE TABLE game_a(x UNIQUE)"));
  EXPECT_EQ(refusal(save, "INSERT INTO game_b VALUES(1)"),
            "SQL \"INSERT INTO game_b VALUES(1)\": no such table: game_b");
  EXPECT_EQ(refusal(save, "INSERT INTO game_a VALUES(?)"),
            "SQL \"INSERT INTO game_a VALUES(?)\": has 1 parameters but was given 0 values");
  EXPECT_EQ(refusal(save, "DELETE FROM game_a; DELETE FROM game_a"),
            "SQL \"DELETE FROM game_a; DELETE FROM game_a\": has more than one statement");
  EXPECT_EQ(refusal(save, ""), "SQL \"\": is empty");
  EXPECT_EQ(refusal(save, std::string(std::size_t{2} << 20, ' ')).find("SQL \"    "), 0U);
  const auto changing = save.query("DELETE FROM game_a");
  ASSERT_FALSE(changing);
  EXPECT_EQ(changing.error().message,
            "SQL \"DELETE FROM game_a\": changes the save; pass it to execute()");
}

TEST(GameTables, AStatementThatFailsHalfwayChangesNothing) {
  const TemporaryFolder folder;
  SaveGame save = testing::opened(folder / "game.save");
  ASSERT_TRUE(save.execute("CREATE TABLE game_a(x UNIQUE)"));
  ASSERT_TRUE(save.execute("INSERT INTO game_a VALUES(3)"));
  EXPECT_NE(
      refusal(save, "INSERT INTO game_a VALUES(1), (2), (3)").find("UNIQUE constraint failed"),
      std::string::npos);
  EXPECT_EQ(save.query("SELECT x FROM game_a")->rows.size(), 1U);
  ASSERT_TRUE(save.save());
  EXPECT_EQ(save.query("SELECT x FROM game_a")->rows.size(), 1U);
}

TEST(GameTables, AreIdentifiedByTheirNames) {
  EXPECT_TRUE(is_game_table("game_chest"));
  EXPECT_TRUE(is_game_table("GAME_Chest"));
  EXPECT_FALSE(is_game_table("game"));
  EXPECT_FALSE(is_game_table("psygen_edits"));
}

}  // namespace
}  // namespace psygen::save
