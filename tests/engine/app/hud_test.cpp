#include "engine/app/hud.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "engine/render/preset.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/telemetry/frame_log.hpp"
#include "engine/world/world.hpp"
#include "tests/engine/scene/fixture.hpp"
#include "tests/source_file.hpp"

namespace psygen::app {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using Subject = Hud::Subject;

// Text of all panels at an anchor, one line each.
std::string text(const std::vector<render::TextPanel>& panels, render::Anchor anchor) {
  std::string text;
  for (const render::TextPanel& panel : panels) {
    if (panel.anchor != anchor) continue;
    for (const render::TextLine& line : panel.lines)
      text += line.text + "\n";
  }
  return text;
}

class HudTest : public ::testing::Test {
 protected:
  HudTest() : scene_(scene::make_scene(scene::small_settings())) {
    scene_->settle(scene::pose_at(256, 256));
    scene::tick_at(*scene_, scene::pose_at(256, 256));
    facts_.record = scene_->record();
    facts_.device.name = "a device";
    facts_.device.wireframe = true;
    facts_.preset = render::Preset::kHigh;
    facts_.key_speed_m_s = 12.5;
  }
  std::string figures() { return text(panels(0), render::Anchor::kTopLeft); }
  std::string notices(double now_s) { return text(panels(now_s), render::Anchor::kBottom); }
  std::vector<render::TextPanel> panels(double now_s) {
    return hud_.panels(*scene_, facts_, now_s);
  }

  std::unique_ptr<scene::Scene> scene_;
  HudFacts facts_;
  Hud hud_;
};

TEST_F(HudTest, ShowsTheMedianAfterTheFirstFrame) {
  EXPECT_THAT(figures(), IsEmpty());
  for (const double ms : {10.0, 50.0, 20.0})
    hud_.add_frame(ms);
  EXPECT_THAT(figures(), HasSubstr("50.0 fps"));
  EXPECT_THAT(figures(), HasSubstr("50.0 ms worst"));
}

TEST_F(HudTest, ShowsWaitingAndGpuTimesIfKnown) {
  hud_.add_frame(20);
  facts_.record.device_wait_ms = 12;
  facts_.record.present_ms = 0.5;
  EXPECT_THAT(figures(), HasSubstr("waits 12.5 ms\n"));
  scene::state_of(*scene_).draws.frame.gpu = render::GpuTime{1, 0, 17.25, 0};
  EXPECT_THAT(figures(), HasSubstr("waits 12.5 ms   device 17.2 ms"));
}

TEST_F(HudTest, ShowsSpeedPresetAndError) {
  hud_.add_frame(20);
  EXPECT_THAT(figures(), HasSubstr("preset high"));
  EXPECT_THAT(figures(), HasSubstr("error 4.0 pixels"));
  EXPECT_THAT(figures(), HasSubstr("speed 0.0 m/s   keys fly at 12.5 m/s"));
  core::CameraPose pose = scene::pose_at(256, 256);
  for (int i = 0; i < 120; ++i) {  // at 60 Hz
    pose.position.local.x += 0.5;
    scene::tick_at(*scene_, pose);
  }
  EXPECT_THAT(figures(), HasSubstr("speed 30.0 m/s"));
}

TEST_F(HudTest, ShowsTheHeightOverTheGround) {
  hud_.add_frame(20);
  core::CameraPose pose = scene::pose_at(256, 256);
  pose.position.local.y = models::ground_height_m(scene_->world().terrain, pose.position.block,
                                                  pose.position.local.x, pose.position.local.z) +
                          1.7;
  scene::tick_at(*scene_, pose);
  EXPECT_THAT(figures(), HasSubstr("1.7 m over ground"));
}

TEST_F(HudTest, CyclesFromStatisticsToHelpToNothing) {
  hud_.add_frame(20);
  EXPECT_THAT(figures(), HasSubstr("fps"));
  EXPECT_THAT(figures(), HasSubstr("F1 help"));
  hud_.next_page();
  EXPECT_THAT(figures(), Not(HasSubstr("fps")));
  for (const KeyHelp& key : kKeyHelp) {
    EXPECT_THAT(figures(), HasSubstr(std::string(key.keys)));
    EXPECT_THAT(figures(), HasSubstr(std::string(key.meaning)));
  }
  hud_.next_page();
  EXPECT_THAT(figures(), IsEmpty());
  hud_.next_page();
  EXPECT_THAT(figures(), HasSubstr("fps"));
}

TEST_F(HudTest, FitsNextToALegendInASmallWindow) {
  constexpr std::size_t kColumns = 86, kRows = 22;  // of 640 x 360
  hud_.add_frame(20);
  scene_->input().view = render::View::kCache;
  for (int page = 0; page < 3; ++page, hud_.next_page()) {
    std::size_t widths = 0;
    for (const render::TextPanel& panel : panels(0)) {
      EXPECT_LE(panel.lines.size(), kRows);
      std::size_t widest = 0;
      for (const render::TextLine& line : panel.lines)
        widest = std::max(widest, line.text.size() + 5);  // with its margins, or a swatch
      widths += widest;
    }
    EXPECT_LE(widths, kColumns);
  }
}

TEST_F(HudTest, ShowsTheLegendOfTheViewOnEveryPage) {
  hud_.add_frame(20);
  EXPECT_THAT(text(panels(0), render::Anchor::kTopRight), IsEmpty());
  scene_->input().view = render::View::kMissing;
  for (int page = 0; page < 3; ++page, hud_.next_page())
    EXPECT_THAT(text(panels(0), render::Anchor::kTopRight), HasSubstr("view: missing"));
}

TEST_F(HudTest, ANoticeDisappearsAfterItsTime) {
  hud_.notify(Subject::kPicture, "wrote a.png", 100);
  EXPECT_EQ(notices(100), "wrote a.png\n");
  EXPECT_EQ(notices(100 + 0.9 * Hud::kNoticeSeconds), "wrote a.png\n");
  EXPECT_THAT(notices(100 + Hud::kNoticeSeconds), IsEmpty());
}

TEST_F(HudTest, ANewNoticeReplacesTheLastOfItsSubject) {
  hud_.notify(Subject::kPreset, "preparing preset high ...", 1);
  hud_.notify(Subject::kPicture, "wrote a.png", 2);
  hud_.notify(Subject::kPreset, "preset high", 3);
  EXPECT_EQ(notices(3), "preset high\nwrote a.png\n");
}

TEST_F(HudTest, ANoticeMayStayUntilAKeyIsPressed) {
  hud_.notify_until_key(Subject::kFlight, "the flight has ended");
  hud_.notify(Subject::kPicture, "wrote a.png", 0);
  EXPECT_THAT(notices(1e6), HasSubstr("ended"));
  hud_.key_pressed();
  EXPECT_EQ(notices(0), "wrote a.png\n");
}

TEST_F(HudTest, OmitsNoticesFromSavedImages) {
  hud_.add_frame(20);
  hud_.notify(Subject::kPicture, "wrote a.png", 0);
  const auto lasting = hud_.lasting_panels(*scene_, facts_);
  EXPECT_THAT(text(lasting, render::Anchor::kBottom), IsEmpty());
  EXPECT_EQ(text(lasting, render::Anchor::kTopLeft), figures());
}

TEST(Keys, AreAllDocumented) {
  std::stringstream documented;
  documented << std::ifstream(source_file("docs/cli.md")).rdbuf();
  for (const KeyHelp& key : kKeyHelp)
    EXPECT_THAT(documented.str(), HasSubstr("| " + std::string(key.keys) + " |"));
}

}  // namespace
}  // namespace psygen::app
