// The editor's window, used like by a user.
#include <QAbstractButton>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QSlider>
#include <QUndoStack>

#include "editor/panels/field_row.hpp"
#include "tests/editor/window/window_fixture.hpp"
#include "tests/file_content.hpp"

namespace psygen::editor {
namespace {

const world::TextPath kTrees{"scatter", 0}, kCount{"scatter", 0, "count"};

TEST_F(EditorWindow, ADraggedSliderChangesTheImageInOneUndoStep) {
  const image::Image before = picture();
  properties().go_to(kTrees);
  FieldRow* row = properties().row(kCount);
  ASSERT_NE(row, nullptr);
  drag(*row->findChild<QSlider*>(), 40);
  EXPECT_EQ(document().undo_stack().count(), 1);
  EXPECT_GT(document().field(kCount)->numbers[0], 6);
  settle();
  const double changed = difference(picture(), before);
  EXPECT_GT(changed, 0);
  document().undo_stack().undo();
  settle();
  // Levels of detail depend on the previous ones, so a few pixels differ.
  EXPECT_LT(difference(picture(), before), changed / 4);
  EXPECT_EQ(document().text(), kSmallWorld);
  EXPECT_EQ(row->findChild<QDoubleSpinBox*>()->value(), 6);
}

TEST_F(EditorWindow, ASavedWorldOpensAsTheSameWorld) {
  ASSERT_TRUE(document().set_value(kCount, "9"));
  EXPECT_TRUE(window_->isWindowModified());
  ASSERT_TRUE(document().save());
  EXPECT_FALSE(window_->isWindowModified());
  EXPECT_NE(file_content(file_).find("count = 9"), std::string::npos);
  EXPECT_NE(file_content(file_).find("# the paper's"), std::string::npos);
  settle();
  const world::World saved = shown();
  const int opened = opened_;
  ASSERT_TRUE(window_->open_file(file_));
  ASSERT_TRUE(QTest::qWaitFor([&] { return opened_ > opened; }, kMaxMs));
  settle();
  EXPECT_EQ(shown(), saved);
  EXPECT_EQ(shown().scatter[0].count, 9u);
  EXPECT_FALSE(window_->isWindowModified());
}

TEST_F(EditorWindow, AnInvalidValueChangesNothing) {
  properties().go_to(kTrees);
  properties().row(kCount)->set_value("100000");
  EXPECT_EQ(document().text(), kSmallWorld);
  EXPECT_EQ(document().undo_stack().count(), 0);
  EXPECT_EQ(properties().row(kCount)->findChild<QDoubleSpinBox*>()->value(), 6);
}

TEST_F(EditorWindow, ASeedCanBeSteppedAndLocked) {
  const world::TextPath seed{"world", "seed"};
  properties().go_to({"world"});
  FieldRow* row = properties().row(seed);
  ASSERT_NE(row, nullptr);
  const auto click = [row](const QString& name) {
    for (auto* found : row->findChildren<QAbstractButton*>()) {
      if (found->text() == name) return found->click();
    }
    FAIL() << name.toStdString();
  };
  click("+");
  EXPECT_EQ(document().field(seed)->plain, "6");
  click("−");
  EXPECT_EQ(document().field(seed)->plain, "5");
  row->set_locked(true);
  EXPECT_TRUE(document().locks().is_locked(seed));
  click("⚄");
  EXPECT_EQ(document().field(seed)->plain, "5");
  // New controls show the lock.
  properties().go_to(kTrees);
  properties().go_to({"world"});
  EXPECT_TRUE(properties().row(seed)->is_locked());
  properties().row(seed)->set_locked(false);
  properties().row(seed)->randomise();
  EXPECT_NE(document().field(seed)->plain, "5");
}

TEST_F(EditorWindow, ASectionIsMovedInItsListAndStaysChosen) {
  properties().go_to(kTrees);
  command("Move this section up");
  EXPECT_EQ(document().undo_stack().count(), 0) << "already the first";
  command("Move this section down");
  EXPECT_EQ(document().undo_stack().count(), 1);
  EXPECT_EQ(document().field({"scatter", 1, "count"})->numbers[0], 6);
  EXPECT_EQ(properties().section(), (world::TextPath{"scatter", 1}));
  command("Move this section down");
  EXPECT_EQ(document().undo_stack().count(), 1) << "already the last";
  document().undo_stack().undo();
  EXPECT_EQ(document().text(), kSmallWorld);
}

// The choice of a scatter's model, which may lack parameters of the previous one.
TEST_F(EditorWindow, AScatterGetsAnotherModel) {
  properties().go_to(kTrees);
  FieldRow* row = properties().row(kTrees.with("model"));
  ASSERT_NE(row, nullptr);
  auto* models = row->findChild<QComboBox*>();
  models->setCurrentText("rock");
  Q_EMIT models->textActivated("rock");
  EXPECT_EQ(document().undo_stack().count(), 1);
  EXPECT_EQ(document().field(kTrees.with("model"))->plain, "rock");
  EXPECT_EQ(document().text().find("size_m"), std::string::npos);
}

// The view passes unused keys to the window while it has the focus.
TEST_F(EditorWindow, ShortcutsWorkWhileTheViewHasTheKeyboard) {
  ASSERT_TRUE(document().set_value(kCount, "9"));
  window_->view().requestActivate();
  ASSERT_TRUE(QTest::qWaitFor([&] { return window_->view().isActive(); }, kMaxMs));
  QTest::keyClick(&window_->view(), Qt::Key_Z, Qt::ControlModifier);
  EXPECT_TRUE(QTest::qWaitFor([&] { return document().text() == kSmallWorld; }, kMaxMs / 10));
}

TEST_F(EditorWindow, AClickSelectsTheObjectUnderThePointer) {
  const QSize size = window_->view().size();
  QTest::mouseClick(&window_->view(), Qt::LeftButton, {},
                    QPoint(size.width() / 2, size.height() - 5));
  ASSERT_TRUE(QTest::qWaitFor([&] { return window_->view().selection().has_value(); }, kMaxMs));
  EXPECT_LT(window_->view().selection()->distance_m, 300);
  const bool is_ground = window_->view().selection()->kind == query::HitKind::kGround;
  EXPECT_EQ(properties().section().steps[0].key, is_ground ? "terrain" : "scatter");
}

TEST_F(EditorWindow, KeysFlyTheCamera) {
  const core::CameraPose before = window_->view().camera().pose();
  QTest::keyPress(&window_->view(), Qt::Key_W);
  ASSERT_TRUE(QTest::qWaitFor(
      [&] { return window_->view().camera().pose().position.local.z != before.position.local.z; },
      kMaxMs));
  QTest::keyRelease(&window_->view(), Qt::Key_W);
}

TEST_F(EditorWindow, ResizingHidingAndEditingAtTheSameTimeHarmsNothing) {
  for (int i = 0; i < 12; ++i) {
    window_->resize(700 + 30 * (i % 5), 500 + 20 * (i % 3));
    ASSERT_TRUE(document().set_value(kCount, std::to_string(4 + i)));
    draw(1);
    if (i % 4 == 3) {
      window_->hide();
      ASSERT_TRUE(QTest::qWaitFor([&] { return !window_->view().isExposed(); }, kMaxMs));
      window_->show();
    }
  }
  ASSERT_TRUE(QTest::qWaitFor([&] { return window_->view().isExposed(); }, kMaxMs));
  ASSERT_TRUE(document().set_value(kCount, "6"));
  ASSERT_TRUE(QTest::qWaitFor([&] { return shown().scatter[0].count == 6; }, kMaxMs));
  // Deletes the window during synthesis.
  ASSERT_TRUE(document().set_value(kCount, "40"));
  ASSERT_TRUE(QTest::qWaitFor([&] { return shown().scatter[0].count == 40; }, kMaxMs));
  window_.reset();
}

TEST_F(EditorWindow, DeletingTheWindowWhileAThreadPreparesAWorldHarmsNothing) {
  ASSERT_TRUE(document().set_value(kCount, "30"));
  QCoreApplication::processEvents();  // starts the thread
  window_.reset();
}

}  // namespace
}  // namespace psygen::editor
