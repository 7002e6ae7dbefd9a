#include "editor/document/document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QSignalSpy>

#include "engine/models/tree/species.hpp"
#include "engine/world/files/text_edit.hpp"
#include "tests/editor/document/support.hpp"

namespace psygen::editor {
namespace {

using testing::good;
using ::testing::HasSubstr;
using testing::kWorld;
using testing::Place;
using testing::replaced;

// A document with the world of the tests, and the changes that it has reported.
struct Opened {
  Place place;
  Document document;
  std::optional<Change> told;
  int times = 0;
  explicit Opened(const std::string& text = kWorld) : place(text), document(place.options()) {
    EXPECT_TRUE(good(document.open(place.file)));
    QObject::connect(&document, &Document::changed, [this](Change what) {
      told = what;
      ++times;
    });
  }
};

TEST(Document, ANewOneIsAValidWorldWithoutAFile) {
  const Place place;
  Document document(place.options());
  EXPECT_TRUE(document.file().empty());
  EXPECT_FALSE(document.is_modified());
  EXPECT_EQ(document.world().scatter.size(), 2U);
  EXPECT_EQ(document.save().error().message, "this world has no file yet");
}

TEST(Document, AnEditChangesTheTextAndReportsItsExtent) {
  Opened opened;
  Document& document = opened.document;
  EXPECT_TRUE(good(document.set_value({"sky", "exposure"}, "2")));
  EXPECT_EQ(document.text(), std::string(kWorld) + "\n[sky]\nexposure = 2\n");
  EXPECT_EQ(document.world().sky.exposure, 2);
  EXPECT_EQ(opened.told, Change::kText);
  EXPECT_TRUE(good(document.set_value({"scatter", 1, "count"}, "6")));
  EXPECT_EQ(opened.told, Change::kText);
  EXPECT_TRUE(good(document.append_table({"scatter"}, "model = \"grass\"\ncount = 1\n")));
  EXPECT_EQ(opened.told, Change::kText);
  EXPECT_TRUE(good(document.set_text(document.text() + "# more\n", QStringLiteral("Comment"))));
  EXPECT_EQ(opened.told, Change::kText);
  EXPECT_TRUE(good(document.append_table({"road"}, "points_m = [[9, 9], [60, 90]]\n")));
  EXPECT_EQ(opened.told, Change::kGround);
  EXPECT_TRUE(good(document.set_value({"terrain", "relief_m"}, "150")));
  EXPECT_EQ(opened.told, Change::kGround);
  EXPECT_TRUE(good(document.open(opened.place.file)));
  EXPECT_EQ(opened.told, Change::kFile);
  EXPECT_TRUE(good(document.set_value({"sky", "exposure"}, "2")));
  EXPECT_EQ(document.field({"sky", "exposure"})->numbers.front(), 2);
  EXPECT_TRUE(good(document.reset_value({"sky", "exposure"})));
  EXPECT_FALSE(document.field({"sky", "exposure"})->is_set);
}

TEST(Document, EveryEditIsANamedStepThatIsUndoneToTheByte) {
  Opened opened;
  Document& document = opened.document;
  std::vector<std::string> texts{document.text()};
  const auto note = [&](const core::Result<void>& edited) {
    EXPECT_TRUE(good(edited));
    texts.push_back(document.text());
  };
  note(document.set_value({"world", "seed"}, "6"));
  note(document.remove_table({"scatter", 0}));
  note(document.duplicate_table({"scatter", 0}));
  note(document.move_table({"scatter", 1}, 0));
  note(document.paste({"sky"}, "[sky]\nexposure = 3\n"));
  EXPECT_EQ(document.undo_stack().count(), 5);
  EXPECT_EQ(document.undo_stack().text(0).toStdString(), "Set world.seed");
  EXPECT_TRUE(document.is_modified());
  for (std::size_t i = texts.size() - 1; i-- > 0;) {
    document.undo_stack().undo();
    EXPECT_EQ(document.text(), texts[i]);
  }
  EXPECT_FALSE(document.is_modified());
  for (std::size_t i = 1; i < texts.size(); ++i) {
    document.undo_stack().redo();
    EXPECT_EQ(document.text(), texts[i]);
  }
}

TEST(Document, ADragIsOneStepAndNoneIfItEndsAtItsStart) {
  Opened opened;
  Document& document = opened.document;
  document.begin_drag();
  for (int i = 1; i <= 20; ++i)
    EXPECT_TRUE(good(document.set_value({"sky", "exposure"}, std::to_string(i))));
  document.end_drag();
  EXPECT_EQ(opened.times, 20);
  EXPECT_EQ(document.undo_stack().count(), 1);
  document.begin_drag();
  EXPECT_TRUE(good(document.set_value({"sky", "exposure"}, "7")));
  EXPECT_TRUE(good(document.set_value({"sky", "exposure"}, "20")));
  document.end_drag();
  EXPECT_EQ(document.undo_stack().count(), 1);
  document.undo_stack().undo();
  EXPECT_EQ(document.text(), kWorld);
}

TEST(Document, ACancelledDragRestoresItsStartAndIsNoStep) {
  Opened opened;
  Document& document = opened.document;
  document.begin_drag();
  EXPECT_TRUE(good(document.set_value({"sky", "exposure"}, "7")));
  EXPECT_TRUE(good(document.set_value({"sky", "exposure"}, "8")));
  EXPECT_TRUE(good(document.cancel_drag()));
  EXPECT_TRUE(good(document.cancel_drag())) << "nothing is left to cancel";
  document.end_drag();
  EXPECT_EQ(document.text(), kWorld);
  EXPECT_EQ(document.undo_stack().count(), 0);
  EXPECT_TRUE(good(document.set_value({"sky", "exposure"}, "9")));
  EXPECT_TRUE(good(document.cancel_drag())) << "no drag";
  EXPECT_EQ(document.undo_stack().count(), 1);
}

TEST(Document, ATextThatComesDuringADragIsAStepOfItsOwn) {
  Opened opened;
  Document& document = opened.document;
  const std::string reloaded = std::string(kWorld) + "# by another program\n";
  document.begin_drag();
  EXPECT_TRUE(good(document.set_value({"sky", "exposure"}, "7")));
  EXPECT_TRUE(good(document.set_text(reloaded, QStringLiteral("Reload"))));
  EXPECT_TRUE(good(document.set_value({"sky", "exposure"}, "8")));
  EXPECT_TRUE(good(document.set_value({"sky", "exposure"}, "9")));
  EXPECT_EQ(document.undo_stack().count(), 3);
  EXPECT_TRUE(good(document.cancel_drag()));
  EXPECT_EQ(document.text(), reloaded);
  EXPECT_EQ(document.undo_stack().count(), 2);
}

TEST(Document, ARejectedEditNamesTheFieldAndChangesNothing) {
  Opened opened;
  Document& document = opened.document;
  const auto refused = document.set_value({"sky", "exposure"}, "1000");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr(opened.place.file.string() + ":24: sky.exposure"));
  EXPECT_FALSE(document.set_value({"scatter", 0, "size_m"}, "[3, 1]"));
  EXPECT_FALSE(document.set_value({"scatter", 0, "count"}, "100000"));
  EXPECT_FALSE(document.set_value({"sky", "exposure"}, "1 2"));
  EXPECT_FALSE(document.set_value({"sky", "expsure"}, "1"));
  EXPECT_FALSE(document.remove_table({"world"}));
  EXPECT_FALSE(document.set_text("format = 2\n", QStringLiteral("Newer")));
  EXPECT_FALSE(document.set_text(std::string(2 << 20, '#'), QStringLiteral("Large")));
  EXPECT_FALSE(document.set_text("\xFF\xFE", QStringLiteral("Bytes")));
  EXPECT_EQ(opened.times, 0);
  EXPECT_EQ(document.text(), kWorld);
  EXPECT_EQ(document.undo_stack().count(), 0);
  EXPECT_TRUE(good(document.set_value({"world", "seed"}, "5")));  // the present value
  EXPECT_EQ(document.undo_stack().count(), 0);
}

TEST(Document, ModelTypesOfTheProgramAreKnown) {
  const Place place;
  DocumentOptions options = place.options();
  options.register_models = [](models::Registry& registry) -> core::Result<void> {
    models::Species species;
    species.name = "mine";
    species.doc = "of the program";
    species.axiom = "A";
    species.kinds.resize(1);
    species.kinds[0].symbol = "A";
    species.rules = {{"A", "A2", 1}};
    auto type = models::make_species_type(species);
    if (!type) return tl::unexpected(type.error());
    if (auto added = registry.add(*std::move(type)); !added) return tl::unexpected(added.error());
    return {};
  };
  Document document(options);
  EXPECT_TRUE(good(document.append_table({"scatter"}, "model = \"mine\"\ncount = 1\n")));
  EXPECT_NE(document.field({"scatter", 2, "leaf_scale"}), nullptr);
}

TEST(Document, ARenamedSpeciesIsRenamedInItsScattersAndADuplicateGetsAFreeName) {
  Opened opened(testing::read(source_file("game/worlds/five_species.toml")));
  Document& document = opened.document;
  const std::size_t count = document.world().species.size();
  EXPECT_TRUE(good(document.duplicate_table({"species", 0})));
  EXPECT_EQ(document.world().species.size(), count + 1);
  EXPECT_EQ(document.world().species[1].name, document.world().species[0].name + "_2");
  const std::string old = document.world().species[0].name;
  EXPECT_TRUE(good(document.append_table({"place"}, "model = \"" + old + "\"\nat_m = [12, 20]\n")));
  EXPECT_TRUE(good(document.set_value({"species", 0, "name"}, "\"elder\"")));
  EXPECT_EQ(document.text().find("model = \"" + old + "\""), std::string::npos);
  EXPECT_NE(document.text().find("model = \"elder\""), std::string::npos);
  EXPECT_FALSE(
      document.set_value({"species", 0, "name"}, "\"" + document.world().species[2].name + "\""));
  EXPECT_FALSE(document.remove_table({"species", 0})) << "it is scattered";
  EXPECT_TRUE(good(document.remove_table({"species", 1})));
}

TEST(Document, ASpeciesThatOthersStandBesideIsRenamedThereToo) {
  Opened opened(testing::read(source_file("game/worlds/silver_combe.toml")));
  Document& document = opened.document;
  EXPECT_TRUE(good(document.set_value({"species", 0, "name"}, "\"elder\"")));
  EXPECT_THAT(document.text(), HasSubstr("beside = \"elder\""));
  EXPECT_TRUE(good(document.set_value({"scatter", 4, "beside"}, "\"birch\"")));
  EXPECT_EQ(document.world().scatter[4].site.beside, 0b10U);
  EXPECT_TRUE(good(document.reset_value({"scatter", 4, "beside"})));
}

TEST(Document, AScatterWithAnotherModelLosesTheParametersOfTheOldOne) {
  Opened opened;
  Document& document = opened.document;
  EXPECT_TRUE(good(document.set_value({"scatter", 0, "model"}, "\"rock\"")));
  EXPECT_EQ(document.text(),
            replaced(replaced(kWorld, "\"tree\"", "\"rock\""), "size_m = [1.5, 2.5]\n", ""));
  EXPECT_FALSE(document.set_value({"scatter", 0, "model"}, "\"nothing\""));
}

TEST(Document, SectionsAreKeptAsPresets) {
  Opened opened;
  Document& document = opened.document;
  const auto preset = opened.place.folder / "stones.toml";
  EXPECT_TRUE(good(document.save_preset({"scatter", 1}, preset)));
  EXPECT_THAT(testing::read(preset), HasSubstr("partial = 1\n\n# stones\n[[scatter]]"));
  EXPECT_TRUE(good(document.set_value({"scatter", 1, "count"}, "9")));
  EXPECT_TRUE(good(document.set_value({"scatter", 1, "moss"}, "1")));
  EXPECT_TRUE(good(document.apply_preset({"scatter", 1}, preset)));
  EXPECT_EQ(document.text(),
            replaced(kWorld, "subdivisions = 1\n", "subdivisions = 1\nmoss = 1\n"));
  EXPECT_EQ(document.undo_stack().undoText().toStdString(), "Apply stones");
  const auto refused = document.apply_preset({"sky"}, preset);
  EXPECT_THAT(refused.error().message, HasSubstr("does not fit into [sky]"));
  testing::write(preset, "partial = 9\n[sky]\n");
  EXPECT_THAT(document.apply_preset({"sky"}, preset).error().message, HasSubstr("version 9"));
  EXPECT_FALSE(document.save_preset({"sky"}, preset)) << "nothing of the sky is set";
}

TEST(Document, RandomisingLeavesTheSwitchOfAShapeAlone) {
  const Place place(
      "format = 1\n[world]\nname = \"roads\"\nseed = 5\nblocks = [8, 4]\n"
      "[[road]]\npoints_m = [[20, 30], [140, 140]]\n");
  Document document(place.options());
  ASSERT_TRUE(good(document.open(place.file)));
  for (unsigned seed = 0; seed < 8; ++seed) {
    std::mt19937_64 random(seed);
    EXPECT_TRUE(good(document.randomise({"road"}, random)));
    EXPECT_TRUE(document.world().shaped.roads[0].enabled);
  }
  EXPECT_THAT(document.text(), ::testing::HasSubstr("strength = "));
}

TEST(Document, RandomisingIsOneStepAndLeavesLockedFieldsAlone) {
  Opened opened;
  Document& document = opened.document;
  document.locks().set_locked({"scatter", 0, "size_m"}, true);
  document.locks().set_locked({"scatter", 1}, true);
  std::mt19937_64 random(4);
  EXPECT_TRUE(good(document.randomise({"scatter"}, random)));
  EXPECT_EQ(document.undo_stack().count(), 1);
  EXPECT_EQ(world::value_text(document.text(), {"scatter", 0, "size_m"}), "[1.5, 2.5]");
  EXPECT_EQ(world::table_text(document.text(), {"scatter", 1}),
            world::table_text(kWorld, {"scatter", 1}));
  EXPECT_NE(document.world().scatter[0].count, 3U);
  EXPECT_TRUE(good(document.step_value({"world", "seed"}, -2)));
  EXPECT_EQ(document.world().seed, 3U);
  EXPECT_FALSE(document.step_value({"world", "name"}, 1));
}

TEST(Document, LocksMoveWithTheirTablesAndReturnWithUndo) {
  Opened opened;
  Document& document = opened.document;
  document.locks().set_locked({"scatter", 1, "count"}, true);
  EXPECT_TRUE(good(document.remove_table({"scatter", 0})));
  EXPECT_TRUE(document.locks().is_locked({"scatter", 0, "count"}));
  document.undo_stack().undo();
  EXPECT_TRUE(document.locks().is_locked({"scatter", 1, "count"}));
  EXPECT_FALSE(document.locks().is_locked({"scatter", 0, "count"}));
  document.undo_stack().redo();
  EXPECT_TRUE(good(document.save()));
  Document again(opened.place.options());
  EXPECT_TRUE(good(again.open(opened.place.file, true)));
  EXPECT_TRUE(again.locks().is_locked({"scatter", 0, "count"}));
}

}  // namespace
}  // namespace psygen::editor
