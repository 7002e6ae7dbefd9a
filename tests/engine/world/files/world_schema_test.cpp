#include "engine/world/files/world_schema.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/text_layout.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using ::testing::ElementsAre;

struct Read {
  models::Registry registry = models::make_standard_registry();
  World world;
  std::vector<WorldSection> sections;
};

Read schema_of(const std::string& text) {
  Read read;
  auto world = parse_world(text, "test.toml", read.registry);
  EXPECT_TRUE(world) << world.error().message;
  if (!world) return read;
  read.world = *world;
  auto sections = world_schema(text, read.world, read.registry);
  EXPECT_TRUE(sections) << sections.error().message;
  read.sections = sections.value_or(std::vector<WorldSection>{});
  return read;
}

void each_field(const std::vector<WorldSection>& sections,
                const std::function<void(const WorldSection&, const WorldField&)>& visit) {
  for (const WorldSection& section : sections) {
    for (const WorldField& field : section.fields)
      visit(section, field);
    each_field(section.parts, visit);
  }
}

TEST(WorldSchema, HasEveryKeyOfEveryWorldAsItIsInTheText) {
  for (const auto& [name, text] : testing::shipped_worlds()) {
    const Read read = schema_of(text);
    const auto layout = lay_out(text, name);
    ASSERT_TRUE(layout);
    for (const TextPlace& place : layout->places) {
      if (place.is_header() || place.nested || place.path == TextPath{"format"}) continue;
      const WorldField* field = find_field(read.sections, place.path);
      ASSERT_NE(field, nullptr) << name << ": " << place.path.text();
      EXPECT_TRUE(field->is_set);
      EXPECT_EQ(field->value, value_text(text, place.path));
    }
    std::size_t set = 0;
    each_field(read.sections, [&](const WorldSection&, const WorldField& f) { set += f.is_set; });
    EXPECT_EQ(set + 1,
              static_cast<std::size_t>(std::ranges::count_if(
                  layout->places, [](const TextPlace& p) { return !p.is_header() && !p.nested; })));
  }
}

TEST(WorldSchema, EveryFieldHasALabelALineOfHelpAndSoundRanges) {
  const Read read = schema_of(testing::shipped_text("worlds/five_species.toml"));
  std::size_t fields = 0;
  each_field(read.sections, [&](const WorldSection& section, const WorldField& field) {
    ++fields;
    const std::string name = field.path.text();
    EXPECT_FALSE(field.label.empty()) << name;
    EXPECT_FALSE(field.doc.empty()) << name;
    EXPECT_EQ(field.doc.find('\n'), std::string::npos) << name;
    EXPECT_FALSE(section.title.empty()) << name;
    EXPECT_LE(field.hard_min, field.soft_min) << name;
    EXPECT_LE(field.soft_max, field.hard_max) << name;
    const bool has_numbers = field.kind != FieldKind::kText && field.kind != FieldKind::kImage &&
                             field.kind != FieldKind::kChoice &&
                             field.kind != FieldKind::kBoolean && field.kind != FieldKind::kToml;
    EXPECT_TRUE(!has_numbers || field.soft_min < field.soft_max) << name;
    for (const double number : field.numbers)
      EXPECT_TRUE(!has_numbers || (number >= field.hard_min && number <= field.hard_max)) << name;
    EXPECT_EQ(field.kind == FieldKind::kChoice, !field.choices.empty()) << name;
  });
  EXPECT_GT(fields, 300U);
}

// Missing fields have their defaults: writing the default changes nothing.
void expect_usual_values_change_nothing(const std::string& text) {
  const Read read = schema_of(text);
  std::string all = text;
  each_field(read.sections, [&](const WorldSection&, const WorldField& field) {
    if (field.is_set || field.usual.empty()) return;
    EXPECT_EQ(field.usual, field.value) << field.path.text();
    const auto changed = with_value(all, field.path, field.usual);
    ASSERT_TRUE(changed) << changed.error().message;
    all = *changed;
  });
  EXPECT_EQ(schema_of(all).world, read.world);
}

