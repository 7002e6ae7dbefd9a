// Features around the view: a model alone, the grid, weather, ages in the map, playing a flight.
#include <QApplication>
#include <QClipboard>
#include <QComboBox>
#include <QDockWidget>
#include <QHelpEvent>
#include <QPushButton>
#include <QSpinBox>
#include <QToolBar>
#include <QToolButton>
#include <glm/geometric.hpp>

#include "editor/flights/timeline_panel.hpp"
#include "editor/panels/cache_map.hpp"
#include "tests/editor/window/window_fixture.hpp"

namespace psygen::editor {
namespace {

const world::TextPath kRocks{"scatter", 1};

bool same_place(const core::CameraPose& a, const core::CameraPose& b) {
  return a.position.block == b.position.block &&
         glm::length(a.position.local - b.position.local) < 1e-6 && a.yaw == b.yaw &&
         a.pitch == b.pitch;
}

TEST_F(EditorWindow, AModelAloneFollowsEditsAndSeeds) {
  const core::CameraPose before = window_->view().camera().pose();
  auto* bar = window_->findChild<QToolBar*>("model");
  ASSERT_NE(bar, nullptr);
  EXPECT_FALSE(bar->isVisible());
  properties().go_to({"sky"});
  command("Model alone");
  EXPECT_FALSE(bar->isVisible()) << "the sky has no model";
  properties().go_to(kRocks);
  command("Model alone");
  settle();
  EXPECT_TRUE(bar->isVisible());
  EXPECT_EQ(shown().name, "portrait");
  ASSERT_EQ(shown().scatter.size(), 1U);
  const image::Image rock = picture();
  ASSERT_TRUE(window_->view().camera().pivot().has_value());
  const core::WorldPosition stood = *window_->view().camera().pivot();
  bar->findChild<QSpinBox*>()->setValue(8);
  settle();
  EXPECT_EQ(shown().seed, 8U);
  EXPECT_NE(glm::length(window_->view().camera().pivot()->local - stood.local), 0);
  EXPECT_GT(difference(picture(), rock), 0);
  ASSERT_TRUE(document().set_value(kRocks.with("moss"), "1"));
  settle();
  EXPECT_EQ(shown().name, "portrait");
  // The left button orbits the model.
  const double yaw = window_->view().camera().pose().yaw;
  QTest::mousePress(&window_->view(), Qt::LeftButton, {}, {200, 200});
  QTest::mouseMove(&window_->view(), {260, 200});
  ASSERT_TRUE(QTest::qWaitFor([&] { return window_->view().camera().pose().yaw != yaw; }, kMaxMs));
  QTest::mouseRelease(&window_->view(), Qt::LeftButton, {}, {260, 200});
  command("Model alone");
  settle();
  EXPECT_FALSE(bar->isVisible());
  EXPECT_EQ(shown().name, "small");
  EXPECT_TRUE(same_place(window_->view().camera().pose(), before));
}

TEST_F(EditorWindow, AGridLiesOnTheGround) {
  const image::Image plain = picture();
  command("10 m");
  ASSERT_TRUE(QTest::qWaitFor([&] { return difference(picture(), plain) > 0; }, kMaxMs));
  EXPECT_EQ(window_->view().grid().spacing_m(), 10);
  command("Next grid");
  EXPECT_EQ(window_->view().grid().spacing_m(), 100);
  command("None");
  EXPECT_TRUE(QTest::qWaitFor([&] { return difference(picture(), plain) == 0; }, kMaxMs));
}

TEST_F(EditorWindow, TheWeatherSlidersAreFieldsOfTheSky) {
  const world::TextPath cover{"sky", "cloud_cover"};
  QSlider* clouds = nullptr;
  for (QSlider* slider : window_->findChild<QToolBar*>("picture")->findChildren<QSlider*>()) {
    if (slider->accessibleName().startsWith("Clouds")) clouds = slider;
  }
  ASSERT_NE(clouds, nullptr);
  EXPECT_EQ(clouds->value(), clouds->maximum() / 2);
  drag(*clouds, clouds->width() / 3);
  EXPECT_EQ(document().undo_stack().count(), 1);
  EXPECT_GT(document().world().sky.cloud_cover, 0.5);
  document().undo_stack().undo();
  EXPECT_EQ(clouds->value(), clouds->maximum() / 2);
}

TEST_F(EditorWindow, ASectionIsCopiedAndResetWithItsButtons) {
  properties().go_to(kRocks);
  auto* bar = properties().findChild<QWidget*>("heading");
  const auto button = [&](const QString& text) {
    for (auto* found : bar->findChildren<QToolButton*>()) {
      if (found->text() == text) return found;
    }
    return static_cast<QToolButton*>(nullptr);
  };
  EXPECT_FALSE(button("↺")->isEnabled()) << "all fields have their defaults";
  ASSERT_TRUE(document().set_value(kRocks.with("moss"), "1"));
  EXPECT_TRUE(button("↺")->isEnabled());
  button("Copy")->click();
  EXPECT_TRUE(QApplication::clipboard()->text().contains("moss = 1"));
  button("↺")->click();
  EXPECT_EQ(document().text(), kSmallWorld);
  button("Paste")->click();
  EXPECT_TRUE(document().field(kRocks.with("moss"))->is_set);
}

TEST_F(EditorWindow, TheMapShowsTheAgesOfMeshes) {
  auto* dock = window_->findChild<QDockWidget*>("map");
  auto* map = dock->findChild<CacheMap*>();
  auto* colours = dock->findChild<QComboBox*>();
  colours->setCurrentText("Age");
  Q_EMIT colours->activated(colours->currentIndex());
  // The most saturated colour behind the camera, because nodes have dark borders.
  const auto middle = [&] {
    const QImage image = map->grab().toImage();
    QColor found;
    for (int x = -5; x <= 5; ++x) {
      for (int y = 8; y <= 18; ++y) {
        const QColor colour = image.pixelColor(map->width() / 2 + x, map->height() / 2 + y);
        if (colour.saturationF() > found.saturationF()) found = colour;
      }
    }
    return found;
  };
  ASSERT_TRUE(QTest::qWaitFor([&] { return middle().saturationF() > 0.5F; }, kMaxMs / 10))
      << middle().name().toStdString() << " of a map " << map->width() << " wide, visible "
      << map->isVisible();
  const float hue = middle().hueF();
  EXPECT_TRUE(QTest::qWaitFor([&] { return middle().hueF() > hue + 0.02F; }, kMaxMs))
      << "older meshes go from red to blue";
}

TEST_F(EditorWindow, AFlightIsPlayedByAClick) {
  const auto file = folder_.path() / "path.toml";
  std::ofstream(file) << "format = 1\n[path]\nname = \"a short way\"\norigin_block = [30, 30]\n"
                         "[[point]]\ntime_s = 0\nat_m = [0, 0]\nheight_m = 5\n"
                         "[[point]]\ntime_s = 0.5\nat_m = [20, 0]\nheight_m = 5\n";
  auto* timeline = window_->findChild<TimelinePanel*>();
  auto* dock = window_->findChild<QDockWidget*>("timeline");
  dock->show();
  dock->raise();
  QPushButton* play = nullptr;
  for (QPushButton* button : timeline->findChildren<QPushButton*>()) {
    if (button->text() == "Play") play = button;
  }
  ASSERT_NE(play, nullptr);
  EXPECT_FALSE(play->isEnabled()) << "no path";
  timeline->open_path_file(file);
  ASSERT_TRUE(play->isEnabled());
  const core::CameraPose start = window_->view().camera().pose();
  int moved = 0;
  QObject::connect(&window_->view(), &WorldView::drawn, window_.get(),
                   [&] { moved += !same_place(window_->view().camera().pose(), start); });
  ASSERT_TRUE(QTest::qWaitFor([&] { return play->isVisible(); }, kMaxMs));
  QTest::mouseClick(play, Qt::LeftButton);
  EXPECT_TRUE(play->isChecked());
  ASSERT_TRUE(QTest::qWaitFor([&] { return !play->isChecked(); }, kMaxMs))
      << "playing ends at the end of the path";
  EXPECT_GT(moved, 0);
  EXPECT_EQ(play->text(), "Play");
}

}  // namespace
}  // namespace psygen::editor
