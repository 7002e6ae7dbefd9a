#include "editor/document/variation.hpp"

#include <gtest/gtest.h>

#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/world_file.hpp"
#include "tests/editor/document/support.hpp"

namespace psygen::editor {
namespace {

using testing::good;

void each_field(const std::vector<world::WorldSection>& sections,
                const std::function<void(const world::WorldField&)>& visit) {
  for (const world::WorldSection& section : sections) {
    for (const world::WorldField& field : section.fields)
      visit(field);
    each_field(section.parts, visit);
  }
}

TEST(Variation, RandomAndSteppedValuesHaveTheKindOfTheirField) {
  const testing::Place place(testing::read(source_file("game/worlds/five_species.toml")));
  Document document(place.options());
  ASSERT_TRUE(good(document.open(place.file)));
  std::mt19937_64 random(3);
  constexpr std::size_t kEach = 4;  // tests every fourth field, because each needs a parsed world
  std::size_t fields = 0, values = 0, taken = 0;
  each_field(document.sections(), [&](const world::WorldField& field) {
    const auto value = fields++ % kEach == 0 ? random_value(field, random) : std::nullopt;
    if (!value) return;
    const auto text = world::with_value(document.text(), field.path, *value);
    ASSERT_TRUE(text) << text.error().message;
    models::Registry registry = models::make_standard_registry();
    ++values;
    taken += world::parse_world(*text, "varied", registry) ? 1 : 0;
    if (const auto next = stepped_value(field, 1)) {
      EXPECT_TRUE(world::with_value(document.text(), field.path, *next)) << *next;
    }
  });
  EXPECT_GT(values, 70U);
  EXPECT_GT(taken, values * 3 / 4) << "most fields take any value of their soft range";
}

TEST(Variation, StepsGoUpAndDownWithinTheHardRange) {
  world::WorldField field;
  field.kind = world::FieldKind::kReal;
  field.hard_min = 0, field.hard_max = 2, field.soft_min = 0, field.soft_max = 1;
  field.numbers = {0.3};
  EXPECT_EQ(stepped_value(field, 1), "0.31");
  EXPECT_EQ(stepped_value(field, -10), "0.2");
  EXPECT_EQ(stepped_value(field, 1000), "2");
  EXPECT_EQ(stepped_value(field, -1000), "0");
  field.soft_min = 0.01, field.soft_max = 1, field.logarithmic = true;
  EXPECT_EQ(stepped_value(field, 50), "2");
  EXPECT_EQ(stepped_value(field, -50), "0.03");
  field.kind = world::FieldKind::kIntegerRange;
  field.numbers = {0, 1};
  EXPECT_EQ(stepped_value(field, 1), "[1, 2]");
  field.kind = world::FieldKind::kSeed;
  field.plain = "18446744073709551615";
  EXPECT_EQ(stepped_value(field, -1), "\"18446744073709551614\"");
  EXPECT_EQ(stepped_value(field, 1), "0");
  field.kind = world::FieldKind::kChoice;
  field.choices = {"a", "b", "c"};
  field.plain = "c";
  EXPECT_EQ(stepped_value(field, 1), "\"a\"");
  EXPECT_EQ(stepped_value(field, -5), "\"a\"");
  field.kind = world::FieldKind::kText;
  EXPECT_FALSE(stepped_value(field, 1));
}

TEST(FieldLocks, AreKeptInTheStateFolderAndMoveWithTheirItems) {
  const testing::Place place;
  std::filesystem::create_directories(place.state);
  FieldLocks locks;
  locks.set_locked({"scatter", 1}, true);
  locks.set_locked({"scatter", 2, "count"}, true);
  locks.set_locked({"sky", "exposure"}, true);
  EXPECT_TRUE(locks.is_locked({"scatter", 1, "count"}));
  EXPECT_FALSE(locks.is_locked({"scatter", 2, "size_m"}));
  EXPECT_TRUE(good(locks.save(place.state, place.file)));
  EXPECT_EQ(FieldLocks::load(place.state, place.file), locks);
  EXPECT_TRUE(FieldLocks::load(place.state, place.folder / "other.toml").empty());
  locks.note_removed({"scatter", 1});
  EXPECT_TRUE(locks.is_locked({"scatter", 1, "count"}));
  EXPECT_FALSE(locks.is_locked({"scatter", 1, "size_m"}));
  locks.note_inserted({"scatter", 0});
  EXPECT_TRUE(locks.is_locked({"scatter", 2, "count"}));
  locks.note_moved({"scatter", 2}, 0);
  EXPECT_TRUE(locks.is_locked({"scatter", 0, "count"}));
  locks.note_moved({"scatter", 2}, 0);
  EXPECT_TRUE(locks.is_locked({"scatter", 1, "count"}));
  locks.set_locked({"sky", "exposure"}, false);
  locks.set_locked({"scatter", 1, "count"}, false);
  EXPECT_TRUE(locks.empty());
}

}  // namespace
}  // namespace psygen::editor
