// An editor's window with the camera above the ground, and a mouse for points of the ground.
#pragma once

#include <QToolBar>

#include "engine/world/world.hpp"
#include "tests/editor/window/window_fixture.hpp"

namespace psygen::editor {

class ToolInView : public EditorWindow {
 protected:
  static constexpr glm::dvec2 kMiddleM{1000, 1000};  // in front of the camera

  void SetUp() override {
    EditorWindow::SetUp();
    core::CameraPose pose;
    pose.position = core::normalised({{0, 0}, {kMiddleM.x, 0, kMiddleM.y + 30}},
                                     document().world().block_size_m());
    pose.position.local.y = world::surface_height_m(document().world(), pose.position) + 30;
    pose.pitch = -0.75;
    view().camera().set_pose(pose);
    draw();
  }
  WorldView& view() { return window_->view(); }
  // A point east and south of the middle.
  static glm::dvec2 place(double east_m, double south_m) {
    return kMiddleM + glm::dvec2(east_m, south_m);
  }
  QPoint pixel(glm::dvec2 at_m) {
    const auto at = view().pixel_of(at_m);
    const QPoint pixel = at.value_or(QPointF(-1, -1)).toPoint();
    EXPECT_TRUE(QRect({}, view().size()).contains(pixel)) << at_m.x << ", " << at_m.y;
    return pixel;
  }
  void click(glm::dvec2 at_m, Qt::MouseButton button = Qt::LeftButton) {
    QTest::mouseClick(&view(), button, {}, pixel(at_m));
    draw();
  }
  void drag(glm::dvec2 from_m, glm::dvec2 to_m) {
    const QPoint from = pixel(from_m), to = pixel(to_m);
    QTest::mousePress(&view(), Qt::LeftButton, {}, from);
    for (int i = 1; i <= 4; ++i) {
      QTest::mouseMove(&view(), from + (to - from) * i / 4);
      draw(1);
    }
    QTest::mouseRelease(&view(), Qt::LeftButton, {}, to);
    draw();
  }
  void press_key(Qt::Key key) {
    QTest::keyClick(&view(), key);
    draw();
  }
  int steps() { return document().undo_stack().count(); }
  // True if two points are equal up to the size of a pixel, or the height that a tool has changed.
  static bool near(glm::dvec2 a, glm::dvec2 b) { return glm::length(a - b) < 2; }
  // Saves and reopens the file.
  void save_and_reopen() {
    const std::string text = document().text();
    command("Save");
    EXPECT_FALSE(document().is_modified());
    ASSERT_TRUE(window_->open_file(file_));
    EXPECT_EQ(document().text(), text);
  }
};

}  // namespace psygen::editor
