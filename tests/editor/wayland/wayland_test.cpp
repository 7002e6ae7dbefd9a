// The editor's window on a Wayland compositor. Built if Qt's private headers are present.
#include <QProcess>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/editor/wayland/display.hpp"
#include "tests/editor/window/window_fixture.hpp"

namespace psygen::editor {
namespace {

class EditorOnWayland : public EditorWindow {
 protected:
  void SetUp() override {
    ASSERT_EQ(QGuiApplication::platformName(), "wayland");
    EditorWindow::SetUp();
  }
  void TearDown() override {
    run("sway output HEADLESS-1 resolution 1280x800 scale 1");
    EditorWindow::TearDown();
  }
  void point_at_the_view() {
    const QPoint middle = view().mapToGlobal(QPoint(view().width() / 2, view().height() / 2));
    run("move " + std::to_string(middle.x()) + " " + std::to_string(middle.y()));
  }
  // Clicks into the view and holds the key W until the camera has moved.
  void fly() {
    point_at_the_view();
    run("button 272 1");
    run("button 272 0");
    const glm::dvec3 before = camera_m();
    run("key 17 1");
    EXPECT_TRUE(QTest::qWaitFor([&] { return glm::length(camera_m() - before) > 0.1; }, kMaxMs));
  }
  glm::dvec3 camera_m() { return view().camera().pose().position.local; }
  void open_again() {
    window_.reset();
    opened_ = settled_ = 0;
    EditorWindow::SetUp();
  }
  void run(const std::string& command) { ASSERT_TRUE(display().run(command)) << command; }
  WorldView& view() { return window_->view(); }
  core::Extent size() { return view().session()->picture_size(); }
  // The compositor's output.
  QImage output() {
    const std::string file = (folder_.path() / "output.png").string();
    EXPECT_EQ(QProcess::execute("grim", {QString::fromStdString(file)}), 0) << "tests need grim";
    return QImage(QString::fromStdString(file)).convertToFormat(QImage::Format_RGBA8888);
  }
  // The part of the output that shows the view, as the session's images.
  image::Image shown_view() {
    const QPoint at = view().mapToGlobal(QPoint(0, 0));
    const QImage part = output().copy(QRect(at, view().size()));
    image::Image shown{.width = static_cast<std::uint32_t>(part.width()),
                       .height = static_cast<std::uint32_t>(part.height()),
                       .rgba = {}};
    for (int y = 0; y < part.height(); ++y)
      shown.rgba.insert(shown.rgba.end(), part.constScanLine(y),
                        part.constScanLine(y) + part.width() * 4);
    return shown;
  }
};

TEST_F(EditorOnWayland, ShowsTheViewAtItsPlaceInTheWindow) {
  draw();
  const image::Image expected = picture();
  const image::Image shown = shown_view();
  ASSERT_EQ(shown.rgba.size(), expected.rgba.size());
  EXPECT_LT(difference(shown, expected), 0.01);
}

TEST_F(EditorOnWayland, DrawsAllPixelsOfAScaledOutput) {
  for (const double scale : {1.5, 2.0}) {
    run("sway output HEADLESS-1 scale " + std::to_string(scale));
    open_again();
    ASSERT_FALSE(HasFatalFailure());
    // Qt before 6.5 knows whole scales only, and the compositor reduces the image.
    const double drawn = view().devicePixelRatio();
    EXPECT_TRUE(drawn == scale || drawn == std::ceil(scale)) << drawn;
    EXPECT_TRUE(QTest::qWaitFor(
        [&] {
          const QSizeF wanted = QSizeF(view().size()) * drawn;
          return std::abs(size().width - wanted.width()) < 1 &&
                 std::abs(size().height - wanted.height()) < 1;
        },
        kMaxMs))
        << scale << ' ' << size().width << ' ' << size().height;
  }
}

TEST_F(EditorOnWayland, FollowsTheSizeOfItsOutput) {
  const core::Extent before = size();
  run("sway output HEADLESS-1 resolution 1600x1000");
  EXPECT_TRUE(QTest::qWaitFor([&] { return size().width >= before.width + 200; }, kMaxMs));
  draw();
  EXPECT_LT(difference(shown_view(), picture()), 0.01);
  run("sway output HEADLESS-1 resolution 1280x800");
  EXPECT_TRUE(QTest::qWaitFor([&] { return size() == before; }, kMaxMs));
}

TEST_F(EditorOnWayland, TheKeyboardFliesAfterAClickIntoTheView) {
  fly();
  run("key 17 0");
  EXPECT_EQ(document().undo_stack().count(), 0);
}

TEST_F(EditorOnWayland, ReleasesHeldKeysWhenAnotherWorkspaceIsShown) {
  fly();
  run("sway workspace 2");
  ASSERT_TRUE(QTest::qWaitFor([&] { return QGuiApplication::focusWindow() == nullptr; }, kMaxMs));
  run("key 17 0");
  run("sway workspace 1");
  ASSERT_TRUE(QTest::qWaitFor([&] { return QGuiApplication::focusWindow() != nullptr; }, kMaxMs));
  draw(30);
  const glm::dvec3 rests = camera_m();
  draw();
  EXPECT_LT(glm::length(camera_m() - rests), 0.01);
}

TEST_F(EditorOnWayland, TheRightButtonTurnsTheView) {
  point_at_the_view();
  const double yaw = view().camera().pose().yaw;
  run("button 273 1");
  run("by 60 0");
  EXPECT_TRUE(QTest::qWaitFor([&] { return view().camera().pose().yaw != yaw; }, kMaxMs));
  run("button 273 0");
}

// Qt destroys the surface of a hidden window: drawing into it would end the connection.
TEST_F(EditorOnWayland, DrawsNothingIntoAHiddenWindow) {
  const int before = opened_;
  window_->hide();
  EXPECT_EQ(view().session(), nullptr);
  view().show_world(kSmallWorld, file_.string(), true);  // Qt still calls the view exposed
  EXPECT_TRUE(QTest::qWaitFor([&] { return !view().isExposed(); }, kMaxMs));
  EXPECT_EQ(view().session(), nullptr);
  EXPECT_EQ(opened_, before) << "it has tried to open a session";
}

}  // namespace
}  // namespace psygen::editor
