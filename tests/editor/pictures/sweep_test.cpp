#include "editor/pictures/sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "editor/document/parsed_world.hpp"
#include "engine/world/files/world_file.hpp"
#include "tests/editor/pictures/worlds.hpp"

namespace psygen::editor {
namespace {

using ::testing::ElementsAre;
using world::FieldKind;
using world::WorldField;

WorldField number_field(FieldKind kind, double low, double high, bool logarithmic = false) {
  WorldField field;
  field.kind = kind;
  field.hard_min = field.soft_min = low;
  field.hard_max = field.soft_max = high;
  field.logarithmic = logarithmic;
  return field;
}

TEST(Sweep, RealsAreSpreadOverTheSoftRange) {
  EXPECT_THAT(sweep_values(number_field(FieldKind::kReal, 0, 1), 5),
              ElementsAre("0", "0.25", "0.5", "0.75", "1"));
}

TEST(Sweep, LogarithmicFieldsAreSpreadByDecades) {
  EXPECT_THAT(sweep_values(number_field(FieldKind::kReal, 1, 1000, true), 4),
              ElementsAre("1", "10", "100", "1000"));
}

TEST(Sweep, IntegersComeOnceEach) {
  EXPECT_THAT(sweep_values(number_field(FieldKind::kInteger, 1, 3), 16),
              ElementsAre("1", "2", "3"));
}

TEST(Sweep, BothEndsOfARangeMoveWithinTheHardRange) {
  WorldField field = number_field(FieldKind::kRealRange, 0, 10);
  field.numbers = {4, 6};
  EXPECT_THAT(sweep_values(field, 3), ElementsAre("[0, 1]", "[4, 6]", "[9, 10]"));
}

TEST(Sweep, SeedsBeginWithThePresentOneAndEveryPageHasOthers) {
  WorldField field;
  field.kind = FieldKind::kSeed;
  field.value = "71";
  const auto first = sweep_values(field, 16), second = sweep_values(field, 16, 1);
  ASSERT_EQ(first.size(), 16U);
  EXPECT_EQ(first[0], "71");
  EXPECT_EQ(std::set(first.begin(), first.end()).size(), 16U);
  EXPECT_NE(first, second);
  EXPECT_EQ(first, sweep_values(field, 16));
}

TEST(Sweep, ChoicesAndBooleansShowAllValues) {
  WorldField choice;
  choice.kind = FieldKind::kChoice;
  choice.choices = {"all", "none"};
  EXPECT_THAT(sweep_values(choice, 9), ElementsAre("\"all\"", "\"none\""));
  WorldField boolean;
  boolean.kind = FieldKind::kBoolean;
  EXPECT_THAT(sweep_values(boolean, 9), ElementsAre("false", "true"));
}

TEST(Sweep, TextsColoursAndImagesAreNotSwept) {
  for (const FieldKind kind : {FieldKind::kText, FieldKind::kColour, FieldKind::kImage}) {
    WorldField field = number_field(kind, 0, 1);
    EXPECT_FALSE(can_sweep(field));
    EXPECT_TRUE(sweep_values(field, 4).empty());
  }
}

TEST(Sweep, EverySweptFieldOfEveryShippedWorldGivesValidWorlds) {
  for (const std::string& name : testing::shipped_worlds()) {
    const std::string text = testing::world_text(name);
    const auto parsed = parse_world_text(text, name, {});
    ASSERT_TRUE(parsed.has_value()) << parsed.error().message;
    const auto sections = world::world_schema(text, (*parsed)->world, (*parsed)->registry);
    ASSERT_TRUE(sections.has_value());
    const world::WorldField* seed = world::find_field(*sections, {"world", "seed"});
    const world::WorldField* relief = world::find_field(*sections, {"terrain", "relief_m"});
    ASSERT_TRUE(seed != nullptr && relief != nullptr);
    const auto cells = sweep_cells(text, **parsed, {*relief, *seed}, 2, 3);
    ASSERT_TRUE(cells.has_value()) << cells.error().message;
    ASSERT_EQ(cells->size(), 6U);
    EXPECT_EQ((*cells)[0].values[1], (*cells)[2].values[1]) << "the second field fills columns";
    EXPECT_EQ((*cells)[0].values[0], (*cells)[3].values[0]);
    for (const SweepCell& cell : *cells)
      EXPECT_TRUE(parse_world_text(cell.text, name, {}).has_value());
  }
}

TEST(Sweep, TheCellWithThePresentValuesHasThePresentText) {
  const std::string text = testing::world_text("silver_combe");
  const auto parsed = parse_world_text(text, "", {});
  ASSERT_TRUE(parsed.has_value());
  const auto sections = world::world_schema(text, (*parsed)->world, (*parsed)->registry);
  ASSERT_TRUE(sections.has_value());
  const auto cells =
      sweep_cells(text, **parsed, {*world::find_field(*sections, {"world", "seed"})}, 2, 2);
  ASSERT_TRUE(cells.has_value());
  ASSERT_EQ(cells->size(), 4U);
  EXPECT_EQ((*cells)[0].text, text);
  EXPECT_NE((*cells)[1].text, text);
}

}  // namespace
}  // namespace psygen::editor
