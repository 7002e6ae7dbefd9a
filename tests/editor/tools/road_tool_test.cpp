#include "editor/tools/road_tool.hpp"

#include "tests/editor/tools/support.hpp"

namespace psygen::editor {
namespace {

using testing::click;
using testing::good;
using testing::ground;
using testing::handle;
using testing::kWorld;
using testing::sky;
using testing::Toolbench;
using Points = std::vector<glm::dvec2>;

struct Roads : Toolbench {
  RoadTool tool{host()};
  const Points& points(std::size_t road = 0) {
    return document.world().shaped.roads[road].points_m;
  }
  std::size_t count() { return document.world().shaped.roads.size(); }
};

TEST(RoadTool, TwoClicksMakeARoadAndMoreClicksExtendIt) {
  Roads bench;
  click(bench.tool, ground(40, 50));
  EXPECT_EQ(bench.steps(), 0) << "one point is no road";
  ASSERT_EQ(bench.tool.marks().handles.size(), 1U);
  click(bench.tool, ground(80.04, 60.06));
  ASSERT_EQ(bench.count(), 1U);
  EXPECT_EQ(bench.points(), (Points{{40, 50}, {80, 60.1}}));
  EXPECT_EQ(bench.last_step(), "Add road 1");
  EXPECT_EQ(bench.chosen, "road[0]");
  click(bench.tool, ground(120, 60));
  EXPECT_EQ(bench.points().back(), glm::dvec2(120, 60));
  EXPECT_EQ(bench.last_step(), "Add a point to road 1");
  EXPECT_EQ(bench.steps(), 2);
  bench.document.undo_stack().undo();
  bench.document.undo_stack().undo();
  EXPECT_EQ(bench.document.text(), kWorld);
  EXPECT_FALSE(bench.tool.road().has_value());
  EXPECT_TRUE(bench.tool.marks().lines.empty());
}

TEST(RoadTool, ADragIsOneStepAndEndsAtThePointer) {
  Roads bench;
  click(bench.tool, ground(40, 50));
  click(bench.tool, ground(80, 60));
  bench.tool.press(handle(bench.tool, 40, 50));
  for (int x = 41; x <= 49; ++x)
    bench.tool.drag(ground(x, 55));
  bench.tool.drag(sky());
  bench.tool.release();
  EXPECT_EQ(bench.points(), (Points{{49, 55}, {80, 60}}));
  EXPECT_EQ(bench.steps(), 2);
  EXPECT_EQ(bench.last_step(), "Move a point of road 1");
  bench.tool.drag(ground(70, 70));
  EXPECT_EQ(bench.points().front(), glm::dvec2(49, 55)) << "it was let go";
}

TEST(RoadTool, EscapeCancelsTheDrag) {
  Roads bench;
  click(bench.tool, ground(40, 50));
  EXPECT_TRUE(bench.tool.cancel()) << "the road that was begun";
  EXPECT_FALSE(bench.tool.cancel());
  click(bench.tool, ground(40, 50));
  click(bench.tool, ground(80, 60));
  const std::string before = bench.document.text();
  bench.tool.press(handle(bench.tool, 80, 60));
  bench.tool.drag(ground(90, 90));
  EXPECT_TRUE(bench.tool.cancel());
  EXPECT_EQ(bench.document.text(), before);
  EXPECT_EQ(bench.steps(), 1);
}

TEST(RoadTool, AClickOnTheRoadInsertsAPointAndAnotherRoadCanBeChosen) {
  Roads bench;
  click(bench.tool, ground(40, 50));
  click(bench.tool, ground(80, 60));
  click(bench.tool, ground(120, 60));
  const ToolMarks::Line& line = bench.tool.marks().lines[0];
  const auto at = std::ranges::find(line.points_m, glm::dvec2(80, 60));
  ASSERT_NE(at, line.points_m.end());
  ToolPoint on_road = ground(82, 61);
  on_road.line = {0, static_cast<std::size_t>(at - line.points_m.begin())};
  click(bench.tool, on_road);
  EXPECT_EQ(bench.points(), (Points{{40, 50}, {80, 60}, {82, 61}, {120, 60}}));
  EXPECT_EQ(bench.tool.chosen_point(), 2U);
  bench.tool.choose(std::nullopt);
  click(bench.tool, on_road);
  EXPECT_EQ(bench.tool.road(), 0U);
  EXPECT_EQ(bench.points().size(), 4U) << "it was picked only";
}

TEST(RoadTool, AChosenFirstPointExtendsTheRoadAtItsStart) {
  Roads bench;
  click(bench.tool, ground(40, 50));
  click(bench.tool, ground(80, 60));
  click(bench.tool, handle(bench.tool, 40, 50));
  EXPECT_EQ(bench.steps(), 1) << "a click that moves nothing is no step";
  click(bench.tool, ground(20, 40));
  EXPECT_EQ(bench.points(), (Points{{20, 40}, {40, 50}, {80, 60}}));
}

TEST(RoadTool, PointsAreRemovedAndTheLastTwoRemoveTheRoad) {
  Roads bench;
  click(bench.tool, ground(40, 50));
  click(bench.tool, ground(80, 60));
  click(bench.tool, ground(120, 60));
  bench.tool.click_right(handle(bench.tool, 80, 60));
  EXPECT_EQ(bench.points(), (Points{{40, 50}, {120, 60}}));
  bench.tool.remove();
  EXPECT_EQ(bench.count(), 0U);
  EXPECT_EQ(bench.messages.back(),
            "Removed the road, because a road needs two points. Undo restores it.");
  bench.document.undo_stack().undo();
  EXPECT_EQ(bench.count(), 1U);
  bench.tool.choose(0);
  bench.tool.remove();
  EXPECT_EQ(bench.messages.back(), "Click on a point of a road first.");
}

TEST(RoadTool, AnInvalidRoadIsRejectedWithAMessage) {
  Roads bench;
  click(bench.tool, sky());
  EXPECT_EQ(bench.messages.back(), "There is no ground here. Click on the ground.");
  click(bench.tool, ground(40, 50));
  click(bench.tool, ground(40.2, 50));
  EXPECT_NE(bench.messages.back().find("at least 1 m"), std::string::npos) << bench.messages.back();
  EXPECT_EQ(bench.document.text(), kWorld);
  click(bench.tool, ground(-1e6, 50));
  EXPECT_NE(bench.messages.back().find("outside the world"), std::string::npos);
  click(bench.tool, ground(80, 60));
  ASSERT_EQ(bench.count(), 1U) << "the first point was kept";
  const std::size_t told = bench.messages.size();
  bench.tool.press(handle(bench.tool, 80, 60));
  bench.tool.drag(ground(-1e6, 0));
  bench.tool.drag(ground(-1e7, 0));
  bench.tool.release();
  EXPECT_EQ(bench.messages.size(), told + 1) << "told once";
  EXPECT_EQ(bench.points().back(), glm::dvec2(80, 60));
}

}  // namespace
}  // namespace psygen::editor