TEST(WorldSchema, DefaultsAreThoseOfTheReader) {
  expect_usual_values_change_nothing(testing::kSmallWorld);
  expect_usual_values_change_nothing(std::string(testing::kSmallWorld) +
                                     "[sky]\nsun_elevation_deg = 9\n");
  expect_usual_values_change_nothing(testing::shipped_text("worlds/five_species.toml"));
  expect_usual_values_change_nothing(testing::shipped_text("worlds/frost_isle.toml"));
}

TEST(WorldSchema, ShowsValuesAsNumbersWithTheirUnits) {
  const std::string text = *with_value(testing::kSmallWorld, {"sky", "sun_elevation_deg"}, "30.0");
  const Read read = schema_of(text);
  const WorldField* sun = find_field(read.sections, {"sky", "sun_elevation_deg"});
  ASSERT_NE(sun, nullptr);
  EXPECT_EQ(sun->label, "Sun elevation");
  EXPECT_EQ(sun->unit, "degrees");
  EXPECT_EQ(sun->value, "30.0");
  EXPECT_EQ(sun->usual, "44");
  EXPECT_THAT(sun->numbers, ElementsAre(30));
  EXPECT_EQ(read.world.sky.sun_elevation_deg, 30);
  const WorldField* size = find_field(read.sections, {"scatter", 0, "size_m"});
  ASSERT_NE(size, nullptr);
  EXPECT_EQ(size->kind, FieldKind::kRealRange);
  EXPECT_THAT(size->numbers, ElementsAre(1.5, 2.5));
  const WorldField* slope = find_field(read.sections, {"scatter", 0, "min_height_m"});
  ASSERT_NE(slope, nullptr);
  EXPECT_TRUE(slope->numbers.empty() && slope->value.empty() && slope->usual.empty());
  EXPECT_TRUE(find_field(read.sections, {"sky", "visibility_m"})->logarithmic);
  EXPECT_FALSE(find_field(read.sections, {"sky", "cloud_cover"})->logarithmic);
  EXPECT_TRUE(find_field(read.sections, {"world", "seed"})->required);
  EXPECT_EQ(find_field(read.sections, {"world", "seed"})->plain, "5");
  EXPECT_EQ(find_field(read.sections, {"sky", "seed"}), nullptr);
}

TEST(WorldSchema, ColoursOfSpeciesAreSquareRoots) {
  const Read read = schema_of(testing::shipped_text("worlds/five_species.toml"));
  for (const char* name : {"bark", "spring"})
    EXPECT_EQ(find_field(read.sections, {"species", 0, "colours", name})->encoding,
              ColourEncoding::kSquareRoot);
  for (const TextPath& path : {TextPath{"sky", "haze_colour"}, TextPath{"palette", "rock"}})
    EXPECT_EQ(find_field(read.sections, path)->encoding, ColourEncoding::kLinear);
}

TEST(WorldSchema, AModelTypeOfTheProgramAppearsWithoutFurtherCode) {
  const std::string donor = testing::shipped_text("worlds/five_species.toml");
  Read read = schema_of(donor);
  models::Species own = read.world.species.front();
  own.name = "mine";
  models::Registry registry = models::make_standard_registry();
  ASSERT_TRUE(registry.add(*models::make_species_type(own)));
  const std::string text =
      *with_table_appended(testing::kSmallWorld, {"scatter"}, "model = \"mine\"\ncount = 1\n");
  const auto world = parse_world(text, "test.toml", std::as_const(registry));
  ASSERT_TRUE(world) << world.error().message;
  const auto sections = world_schema(text, *world, registry);
  ASSERT_TRUE(sections);
  EXPECT_EQ(sections->back().title, "mine");
  EXPECT_NE(find_field(*sections, {"scatter", 2, "leaf_scale"}), nullptr);
  EXPECT_THAT(find_field(*sections, {"scatter", 0, "model"})->choices,
              ElementsAre("rock", "tree", "grass", "mine"));
}

TEST(WorldSchema, RejectsAWorldOfAnotherText) {
  const Read read = schema_of(testing::kSmallWorld);
  EXPECT_EQ(world_schema("a = ", read.world, read.registry).error().code, core::ErrorCode::kParse);
  EXPECT_EQ(world_schema("a = 1", read.world, read.registry).error().code,
            core::ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace psygen::world
