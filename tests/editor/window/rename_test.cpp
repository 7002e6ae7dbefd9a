// A species is renamed by typing into its Name field.
#include <QLineEdit>

#include "editor/panels/field_row.hpp"
#include "tests/editor/window/oak_fixture.hpp"

namespace psygen::editor {
namespace {

using Rename = OakInWindow;

// Leaving the field renames the species, which creates the rows of all fields anew.
TEST_F(Rename, ASpeciesIsRenamedWhereItIsScattered) {
  const world::TextPath name{"species", 0, "name"};
  properties().go_to(name.parent());
  auto* line = properties().row(name)->findChild<QLineEdit*>();
  line->setFocus();
  line->selectAll();
  QTest::keyClicks(line, "elder");
  QTest::keyClick(line, Qt::Key_Tab);
  ASSERT_TRUE(QTest::qWaitFor(
      [&] { return document().text().find("model = \"elder\"") != std::string::npos; }, kMaxMs));
  EXPECT_NE(document().text().find("name = \"elder\""), std::string::npos);
  EXPECT_EQ(document().text().find("\"oak\""), std::string::npos);
  EXPECT_EQ(document().undo_stack().count(), 1);
  settle();
  EXPECT_EQ(shown().species[0].name, "elder");
}

}  // namespace
}  // namespace psygen::editor
