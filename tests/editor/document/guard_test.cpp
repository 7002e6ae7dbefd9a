// Edits that need the user's confirmation.
#include <gmock/gmock.h>

#include "engine/world/files/text_edit.hpp"
#include "tests/editor/document/support.hpp"

namespace psygen::editor {
namespace {

using testing::good;
using testing::kWorld;
using testing::replaced;

const world::TextPath kStones{"scatter", 1, "count"};

// A document that asks for confirmation of more than 100 stones, and its questions.
struct Guarded {
  testing::Place place;
  Document document{place.options()};
  std::vector<std::string> asked;
  int changes = 0;
  Guarded() {
    EXPECT_TRUE(good(document.open(place.file)));
    document.set_guard([](const ParsedWorld&, const ParsedWorld& after) {
      const auto count = after.world.scatter[1].count;
      return count > 100 ? QString("%1 stones?").arg(count) : QString();
    });
    QObject::connect(&document, &Document::edit_proposed, &document,
                     [this](const QString& sentence) { asked.push_back(sentence.toStdString()); });
    QObject::connect(&document, &Document::changed, &document, [this] { ++changes; });
  }
};

TEST(DocumentGuard, ACostlyValueChangesNothingUntilItIsApplied) {
  Guarded guarded;
  Document& document = guarded.document;
  EXPECT_TRUE(good(document.set_value(kStones, "900")));
  EXPECT_EQ(document.text(), kWorld);
  EXPECT_EQ(guarded.changes, 0);
  EXPECT_EQ(document.undo_stack().count(), 0);
  EXPECT_EQ(document.confirmation(), "900 stones?");
  EXPECT_TRUE(good(document.apply_proposed_edit()));
  EXPECT_EQ(document.text(), replaced(kWorld, "count = 5", "count = 900"));
  EXPECT_TRUE(document.confirmation().isEmpty());
  EXPECT_THAT(guarded.asked, ::testing::ElementsAre("900 stones?", ""));
  document.undo_stack().undo();
  EXPECT_EQ(document.text(), kWorld);
}

TEST(DocumentGuard, ADiscardedEditIsGone) {
  Guarded guarded;
  Document& document = guarded.document;
  EXPECT_TRUE(good(document.set_value(kStones, "900")));
  document.discard_proposed_edit();
  EXPECT_TRUE(document.confirmation().isEmpty());
  EXPECT_TRUE(good(document.apply_proposed_edit()));
  EXPECT_EQ(document.text(), kWorld);
  EXPECT_EQ(guarded.changes, 0);
}

TEST(DocumentGuard, AnyOtherEditDiscardsTheProposedOne) {
  Guarded guarded;
  Document& document = guarded.document;
  EXPECT_TRUE(good(document.set_value(kStones, "900")));
  EXPECT_TRUE(good(document.set_value(kStones, "901")));
  EXPECT_EQ(document.confirmation(), "901 stones?") << "the newest edit replaces the others";
  EXPECT_TRUE(good(document.set_value({"world", "seed"}, "6")));
  EXPECT_TRUE(document.confirmation().isEmpty());
  EXPECT_TRUE(good(document.set_value(kStones, "900")));
  document.undo_stack().undo();
  EXPECT_TRUE(document.confirmation().isEmpty());
  EXPECT_TRUE(good(document.set_value(kStones, "900")));
  EXPECT_TRUE(good(document.set_value(kStones, "5"))) << "back to what is";
  EXPECT_TRUE(document.confirmation().isEmpty());
  EXPECT_EQ(document.text(), kWorld);
}

TEST(DocumentGuard, ADragIntoCostlyValuesIsOneStepWithItsAppliedEdits) {
  Guarded guarded;
  Document& document = guarded.document;
  document.begin_drag();
  for (const char* value : {"20", "90", "400", "900"})
    EXPECT_TRUE(good(document.set_value(kStones, value)));
  document.end_drag();
  EXPECT_EQ(document.world().scatter[1].count, 90U);
  EXPECT_EQ(guarded.changes, 2) << "the world never sees costly values";
  EXPECT_TRUE(good(document.apply_proposed_edit()));
  EXPECT_EQ(document.world().scatter[1].count, 900U);
  EXPECT_EQ(document.undo_stack().count(), 1);
  document.undo_stack().undo();
  EXPECT_EQ(document.text(), kWorld);
}

TEST(DocumentGuard, FilesAndInvalidValuesNeedNoConfirmation) {
  Guarded guarded;
  Document& document = guarded.document;
  EXPECT_FALSE(document.set_value(kStones, "\"many\""));
  EXPECT_TRUE(document.confirmation().isEmpty());
  testing::write(guarded.place.file, replaced(kWorld, "count = 5", "count = 900"));
  EXPECT_TRUE(good(document.reload()));
  EXPECT_EQ(document.world().scatter[1].count, 900U);
  EXPECT_TRUE(guarded.asked.empty());
}

TEST(Document, ASectionIsResetInOneStepAndKeepsFieldsWithoutDefault) {
  testing::Place place;
  Document document(place.options());
  EXPECT_TRUE(good(document.open(place.file)));
  EXPECT_TRUE(good(document.reset_section({"scatter", 1})));
  EXPECT_EQ(document.text(), replaced(kWorld, "subdivisions = 1\n", ""));
  EXPECT_TRUE(good(document.reset_section({"terrain"})));
  EXPECT_EQ(world::value_text(document.text(), {"terrain", "octaves"}), std::nullopt);
  document.undo_stack().undo();
  document.undo_stack().undo();
  EXPECT_EQ(document.text(), kWorld);
}

}  // namespace
}  // namespace psygen::editor
