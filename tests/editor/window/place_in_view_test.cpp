// The tool that places single models, with mouse and keys in the view.
#include <QComboBox>
#include <QDir>
#include <QWheelEvent>
#include <glm/geometric.hpp>

#include "tests/editor/window/tool_fixture.hpp"
#include "tests/source_file.hpp"

namespace psygen::editor {
namespace {

class PlaceInView : public ToolInView {
 protected:
  std::string world_text() override {
    std::filesystem::copy_file(source_file("examples/09_gltf/windmill.glb"),
                               folder_.path() / "windmill.glb");
    return std::string(kSmallWorld) +
           "\n[[model]]\nname = \"windmill\"\nfile = \"windmill.glb\"\nsize_m = 6\n";
  }
  const world::Place& placed(std::size_t i = 0) { return document().world().places.all[i]; }
  std::size_t count() { return document().world().places.all.size(); }
  double turn_deg(std::size_t i = 0) {
    const auto& type = document().parsed()->registry[placed(i).model];
    return placed(i).parameters.real(
        static_cast<std::size_t>(models::parameter_index(type, "turn_deg")));
  }
  void wheel(glm::dvec2 at_m, int steps) {
    const QPointF at = pixel(at_m);
    QWheelEvent event(at, view().mapToGlobal(at), {}, {0, 120 * steps}, {}, {}, Qt::NoScrollPhase,
                      false);
    QCoreApplication::sendEvent(&view(), &event);
    draw();
  }
};

TEST_F(PlaceInView, IsPlacedDraggedTurnedSavedAndOpenedAgain) {
  command("Place models");
  auto* bar = window_->findChild<QToolBar*>("tools");
  QComboBox* types = nullptr;
  for (QComboBox* box : bar->findChildren<QComboBox*>())
    if (box->accessibleName() == "Model to place") types = box;
  ASSERT_NE(types, nullptr);
  ASSERT_TRUE(QTest::qWaitFor([&] { return types->isVisible(); }, kMaxMs));
  EXPECT_EQ(types->currentText(), "windmill");
  const image::Image plain = picture();
  click(place(-4, 0));
  ASSERT_EQ(count(), 1U);
  EXPECT_TRUE(near(placed().at_m, place(-4, 0)));
  EXPECT_TRUE(QTest::qWaitFor([&] { return difference(picture(), plain) > 0.001; }, kMaxMs))
      << "it stands there";
  drag(placed().at_m, place(4, 2));
  EXPECT_TRUE(near(placed().at_m, place(4, 2)));
  EXPECT_EQ(steps(), 2);
  wheel(placed().at_m, 2);
  EXPECT_EQ(turn_deg(), 30);
  press_key(Qt::Key_Period);
  EXPECT_EQ(turn_deg(), 15);
  EXPECT_EQ(steps(), 3);
  const core::CameraPose before = view().camera().pose();
  wheel(place(-6, -4), 1);
  EXPECT_NE(glm::length(view().camera().pose().position.local - before.position.local), 0)
      << "beside it the wheel is the camera's";
  EXPECT_EQ(turn_deg(), 15);
  save_and_reopen();
  ASSERT_EQ(count(), 1U);
  EXPECT_EQ(turn_deg(), 15);
}

TEST_F(PlaceInView, DeleteRemovesItAndUndoRestoresIt) {
  command("Place models");
  click(place(-4, 0));
  click(place(4, 0));
  ASSERT_EQ(count(), 2U);
  press_key(Qt::Key_Delete);
  ASSERT_EQ(count(), 1U);
  EXPECT_TRUE(near(placed().at_m, place(-4, 0)));
  document().undo_stack().undo();
  EXPECT_EQ(count(), 2U);
  // The sky: the camera looks up.
  core::CameraPose pose = view().camera().pose();
  pose.pitch = 1;
  view().camera().set_pose(pose);
  draw();
  QTest::mouseClick(&view(), Qt::LeftButton, {}, {100, 100});
  draw();
  EXPECT_EQ(count(), 2U);
}

}  // namespace
}  // namespace psygen::editor
