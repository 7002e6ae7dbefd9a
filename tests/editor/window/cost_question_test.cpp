// The cost of a change is shown, and costly edits need confirmation.
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>

#include "editor/cost/edit_cost.hpp"
#include "editor/panels/field_row.hpp"
#include "engine/scene/frame/quality.hpp"
#include "engine/world/files/text_edit.hpp"
#include "tests/editor/window/window_fixture.hpp"

namespace psygen::editor {
namespace {

const world::TextPath kScattered{"scatter", 0}, kScatteredCount{"scatter", 0, "count"};
constexpr double kMaxCount = 30;

// More than 30 trees on a block need too many bytes, independent of the speed of the machine.
class CostQuestion : public EditorWindow {
 protected:
  void adjust(MainWindowOptions& options) override {
    const auto text = world::with_value(kSmallWorld, kScatteredCount, "30");
    const auto parsed = parse_world_text(*text, "small.toml", {});
    options.limits = {.model_seconds = 1e9,
                      .block_seconds = 1e9,
                      .cache_bytes = 4 * edit_cost(**parsed, nullptr).block_bytes,
                      .blocks = 4};
  }
  QWidget& bar() { return *properties().findChild<QWidget*>("impact"); }
  bool asks() { return bar().findChild<QPushButton*>()->isVisible(); }
  QString said() { return bar().findChild<QLabel*>()->text(); }
  void click(const QString& button) {
    for (auto* found : bar().findChildren<QPushButton*>()) {
      if (found->text().remove('&') == button) {
        EXPECT_TRUE(found->isVisible());
        return QTest::mouseClick(found, Qt::LeftButton);
      }
    }
    FAIL() << button.toStdString();
  }
  double in_box() {
    return properties().row(kScatteredCount)->findChild<QDoubleSpinBox*>()->value();
  }
};

TEST_F(CostQuestion, TheImpactOfAChangeIsShown) {
  properties().go_to(kScattered);
  auto* slider = properties().row(kScatteredCount)->findChild<QSlider*>();
  slider->setSliderDown(true);
  slider->setValue(slider->value() + 4);
  slider->setSliderDown(false);
  ASSERT_TRUE(QTest::qWaitFor([&] { return said().contains("Rebuilds"); }, kMaxMs))
      << said().toStdString();
  EXPECT_FALSE(asks());
  ASSERT_TRUE(document().set_value({"sky", "exposure"}, "1.5"));
  ASSERT_TRUE(QTest::qWaitFor([&] { return said() == "Nothing to rebuild."; }, kMaxMs))
      << said().toStdString();
}

TEST_F(CostQuestion, ACostlyEditNeedsConfirmation) {
  properties().go_to(kScattered);
  const int height = bar().height();
  properties().row(kScatteredCount)->set_value("200");
  EXPECT_TRUE(asks());
  EXPECT_TRUE(said().contains("A block at full detail would take")) << said().toStdString();
  EXPECT_EQ(document().text(), kSmallWorld);
  QCoreApplication::processEvents();  // lays the panel out
  EXPECT_EQ(bar().height(), height) << "the fields keep their place";
  click("Keep the old value");
  EXPECT_FALSE(asks());
  EXPECT_EQ(in_box(), 6);
  properties().row(kScatteredCount)->set_value("200");
  click("Apply anyway");
  EXPECT_FALSE(asks());
  settle();
  EXPECT_EQ(shown().scatter[0].count, 200U);
  EXPECT_EQ(in_box(), 200);
  document().undo_stack().undo();
  EXPECT_EQ(document().text(), kSmallWorld);
}

TEST_F(CostQuestion, ADragOverCostlyValuesSynthesisesNothingForThem) {
  properties().go_to(kScattered);
  std::uint32_t most = 0;
  QObject::connect(&window_->view(), &WorldView::drawn, window_.get(),
                   [&] { most = std::max(most, shown().scatter[0].count); });
  QSlider& slider = *properties().row(kScatteredCount)->findChild<QSlider*>();
  drag(slider, slider.width());
  EXPECT_TRUE(asks());
  EXPECT_GT(in_box(), kMaxCount) << "the slider stays under the mouse";
  EXPECT_LE(document().world().scatter[0].count, kMaxCount);
  // The view has caught up with the document, so it would have shown a costly value before.
  const auto allowed = document().world().scatter[0].count;
  ASSERT_TRUE(QTest::qWaitFor([&] { return shown().scatter[0].count == allowed; }, kMaxMs));
  draw();
  EXPECT_LE(most, kMaxCount);
  click("Keep the old value");
  EXPECT_EQ(in_box(), document().world().scatter[0].count);
}

// Meshes are coarse while the slider is held, and become fine after its release.
TEST_F(CostQuestion, MeshesAreCoarseDuringADrag) {
  const world::TextPath size{"scatter", 0, "size_m"};
  properties().go_to(kScattered);
  QSlider& slider = *properties().row(size)->findChild<QSlider*>();
  double answered = 0;
  QObject::connect(&window_->view(), &WorldView::answered, window_.get(),
                   [&](double ms) { answered = ms; });
  const auto& quality = window_->view().session()->scene().quality();
  const QPoint at(slider.width() * slider.value() / slider.maximum(), slider.height() / 2);
  QTest::mousePress(&slider, Qt::LeftButton, {}, at);
  QTest::mouseMove(&slider, at - QPoint(slider.width() / 10, 0));
  ASSERT_TRUE(QTest::qWaitFor([&] { return quality.draft && answered > 0; }, kMaxMs));
  EXPECT_EQ(document().undo_stack().count(), 1);
  const int before = settled_;
  QTest::mouseRelease(&slider, Qt::LeftButton, {}, at - QPoint(slider.width() / 10, 0));
  ASSERT_TRUE(QTest::qWaitFor([&] { return !quality.draft && settled_ > before; }, kMaxMs));
}

}  // namespace
}  // namespace psygen::editor
