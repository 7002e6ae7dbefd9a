// An editor's window with a small world, and functions that wait for it.
#pragma once

#include <gtest/gtest.h>

#include <QAction>
#include <QSlider>
#include <QTest>
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <memory>

#include "editor/panels/properties_panel.hpp"
#include "editor/shell/main_window.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/scene.hpp"
#include "engine/world/world.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::editor {

inline constexpr const char* kSmallWorld = R"(# a world for tests
format = 1

[world]
name = "small"
seed = 5
blocks = [64, 64]
block_vertices = 32

[[scatter]]
model = "tree"   # the paper's
count = 6
size_m = [1.5, 2.5]

[[scatter]]
model = "rock"
count = 5
)";

// The fraction of pixels with a visible difference.
inline double difference(const image::Image& a, const image::Image& b) {
  EXPECT_EQ(a.rgba.size(), b.rgba.size());
  std::size_t differing = 0;
  for (std::size_t i = 0; i + 3 < a.rgba.size(); i += 4) {
    int most = 0;
    for (std::size_t c = 0; c < 3; ++c)
      most = std::max(most, std::abs(int{a.rgba[i + c]} - int{b.rgba[i + c]}));
    differing += most > 12;
  }
  return static_cast<double>(differing) / (static_cast<double>(a.rgba.size()) / 4);
}

// Drags the handle of a slider to the right, and delivers each move.
inline void drag(QSlider& slider, int by_px) {
  QPoint at(slider.width() * slider.value() / std::max(slider.maximum(), 1), slider.height() / 2);
  at.setX(std::clamp(at.x(), 6, slider.width() - 8));
  QTest::mousePress(&slider, Qt::LeftButton, {}, at);
  for (int i = 1; i <= 8; ++i) {
    QTest::mouseMove(&slider, at + QPoint(by_px * i / 8, 0));
    QCoreApplication::processEvents();
  }
  QTest::mouseRelease(&slider, Qt::LeftButton, {}, at + QPoint(by_px, 0));
}

class EditorWindow : public testing::Test {
 protected:
  static constexpr int kMaxMs = 120'000;  // only so that a hanging test ends

  void SetUp() override {
    file_ = folder_.path() / "small.toml";
    std::ofstream(file_) << world_text();
    MainWindowOptions options;
    options.session.preset = render::Preset::kLow;
    options.session.target_hz = 0;
    options.session.validation = true;
    options.session.scene.view_distance_m = 300;
    options.session.scene.watchdog_seconds = 1e6;  // no modeler hangs, however busy the machine is
    options.session.scene.fade_seconds = 0;
    options.session.scene.budget_bytes = 64ull << 20;
    options.document.state_folder = folder_.path() / "state";
    adjust(options);
    window_ = std::make_unique<MainWindow>(std::move(options));
    window_->resize(900, 640);
    QObject::connect(&window_->view(), &WorldView::settled, window_.get(), [this] { ++settled_; });
    QObject::connect(&window_->view(), &WorldView::opened, window_.get(),
                     [this](const QString& error) {
                       EXPECT_TRUE(error.isEmpty()) << error.toStdString();
                       ++opened_;
                       // Stops the clock, so that images are comparable.
                       if (window_->view().session() != nullptr)
                         window_->view().session()->set_paused(true);
                     });
    window_->show();
    ASSERT_TRUE(window_->open_file(file_));
    ASSERT_TRUE(QTest::qWaitFor([this] { return opened_ > 0 && settled_ > 0; }, kMaxMs));
  }
  void TearDown() override {
    if (window_ && window_->view().session() != nullptr) {
      for (const std::string& message : window_->view().session()->renderer().validation_messages())
        ADD_FAILURE() << message;
    }
    window_.reset();
  }

  virtual void adjust(MainWindowOptions&) {}
  virtual std::string world_text() { return kSmallWorld; }
  // Triggers a command of the menus by its text without “&”.
  void command(const QString& name) {
    for (QAction* action : window_->findChildren<QAction*>()) {
      if (action->text().remove('&') == name) return action->trigger();
    }
    FAIL() << name.toStdString();
  }

  Document& document() { return window_->document(); }
  PropertiesPanel& properties() { return *window_->findChild<PropertiesPanel*>(); }
  // Waits until the view shows a change with all its meshes.
  void settle() {
    const int before = settled_;
    ASSERT_TRUE(QTest::qWaitFor([&] { return settled_ > before; }, kMaxMs));
  }
  // Waits until the view has drawn this many more frames: the last action is in them.
  void draw(int frames = 3) {
    int drawn = 0;
    QObject counter;  // ends the connection
    QObject::connect(&window_->view(), &WorldView::drawn, &counter, [&] { ++drawn; });
    ASSERT_TRUE(QTest::qWaitFor([&] { return drawn >= frames; }, kMaxMs));
  }
  image::Image picture() { return window_->view().session()->picture().value(); }

  // The world that the view shows.
  const world::World& shown() { return window_->view().session()->scene().world(); }

  TemporaryFolder folder_;
  std::filesystem::path file_;
  std::unique_ptr<MainWindow> window_;
  int opened_ = 0, settled_ = 0;
};

}  // namespace psygen::editor
