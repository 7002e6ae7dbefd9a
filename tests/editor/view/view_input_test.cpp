// Events of Qt as input of the camera and as events of a tool.
#include "editor/view/view_input.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QMouseEvent>

namespace psygen::editor {
namespace {

using platform::MouseButton;
using ::testing::ElementsAre;

class ViewInputEvents : public ::testing::Test {
 protected:
  void send(QEvent::Type type, Qt::MouseButton button, bool has_tool) {
    const QMouseEvent event(type, kAt, kAt, button, button, {});
    input_.take(event, 1, has_tool);
  }
  // A window gets the second press twice, unlike a widget.
  void double_click(Qt::MouseButton button, bool has_tool) {
    for (const QEvent::Type type :
         {QEvent::MouseButtonPress, QEvent::MouseButtonRelease, QEvent::MouseButtonPress,
          QEvent::MouseButtonDblClick, QEvent::MouseButtonRelease})
      send(type, button, has_tool);
  }
  std::vector<ToolEvent::Kind> kinds() {
    std::vector<ToolEvent::Kind> found;
    for (const ToolEvent& event : input_.take_tool_events())
      found.push_back(event.kind);
    return found;
  }

  static constexpr QPointF kAt{40, 30};
  ViewInput input_;
};

TEST_F(ViewInputEvents, ADoubleClickIsTwoClicksOfATool) {
  using Kind = ToolEvent::Kind;
  double_click(Qt::LeftButton, true);
  EXPECT_THAT(kinds(), ElementsAre(Kind::kPress, Kind::kRelease, Kind::kPress, Kind::kRelease));
  double_click(Qt::RightButton, true);
  EXPECT_THAT(kinds(), ElementsAre(Kind::kClickRight, Kind::kClickRight));
  EXPECT_FALSE(input_.busy());
  EXPECT_FALSE(input_.take_click());
}

TEST_F(ViewInputEvents, ADoubleClickWithoutAToolSelects) {
  double_click(Qt::LeftButton, false);
  EXPECT_THAT(kinds(), ElementsAre());
  EXPECT_EQ(input_.take_click(), kAt);
  EXPECT_FALSE(input_.take_click());
}

TEST_F(ViewInputEvents, ToolsLeaveDragsOfTheRightButtonToTheCamera) {
  send(QEvent::MouseButtonPress, Qt::RightButton, true);
  EXPECT_TRUE(input_.take_frame().is_held(MouseButton::kRight));
  EXPECT_TRUE(input_.busy());
  input_.release_all();
  EXPECT_FALSE(input_.busy());
}

}  // namespace
}  // namespace psygen::editor
