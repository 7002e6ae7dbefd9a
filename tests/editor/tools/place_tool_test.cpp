#include "editor/tools/place_tool.hpp"

#include <gmock/gmock.h>

#include "tests/editor/tools/support.hpp"

namespace psygen::editor {
namespace {

using testing::click;
using ::testing::Contains;
using testing::good;
using testing::ground;
using testing::handle;
using ::testing::HasSubstr;
using testing::kWorld;
using ::testing::Not;
using testing::Place;
using testing::sky;
using testing::Toolbench;

struct Placed : Toolbench {
  PlaceTool tool{host()};
  const std::vector<world::Place>& places() { return document.world().places.all; }
};

// A world with a windmill from a file.
struct Windmills : Placed {
  Windmills() {
    std::filesystem::copy_file(source_file("examples/09_gltf/windmill.glb"),
                               place.file.parent_path() / "windmill.glb");
    EXPECT_TRUE(good(document.set_text(
        std::string(kWorld) + "\n[[model]]\nname = \"windmill\"\nfile = \"windmill.glb\"\n",
        QStringLiteral("Windmill"))));
    document.undo_stack().clear();
  }
  double turn_deg(std::size_t i) {
    const auto& type = document.parsed()->registry[places()[i].model];
    return places()[i].parameters.real(
        static_cast<std::size_t>(models::parameter_index(type, "turn_deg")));
  }
};

TEST(PlaceTool, AClickPlacesAModelAndADragMovesItInOneStep) {
  Placed bench;
  EXPECT_THAT(bench.tool.types(), Contains("rock"));
  EXPECT_THAT(bench.tool.types(), Not(Contains("terrain")));
  bench.tool.set_type("rock");
  bench.tool.press(ground(40.12, 50));
  bench.tool.drag(ground(44, 51));
  bench.tool.drag(sky());
  bench.tool.release();
  ASSERT_EQ(bench.places().size(), 1U);
  EXPECT_EQ(bench.places()[0].at_m, glm::dvec2(44, 51));
  EXPECT_EQ(bench.steps(), 1);
  EXPECT_EQ(bench.last_step(), "Place rock");
  EXPECT_EQ(bench.chosen, "place[0]");
  bench.document.undo_stack().undo();
  EXPECT_EQ(bench.document.text(), kWorld);
}

TEST(PlaceTool, AModelIsMovedByItsHandleAndRemoved) {
  Placed bench;
  bench.tool.set_type("tree");
  click(bench.tool, ground(40, 50));
  click(bench.tool, ground(60, 50));
  bench.tool.press(handle(bench.tool, 40, 50));
  bench.tool.drag(ground(42, 52));
  EXPECT_TRUE(bench.tool.cancel());
  EXPECT_EQ(bench.places()[0].at_m, glm::dvec2(40, 50)) << "Esc";
  EXPECT_EQ(bench.steps(), 2);
  bench.tool.press(handle(bench.tool, 40, 50));
  bench.tool.drag(ground(42, 52));
  bench.tool.release();
  EXPECT_EQ(bench.places()[0].at_m, glm::dvec2(42, 52));
  EXPECT_EQ(bench.steps(), 3);
  bench.tool.remove();
  ASSERT_EQ(bench.places().size(), 1U);
  EXPECT_EQ(bench.places()[0].at_m, glm::dvec2(60, 50));
  EXPECT_FALSE(bench.tool.place().has_value());
  bench.tool.click_right(handle(bench.tool, 60, 50));
  EXPECT_TRUE(bench.places().empty());
  bench.tool.remove();
  EXPECT_EQ(bench.messages.back(), "Click on a placed model first.");
}

TEST(PlaceTool, ConsecutiveTurnsAreOneStep) {
  Windmills bench;
  EXPECT_EQ(bench.tool.type(), "windmill") << "models of the file come first";
  click(bench.tool, ground(40, 50));
  const ToolPoint on = handle(bench.tool, 40, 50);
  EXPECT_TRUE(bench.tool.wheel(on, 1));
  EXPECT_TRUE(bench.tool.wheel(on, -2));
  EXPECT_EQ(bench.turn_deg(0), 345) << "all the way round";
  EXPECT_EQ(bench.steps(), 2);
  EXPECT_EQ(bench.last_step(), "Turn model 1");
  ToolPoint fine = on;
  fine.fine = true;
  EXPECT_TRUE(bench.tool.wheel(fine, 2));
  EXPECT_EQ(bench.turn_deg(0), 347);
  EXPECT_EQ(bench.steps(), 2);
  EXPECT_FALSE(bench.tool.wheel(ground(70, 70), 1)) << "the camera's";
  click(bench.tool, ground(60, 50));
  bench.tool.turn(15);
  EXPECT_EQ(bench.turn_deg(1), 15);
  EXPECT_EQ(bench.steps(), 4);
  bench.tool.wheel(handle(bench.tool, 40, 50), 1);
  EXPECT_EQ(bench.turn_deg(0), 2);
  EXPECT_EQ(bench.steps(), 5) << "another one turns";
  bench.document.undo_stack().undo();
  EXPECT_EQ(bench.turn_deg(0), 347);
}

// A turn after any other edit is a new step, even if the history has the same length as before.
TEST(PlaceTool, ATurnDoesNotBecomePartOfAnotherDrag) {
  Windmills bench;
  click(bench.tool, ground(40, 50));
  bench.tool.turn(15);
  bench.document.undo_stack().undo();
  bench.document.begin_drag();
  ASSERT_TRUE(good(bench.document.set_value({"sky", "exposure"}, "2")));
  bench.document.end_drag();
  bench.tool.turn(15);
  const int steps = bench.steps();
  bench.document.undo_stack().undo();
  EXPECT_EQ(bench.turn_deg(0), 0);
  EXPECT_EQ(bench.document.world().sky.exposure, 2) << "of " << steps << " steps";
}

TEST(PlaceTool, InvalidPlacesAreRejectedWithAMessage) {
  Placed bench;
  bench.tool.set_type("tree");
  click(bench.tool, sky());
  EXPECT_EQ(bench.messages.back(), "There is no ground here. Click on the ground.");
  click(bench.tool, ground(-1e6, 0));
  EXPECT_THAT(bench.messages.back(), HasSubstr("outside the world"));
  EXPECT_EQ(bench.document.text(), kWorld);
  EXPECT_EQ(bench.steps(), 0);
  click(bench.tool, ground(40, 50));
  bench.tool.turn(15);
  EXPECT_EQ(bench.messages.back(),
            "tree cannot be turned. Only models with the parameter turn_deg can, such as those "
            "from files.");
  EXPECT_EQ(bench.steps(), 1);
}

TEST(PlaceTool, MarksShowAllModelsTheChosenOneAndTheNext) {
  Windmills bench;
  click(bench.tool, ground(40, 50));
  click(bench.tool, ground(90, 50));
  EXPECT_EQ(bench.tool.marks().handles.size(), 2U);
  EXPECT_TRUE(bench.tool.marks().handles[1].chosen);
  EXPECT_EQ(bench.tool.marks().lines.size(), 2U) << "its outline and its front";
  bench.tool.hover(ground(60, 60));
  EXPECT_EQ(bench.tool.marks().lines.size(), 3U);
  bench.tool.leave();
  EXPECT_EQ(bench.tool.marks().lines.size(), 2U);
  // A removed model is not chosen.
  bench.document.undo_stack().undo();
  EXPECT_FALSE(bench.tool.place().has_value());
}

}  // namespace
}  // namespace psygen::editor
