// The tool that draws roads, with mouse and keys in the view.
#include <QComboBox>
#include <glm/geometric.hpp>

#include "tests/editor/window/tool_fixture.hpp"

namespace psygen::editor {
namespace {

using RoadInView = ToolInView;

TEST_F(RoadInView, IsDrawnDraggedUndoneSavedAndOpenedAgain) {
  const std::string before = document().text();
  command("Draw roads");
  ASSERT_NE(view().tool(), nullptr);
  click(place(-8, 0));
  click(place(0, 5));
  click(place(8, 0));
  ASSERT_EQ(document().world().shaped.roads.size(), 1U);
  const auto points = [&] { return document().world().shaped.roads[0].points_m; };
  ASSERT_EQ(points().size(), 3U);
  EXPECT_TRUE(near(points()[0], place(-8, 0))) << points()[0].x << ", " << points()[0].y;
  EXPECT_TRUE(near(points()[2], place(8, 0))) << points()[2].x << ", " << points()[2].y;
  EXPECT_EQ(steps(), 2);
  EXPECT_FALSE(view().selection().has_value()) << "the tool has the button";
  drag(points()[1], place(0, -10));
  EXPECT_TRUE(near(points()[1], place(0, -10))) << points()[1].x << ", " << points()[1].y;
  EXPECT_EQ(steps(), 3) << "a drag is one step";
  auto* roads = window_->findChild<QToolBar*>("tools")->findChild<QComboBox*>();
  EXPECT_EQ(roads->currentText(), "Road 1, 3 points");
  click(points()[0], Qt::RightButton);
  EXPECT_EQ(points().size(), 2U);
  document().undo_stack().undo();
  EXPECT_EQ(points().size(), 3U);
  save_and_reopen();
  EXPECT_TRUE(near(points()[1], place(0, -10)));
  EXPECT_EQ(view().tool(), nullptr) << "another file leaves the tool";
  EXPECT_NE(document().text(), before);
}

TEST_F(RoadInView, EscapeExitsTheToolAndDeleteRemovesThePoint) {
  command("Draw roads");
  const image::Image plain = picture();
  click(place(-8, 0));
  EXPECT_GT(difference(picture(), plain), 0) << "the first point is shown";
  click(place(0, 5));
  click(place(8, 0));
  press_key(Qt::Key_Delete);
  ASSERT_EQ(document().world().shaped.roads.size(), 1U);
  EXPECT_EQ(document().world().shaped.roads[0].points_m.size(), 2U);
  press_key(Qt::Key_Escape);
  EXPECT_EQ(view().tool(), nullptr);
  click(place(10, 10));
  EXPECT_TRUE(view().selection().has_value()) << "the button selects again";
}

TEST_F(RoadInView, AModelAloneAndAToolExcludeEachOther) {
  command("Draw roads");
  properties().go_to({"scatter", 1});
  command("Model alone");
  EXPECT_EQ(view().tool(), nullptr);
  settle();
  EXPECT_EQ(shown().name, "portrait");
  command("Draw roads");
  EXPECT_NE(view().tool(), nullptr);
  settle();
  EXPECT_EQ(shown().name, "small");
}

}  // namespace
}  // namespace psygen::editor
