// Drags, the wheel and the colour dialog edit the fields that the user means, and no others.
#include <QtTest/qtestspontaneevent.h>

#include <QAbstractSpinBox>
#include <QApplication>
#include <QColorDialog>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QScrollBar>
#include <QSignalSpy>
#include <QUndoStack>
#include <QWheelEvent>

#include "editor/panels/field_row.hpp"
#include "tests/editor/window/oak_fixture.hpp"

namespace psygen::editor {
namespace {

const world::TextPath kSky{"sky"}, kAzimuth{"sky", "sun_azimuth_deg"}, kExposure{"sky", "exposure"};
const world::TextPath kTrees{"scatter", 0}, kCount{"scatter", 0, "count"};

// Once the slider has its place in the window.
QPoint handle_of(const QSlider& slider) {
  QCoreApplication::processEvents();
  const int x = slider.width() * slider.value() / std::max(slider.maximum(), 1);
  return {std::clamp(x, 6, slider.width() - 8), slider.height() / 2};
}

// Turns the wheel over a widget by one notch, towards the user, as the window system reports it.
void turn_wheel(QWidget& widget) {
  const QPointF at = widget.rect().center();
  QWheelEvent event(at, widget.mapToGlobal(at), {}, {0, -120}, Qt::NoButton, Qt::NoModifier,
                    Qt::NoScrollPhase, false);
  QSpontaneKeyEvent::setSpontaneous(&event);
  qApp->notify(&widget, &event);
}

TEST_F(EditorWindow, ASelectionThatIsFoundAgainLeavesADragAlone) {
  const QSize size = window_->view().size();
  QTest::mouseClick(&window_->view(), Qt::LeftButton, {},
                    QPoint(size.width() / 2, size.height() - 5));
  ASSERT_TRUE(QTest::qWaitFor([&] { return window_->view().selection().has_value(); }, kMaxMs));
  properties().go_to(kSky);
  auto* azimuth = properties().row(kAzimuth)->findChild<QSlider*>();
  const QPoint at = handle_of(*azimuth);
  QTest::mousePress(azimuth, Qt::LeftButton, {}, at);
  for (int step = 1; step <= 3; ++step) {
    QSignalSpy found_again(&window_->view(), &WorldView::selected);
    QTest::mouseMove(azimuth, at + QPoint(8 * step, 0));
    ASSERT_TRUE(QTest::qWaitFor([&] { return !found_again.isEmpty(); }, kMaxMs));
    EXPECT_EQ(properties().section(), kSky);
  }
  QTest::mouseRelease(azimuth, Qt::LeftButton, {}, at + QPoint(24, 0));
  EXPECT_EQ(document().undo_stack().count(), 1);
  drag(*properties().row(kExposure)->findChild<QSlider*>(), 20);
  EXPECT_EQ(document().undo_stack().count(), 2);
}

TEST_F(EditorWindow, ADragEndsWhenItsRowDisappears) {
  properties().go_to(kTrees);
  auto* count = properties().row(kCount)->findChild<QSlider*>();
  const QPoint at = handle_of(*count);
  QTest::mousePress(count, Qt::LeftButton, {}, at);
  QTest::mouseMove(count, at + QPoint(5, 0));
  ASSERT_TRUE(QTest::qWaitFor([&] { return document().undo_stack().count() == 1; }, kMaxMs / 10));
  properties().go_to(kSky);
  EXPECT_TRUE(document().set_value(kExposure, "2"));
  EXPECT_TRUE(document().set_value(kExposure, "3"));
  EXPECT_EQ(document().undo_stack().count(), 3);
  QTest::mouseRelease(window_.get(), Qt::LeftButton);
}

TEST_F(EditorWindow, TheWheelChangesOnlyAFocusedControl) {
  window_->activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(window_.get(), kMaxMs));
  auto* search = properties().findChild<QLineEdit*>();
  const auto value_of = [](const QWidget* widget) {
    const auto* slider = qobject_cast<const QAbstractSlider*>(widget);
    const auto* box = qobject_cast<const QAbstractSpinBox*>(widget);
    const auto* choice = qobject_cast<const QComboBox*>(widget);
    return slider ? QString::number(slider->value())
           : box  ? box->text()
                  : QString::number(choice->currentIndex());
  };
  int sliders = 0, boxes = 0, choices = 0;
  for (const world::TextPath& section : {kSky, kTrees}) {
    properties().go_to(section);
    QCoreApplication::processEvents();
    for (QWidget* widget : window_->findChildren<QWidget*>()) {
      const bool is_slider = qobject_cast<QSlider*>(widget) != nullptr;
      const bool is_box = qobject_cast<QAbstractSpinBox*>(widget) != nullptr;
      const bool is_choice = qobject_cast<QComboBox*>(widget) != nullptr;
      if (!(is_slider || is_box || is_choice) || !widget->isVisible()) continue;
      sliders += is_slider, boxes += is_box, choices += is_choice;
      search->setFocus();
      const QString before = value_of(widget);
      turn_wheel(*widget);
      const std::string name = widget->accessibleName().toStdString();
      EXPECT_EQ(value_of(widget), before) << name;
      EXPECT_TRUE(search->hasFocus()) << name;
    }
  }
  EXPECT_TRUE(sliders > 5 && boxes > 5 && choices > 1) << sliders << ' ' << boxes << ' ' << choices;
  EXPECT_EQ(document().text(), kSmallWorld);
  // The panel scrolls instead.
  properties().go_to(kSky);
  QCoreApplication::processEvents();
  QScrollBar* bar = properties().findChild<QScrollArea*>()->verticalScrollBar();
  auto* box = properties().row(kAzimuth)->findChild<QDoubleSpinBox*>();
  ASSERT_GT(bar->maximum(), 0);
  turn_wheel(*box);
  EXPECT_GT(bar->value(), 0);
  box->setFocus();
  turn_wheel(*box);
  EXPECT_EQ(document().undo_stack().count(), 1);
}

class ColourInWindow : public OakInWindow {
 protected:
  // Opens the dialog of a colour.
  QColorDialog* dialog_of(const world::TextPath& colour) {
    properties().go_to(colour.parent());
    FieldRow* row = properties().row(colour);
    row->findChild<QPushButton*>()->click();
    return row->findChild<QColorDialog*>();
  }
};

TEST_F(ColourInWindow, CancelRestoresTheDocument) {
  const std::string before = document().text();
  const int steps = document().undo_stack().count();
  // One that the text sets, and one that it does not.
  for (const world::TextPath& colour :
       {world::TextPath{"species", 0, "colours", "bark"}, world::TextPath{"sky", "haze_colour"}}) {
    QColorDialog* dialog = dialog_of(colour);
    ASSERT_NE(dialog, nullptr);
    dialog->setCurrentColor(Qt::red);
    dialog->setCurrentColor(Qt::blue);
    EXPECT_NE(document().text(), before);
    dialog->reject();
    EXPECT_EQ(document().text(), before);
    EXPECT_EQ(document().undo_stack().count(), steps);
  }
  QColorDialog* dialog = dialog_of({"sky", "haze_colour"});
  dialog->setCurrentColor(Qt::red);
  dialog->setCurrentColor(Qt::blue);
  properties().go_to(kTrees);  // closes it
  EXPECT_EQ(document().undo_stack().count(), steps + 1);
  EXPECT_TRUE(document().set_value(kExposure, "2"));
  EXPECT_TRUE(document().set_value(kExposure, "3"));
  EXPECT_EQ(document().undo_stack().count(), steps + 3);
}

// 0.25 of linear albedo is 0.537 on the display.
TEST_F(ColourInWindow, ASpeciesShowsItsColoursAsTheyRender) {
  const world::TextPath bark{"species", 0, "colours", "bark"};
  ASSERT_TRUE(document().set_value(bark, "[0.5, 0.5, 0.5]"));
  QColorDialog* dialog = dialog_of(bark);
  ASSERT_NE(dialog, nullptr);
  EXPECT_EQ(dialog->currentColor().name(), "#898989");
  EXPECT_TRUE(properties().row(bark)->findChild<QPushButton*>()->styleSheet().contains("#898989"));
  dialog->setCurrentColor(QColor("#bcbcbc"));
  dialog->accept();
  for (const double part : document().field(bark)->numbers)
    EXPECT_NEAR(part, std::sqrt(0.5029), 0.001);
}

// The dialog shows the hue of a radiance above 1, and keeps its strength.
TEST_F(ColourInWindow, ABrightSunKeepsItsStrength) {
  const world::TextPath sun{"sky", "sun_colour"};
  ASSERT_TRUE(document().set_value(sun, "[4.0, 1.0, 0.0]"));
  QColorDialog* dialog = dialog_of(sun);
  ASSERT_NE(dialog, nullptr);
  EXPECT_EQ(dialog->currentColor().name(), "#ff8900");
  dialog->setCurrentColor(QColor("#ff8901"));
  dialog->accept();
  EXPECT_NEAR(document().field(sun)->numbers[0], 4, 0.01);
  EXPECT_NEAR(document().field(sun)->numbers[1], 1, 0.01);
}

}  // namespace
}  // namespace psygen::editor
