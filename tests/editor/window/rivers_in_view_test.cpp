// The overlay of a river network, the water under the pointer, and warnings of roads in a window.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <QDockWidget>
#include <QLabel>
#include <QPlainTextEdit>
#include <QTimer>

#include "editor/panels/cache_map.hpp"
#include "editor/panels/message_log.hpp"
#include "editor/panels/water_text.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/world/water.hpp"
#include "tests/editor/window/window_fixture.hpp"
#include "tests/engine/world/network_world.hpp"
#include "tests/engine/world/river_world.hpp"

namespace psygen::editor {
namespace {

class RiversInView : public EditorWindow {
 protected:
  std::string world_text() override { return world::testing::network_text(); }
  // Looks straight down at the middle of a river, from 60 m above it.
  void SetUp() override {
    EditorWindow::SetUp();
    const world::World& world = document().world();
    const double block_m = world.block_size_m();
    for (int i = 0; i < 400 * 400 && !river_; ++i) {
      const core::WorldPosition at =
          core::normalised({{20, 20}, {2.0 * (i % 400), 0, 2.0 * (i / 400)}}, block_m);
      if (world::water_at(world, at).discharge_m3_s.value_or(0) > 0.03) river_ = at;
    }
    ASSERT_TRUE(river_);
    core::CameraPose pose;
    pose.position = *river_;
    pose.position.local.y = world::surface_height_m(world, *river_) + 60;
    pose.pitch = -1.5;
    window_->view().camera().set_pose(pose);
    settle_at_pose();
  }
  void settle_at_pose() {
    const auto is_complete = [this] {
      const scene::Scene& scene = window_->view().session()->scene();
      return scene.meshes().outstanding() == 0 && scene.statistics().drawn.awaited == 0;
    };
    draw(10);
    ASSERT_TRUE(QTest::qWaitFor(is_complete, kMaxMs));
    draw(10);
  }
  QString messages() { return window_->findChild<MessageLog*>()->toPlainText(); }
  std::optional<core::WorldPosition> river_;
};

TEST_F(RiversInView, TheNetworkIsSwitchedOnAndOff) {
  const auto switch_on = [this] {
    command("River network");
    const auto is_there = [this] { return window_->view().rivers().map() != nullptr; };
    ASSERT_TRUE(QTest::qWaitFor(is_there, kMaxMs));
    settle_at_pose();
  };
  switch_on();
  command("River network");
  draw();
  EXPECT_EQ(window_->view().rivers().map(), nullptr);
  const image::Image plain = picture();
  switch_on();
  const image::Image on = picture();
  EXPECT_GT(difference(on, plain), 0.0005);
  EXPECT_LT(difference(on, plain), 0.2);
  command("River network");
  draw();
  EXPECT_LT(difference(picture(), plain), 0.2 * difference(on, plain));
}

QColor shown_colour(int width_px) {
  const glm::vec3 colour = river_colour(width_px);
  return QColor::fromRgbF(colour.x, colour.y, colour.z);
}

TEST_F(RiversInView, TheMapDrawsChannelsInTheColoursOfItsLegend) {
  // Two lines of each width, of different discharges.
  const auto rivers = std::make_shared<RiverMap>();
  for (int px = 1; px <= kMaxRiverPx; ++px) {
    for (const double factor : {0.4, 2.5}) {
      const double discharge_m3_s = factor * usual_discharge_m3_s(px);
      // Along the middle of a row of pixels.
      const float z_m = 10 * static_cast<float>(rivers->channels.size()) - 54.75F;
      rivers->channels.push_back({{{-90, 0, z_m}, {90, 0, z_m}},
                                  static_cast<float>(discharge_m3_s),
                                  river_width_px(discharge_m3_s)});
    }
  }
  CacheMap map;
  map.resize(400, 400);
  map.set_radius_m(100);  // 2 pixels a metre
  map.show_cells({CacheMap::Cell()}, 1.5, 0.1);
  // Also where the map moves its last picture with the camera, and where that is no longer enough.
  for (const double east_m : {0.0, 30.0, -30.0, -75.0}) {
    map.show_rivers(rivers, {rivers->corner, {east_m, 0, 0}}, 64);
    const QImage image = map.grab().toImage();
    for (std::size_t i = 2; i < rivers->channels.size(); ++i) {  // 1 pixel is translucent
      const QColor expected = shown_colour(rivers->channels[i].width_px);
      const auto differs = [&](int x_px) {
        const QColor found = image.pixelColor(x_px, 200 + 2 * (10 * static_cast<int>(i) - 55));
        return std::max({std::abs(found.red() - expected.red()),
                         std::abs(found.green() - expected.green()),
                         std::abs(found.blue() - expected.blue())});
      };
      const int left_px = 20 - static_cast<int>(2 * east_m), right_px = left_px + 360;
      EXPECT_LT(differs(std::max(left_px, 0) + 6), 30) << i << " from " << east_m;
      EXPECT_LT(differs(std::min(right_px, 400) - 6), 30) << i << " from " << east_m;
      EXPECT_TRUE(left_px < 12 || differs(left_px - 10) > 60) << i << " from " << east_m;
      EXPECT_TRUE(right_px > 388 || differs(right_px + 10) > 60) << i << " from " << east_m;
    }
  }
  command("River network");
  const auto* dock = window_->findChild<QDockWidget*>("map");
  const auto has_legend = [&] {
    return std::ranges::any_of(dock->findChildren<QLabel*>(), [](const QLabel* label) {
      for (int px = 1; px <= kMaxRiverPx; ++px) {
        if (!label->text().contains(shown_colour(px).name())) return false;
      }
      return true;
    });
  };
  EXPECT_TRUE(QTest::qWaitFor(has_legend, kMaxMs));
}

TEST_F(RiversInView, TheStatusBarTellsTheWaterUnderThePointer) {
  auto* label = window_->findChild<QLabel*>("water");
  ASSERT_NE(label, nullptr);
  EXPECT_EQ(label->text(), "");
  const auto pixel = window_->view().pixel_of(shown().metres(*river_));
  ASSERT_TRUE(pixel);
  QTest::mouseMove(&window_->view(), pixel->toPoint());
  ASSERT_TRUE(QTest::qWaitFor([&] { return !label->text().isEmpty(); }, kMaxMs));
  EXPECT_TRUE(label->text().startsWith("River: surface ")) << label->text().toStdString();
  EXPECT_TRUE(label->text().endsWith(" m³/s")) << label->text().toStdString();
}

TEST(WaterText, TellsBodyDepthAndOfRiversSpeedAndDischarge) {
  const world::World& world = world::testing::river_world();
  const auto text = [&](double x_m, double z_m) {
    return water_text(world::water_at(world, world.position({x_m, z_m}))).toStdString();
  };
  const std::string depth = ": surface [0-9]+\\.[0-9] m, [0-9]+\\.[0-9] m deep";
  EXPECT_THAT(text(2020, 1735), ::testing::MatchesRegex("River" + depth + ", .* m/s, .* m³/s"));
  EXPECT_THAT(text(1750, 1670), ::testing::MatchesRegex("Lake" + depth));
  EXPECT_THAT(text(1545, 1655), ::testing::MatchesRegex("Sea" + depth));
  EXPECT_EQ(text(2100, 1200), "") << "dry";
  world::WaterPoint water;
  water.surface_m = 812.34;
  water.depth_m = 1.26;
  water.flow_m_s = {0.3F, -0.4F};
  water.body = 7;
  const auto with = [&](std::optional<double> discharge_m3_s) {
    water.discharge_m3_s = discharge_m3_s;
    return water_text(water).toStdString();
  };
  EXPECT_EQ(with(0.0314), "River: surface 812.3 m, 1.3 m deep, 0.5 m/s, 0.031 m³/s");
  EXPECT_EQ(with(9.94), "River: surface 812.3 m, 1.3 m deep, 0.5 m/s, 9.9 m³/s");
  EXPECT_EQ(with(10.2), "River: surface 812.3 m, 1.3 m deep, 0.5 m/s, 10 m³/s");
  EXPECT_EQ(with(std::nullopt), "Lake: surface 812.3 m, 1.3 m deep");
  water.body = world::kSea;
  EXPECT_EQ(with(std::nullopt), "Sea: surface 812.3 m, 1.3 m deep");
}

TEST_F(RiversInView, ARoadThroughARiverGetsOneMessage) {
  const glm::dvec2 m = shown().metres(*river_);
  const std::string text =
      document().text() + fmt::format("\n[[road]]\npoints_m = [[{}, {}], [{}, {}], [{}, {}]]\n",
                                      m.x - 60, m.y - 50, m.x, m.y, m.x + 60, m.y + 50);
  const auto* const delay = window_->findChild<QTimer*>("warnings");
  ASSERT_NE(delay, nullptr);
  const auto set_text = [&](const std::string& next) {
    ASSERT_TRUE(document().set_text(next, "Road"));
    ASSERT_TRUE(delay->isActive());
    ASSERT_TRUE(QTest::qWaitFor([&] { return !delay->isActive(); }, kMaxMs));
  };
  EXPECT_FALSE(messages().contains("Warning"));
  set_text(text);
  const QString once = messages();
  EXPECT_TRUE(once.contains("Warning: road 1: it crosses a river of the network at "))
      << once.toStdString();
  set_text(text + "# the same\n");
  EXPECT_EQ(messages(), once) << "known warnings are not repeated";
}

}  // namespace
}  // namespace psygen::editor
