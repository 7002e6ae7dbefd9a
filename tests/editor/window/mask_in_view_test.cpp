// The tool that paints masks, with mouse and keys in the view.
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <glm/geometric.hpp>

#include "editor/tools/view_tools.hpp"
#include "engine/image/image_io.hpp"
#include "tests/editor/window/tool_fixture.hpp"

namespace psygen::editor {
namespace {

class MaskInView : public ToolInView {
 protected:
  MaskTool& mask() { return window_->findChild<ViewTools*>()->mask(); }
  double share(const world::World& world, glm::dvec2 at_m) {
    return world::mask_share(world.scatter[0].mask, world.seed, at_m);
  }
  double share(glm::dvec2 at_m) { return share(document().world(), at_m); }
  // Trees, with a mask and a small brush.
  void begin() {
    command("Paint masks");
    mask().choose(0);
    command("New mask");
    ASSERT_TRUE(mask().has_picture());
    mask().set_radius_m(5);
  }
};

TEST_F(MaskInView, IsPaintedUndoneSavedAndOpenedAgain) {
  begin();
  settle();
  press_key(Qt::Key_X);
  EXPECT_TRUE(mask().brush().erases);
  drag(place(-6, 0), place(6, 0));
  EXPECT_EQ(steps(), 2) << "the mask, and the stroke";
  EXPECT_LT(share(place(0, 0)), 0.05);
  EXPECT_EQ(share(place(0, 40)), 1);
  // The view shows the world with the stroke, although no file is written.
  ASSERT_TRUE(QTest::qWaitFor([&] { return share(shown(), place(0, 0)) < 0.05; }, kMaxMs));
  const auto file = file_.parent_path() / document().world().scatter[0].mask.image;
  EXPECT_FALSE(std::filesystem::exists(file));
  document().undo_stack().undo();
  ASSERT_TRUE(QTest::qWaitFor([&] { return share(shown(), place(0, 0)) == 1; }, kMaxMs));
  document().undo_stack().redo();
  const auto painted = document().world().scatter[0].mask.picture;
  save_and_reopen();
  EXPECT_TRUE(std::filesystem::exists(file));
  EXPECT_EQ(document().world().scatter[0].mask.picture->pixels, painted->pixels);
  ASSERT_TRUE(QTest::qWaitFor([&] { return share(shown(), place(0, 0)) < 0.05; }, kMaxMs));
}

TEST_F(MaskInView, ANewMaskHasTheAreaAndPixelsOfTheBar) {
  window_->resize(1280, 800);  // the whole toolbar is visible
  command("Paint masks");
  mask().choose(1);
  auto* bar = window_->findChild<QWidget*>("new_mask");
  ASSERT_NE(bar, nullptr);
  draw();
  ASSERT_TRUE(bar->isVisible());
  const image::Image whole = picture();
  // With the keyboard only: around the view instead of the whole world, 32 m, 0.5 m per pixel.
  QTest::keyClick(bar->findChild<QComboBox*>(), Qt::Key_Up);
  const auto numbers = bar->findChildren<QDoubleSpinBox*>();
  ASSERT_EQ(numbers.size(), 2);
  for (const auto& [number, typed] : {std::pair{numbers[0], "32"}, {numbers[1], "0.5"}}) {
    number->selectAll();
    QTest::keyClicks(number, typed);
    QTest::keyClick(number, Qt::Key_Return);
  }
  EXPECT_EQ(bar->findChildren<QLabel*>().last()->text(), "64 × 64 pixels");
  draw();
  EXPECT_GT(difference(picture(), whole), 0) << "the border where it would lie";
  command("New mask");
  EXPECT_EQ(steps(), 1);
  ASSERT_TRUE(mask().has_picture());
  draw();
  EXPECT_FALSE(bar->isVisible()) << "the brush instead";
  const world::ScatterMask& made = document().world().scatter[1].mask;
  EXPECT_EQ(made.picture->width, 64U);
  EXPECT_EQ(made.area_m[2] - made.area_m[0], 32);
  const glm::dvec2 middle(made.area_m[0] + 16, made.area_m[1] + 16);
  EXPECT_TRUE(QRect({}, view().size()).contains(view().pixel_of(middle).value().toPoint()));
  document().undo_stack().undo();
  draw();
  EXPECT_TRUE(bar->isVisible());
  numbers[0]->setValue(60'000);
  EXPECT_EQ(bar->findChildren<QLabel*>().last()->text(), "<b>too many pixels</b>");
  command("New mask");
  EXPECT_EQ(steps(), 1) << "the one that was taken back";
  EXPECT_FALSE(mask().has_picture());
}

TEST_F(MaskInView, TheBrushIsShownAndItsKeysChangeIt) {
  begin();
  const image::Image plain = picture();
  QTest::mouseMove(&view(), pixel(place(0, 0)));
  draw();
  EXPECT_GT(difference(picture(), plain), 0) << "a circle on the ground";
  press_key(Qt::Key_BracketRight);
  EXPECT_GT(mask().brush().radius_m, 5);
  press_key(Qt::Key_BracketLeft);
  press_key(Qt::Key_BracketLeft);
  EXPECT_LT(mask().brush().radius_m, 5);
  // Esc cancels the stroke, then exits the tool.
  QTest::mousePress(&view(), Qt::LeftButton, Qt::ShiftModifier, pixel(place(0, 0)));
  draw();
  EXPECT_LT(share(place(0, 0)), 0.05);
  press_key(Qt::Key_Escape);
  EXPECT_EQ(share(place(0, 0)), 1);
  QTest::mouseRelease(&view(), Qt::LeftButton, {}, pixel(place(0, 0)));
  draw();
  EXPECT_EQ(steps(), 1);
  press_key(Qt::Key_Escape);
  EXPECT_EQ(view().tool(), nullptr);
}

TEST_F(MaskInView, AWorldWithoutAFileKeepsItsStrokes) {
  command("New world");
  ASSERT_TRUE(QTest::qWaitFor([&] { return opened_ > 1; }, kMaxMs));
  command("Paint masks");
  EXPECT_EQ(mask().scatter(), 0U) << "the first one";
  command("New mask");
  ASSERT_TRUE(mask().has_picture());
  ToolPoint at;
  at.ground_m = glm::dvec2(document().world().scatter[0].mask.area_m[0] + 100,
                           document().world().scatter[0].mask.area_m[1] + 100);
  at.fine = true;
  mask().press(at);
  mask().release();
  EXPECT_EQ(steps(), 2);
  ASSERT_TRUE(QTest::qWaitFor([&] { return share(shown(), *at.ground_m) < 0.05; }, kMaxMs));
  const auto file = folder_.path() / "named.toml";
  ASSERT_TRUE(document().save_as(file));
  ASSERT_TRUE(window_->open_file(file));
  EXPECT_LT(share(*at.ground_m), 0.05);
}

}  // namespace
}  // namespace psygen::editor
