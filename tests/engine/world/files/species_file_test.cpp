#include "engine/world/files/species_file.hpp"

#include <gmock/gmock.h>

#include "engine/world/files/world_file.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::replaced;
using ::testing::StartsWith;

const std::string kFile = std::string(testing::kSmallWorld) + R"(
[[species]]
name = "ash"
axiom = "T"
iterations = 3
branches = 3
[[species.kind]]
symbol = "T"
[[species.kind]]
symbol = "S"
length = 0.7
[[species.rule]]
from = "T"
to = "S*"
[[species.rule]]
from = "S"
to = "S2"
probability = 0.5
[[species.rule]]
from = "S"
to = "S3"
probability = 0.5
[species.foliage]
form = "leaflets"

[[scatter]]
model = "ash"
count = 2
iterations = [2, 3]
season = 2
)";

// The message for the file with a change. The registry must keep its types and get no new ones.
std::string species_error_with(std::string_view from, std::string_view to) {
  models::Registry registry = models::make_standard_registry();
  const auto world = parse_world(replaced(kFile, from, to), "w.toml", registry);
  EXPECT_EQ(registry.size(), 4U);
  EXPECT_FALSE(world.has_value()) << to;
  return world ? "" : world.error().message;
}

TEST(SpeciesFile, MakesAModelThatCanBeScattered) {
  models::Registry registry = models::make_standard_registry();
  const auto world = parse_world(kFile, "w.toml", registry);
  ASSERT_TRUE(world.has_value()) << world.error().message;
  ASSERT_EQ(registry.size(), 5U);
  EXPECT_EQ(registry[4].name(), "ash");
  EXPECT_EQ(world->scatter[2].model, 4);
  EXPECT_EQ(world->scatter[2].ranges[models::kSpeciesSeason], (ParameterRange{2, 2}));
  EXPECT_EQ(world->species[0].rules.size(), 3U);
  EXPECT_GT(world_size(*world, registry).triangles, 0);
}

TEST(SpeciesFile, ReadsWhatItWrites) {
  models::Registry registry = models::make_standard_registry();
  const World world = parse_world(kFile, "w.toml", registry).value();
  models::Registry other = models::make_standard_registry();
  EXPECT_EQ(parse_world(write_world(world, registry), "w.toml", other).value(), world);
}

TEST(SpeciesFile, KeepsOneModelForEqualSpeciesAndRejectsOthersWithItsName) {
  models::Registry registry = models::make_standard_registry();
  ASSERT_TRUE(parse_world(kFile, "w.toml", registry).has_value());
  EXPECT_TRUE(parse_world(kFile, "w.toml", registry).has_value());
  EXPECT_EQ(registry.size(), 5U);
  const auto edited =
      parse_world(replaced(kFile, "length = 0.7", "length = 0.71"), "w.toml", registry);
  ASSERT_FALSE(edited.has_value());
  EXPECT_THAT(edited.error().message, HasSubstr("another model is named ash"));
  const models::Registry& constant = registry;
  EXPECT_TRUE(parse_world(kFile, "w.toml", constant).has_value());
  const models::Registry standard = models::make_standard_registry();
  EXPECT_FALSE(parse_world(kFile, "w.toml", standard).has_value());
}

TEST(SpeciesFile, RejectsWithFileLineAndField) {
  EXPECT_THAT(
      species_error_with("to = \"S2\"", "to = \"Q2\""),
      AllOf(StartsWith("w.toml:40: species[0].rule[1].to: "), HasSubstr("symbol Q is unknown")));
  EXPECT_THAT(species_error_with("to = \"S2\"", "to = \"ö2\""), HasSubstr("symbol ö is unknown"));
  EXPECT_THAT(species_error_with("axiom = \"T\"", "axiom = \"X\""),
              AllOf(StartsWith("w.toml:27: species[0].axiom: "), HasSubstr("unknown")));
  EXPECT_THAT(species_error_with("probability = 0.5", "probability = 0.4"),
              AllOf(HasSubstr("species[0].rule[2].probability: "), HasSubstr("sum up to 0.9")));
  EXPECT_THAT(species_error_with("length = 0.7", "length = nan"),
              AllOf(StartsWith("w.toml:34: species[0].kind[1].length: "), HasSubstr("nan")));
  EXPECT_THAT(species_error_with("length = 0.7", "length = -inf"),
              HasSubstr("must be a number from"));
  EXPECT_THAT(species_error_with("length = 0.7", "lenght = 0.7"), HasSubstr("did you mean length"));
  EXPECT_THAT(species_error_with("length = 0.7", "length = \"long\""),
              HasSubstr("must be a number"));
  EXPECT_THAT(species_error_with("form = \"leaflets\"", "form = \"spikes\""),
              HasSubstr("species[0].foliage.form"));
  EXPECT_THAT(species_error_with("name = \"ash\"", "name = \"tree\""),
              HasSubstr("species[0].name"));
  EXPECT_THAT(species_error_with("name = \"ash\"", "name = \"Ash Tree\""), HasSubstr("snake_case"));
}

TEST(SpeciesFile, RejectsGrammarsThatGrowTooFastWithTheirCost) {
  EXPECT_THAT(species_error_with("to = \"S3\"", "to = \"S99999999999999999999\""),
              AllOf(HasSubstr("species[0].rule[2].to"), HasSubstr("predicted cost")));
  EXPECT_THAT(species_error_with("iterations = 3\n", "iterations = 1000000000\n"),
              AllOf(HasSubstr("species[0].iterations"), HasSubstr("predicted cost: 2^")));
  EXPECT_THAT(species_error_with("branches = 3\n", "branches = 9223372036854775807\n"),
              AllOf(HasSubstr("species[0].branches"), HasSubstr("predicted cost")));
  EXPECT_THAT(
      species_error_with("iterations = 3\nbranches = 3\n", "iterations = 12\nbranches = 8\n"),
      AllOf(HasSubstr("grows too fast"), HasSubstr("predicted cost")));
  EXPECT_THAT(species_error_with("iterations = [2, 3]\nseason", "iterations = 1000000000\nseason"),
              AllOf(HasSubstr("scatter[2].iterations"), HasSubstr("predicted cost: 2^")));
}

TEST(SpeciesFile, SurvivesBeingCutAtEveryByte) {
  for (std::size_t n = 0; n < kFile.size(); n += 3) {
    models::Registry registry = models::make_standard_registry();
    const auto world = parse_world(std::string_view(kFile).substr(0, n), "w.toml", registry);
    if (!world) {
      EXPECT_EQ(registry.size(), 4U);
    }
  }
}

}  // namespace
}  // namespace psygen::world
