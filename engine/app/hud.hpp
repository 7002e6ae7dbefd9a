// Text over the image of a window: statistics or help in one corner, the legend of the view in
// another, notices at the bottom. Makes text from values; the renderer draws it. Has no clock. Main
// thread.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "engine/render/hud_drawing.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/scene.hpp"
#include "engine/telemetry/frame_log.hpp"

namespace psygen::app {

// Values for the statistics besides the state of the scene.
struct HudFacts {
  render::DeviceInfo device;
  render::Preset preset = render::Preset::kLow;
  double key_speed_m_s = 0;       // speed at which the keys move the camera
  telemetry::FrameRecord record;  // of the last frame
};

// Shows statistics at first.
class Hud {
 public:
  static constexpr double kNoticeSeconds = 5;
  // Subject of a notice; a new notice replaces the last one of the same subject.
  enum class Subject : std::uint8_t { kFlight, kPreset, kScreen, kPicture, kCount };

  // Adds the time of a frame in milliseconds to the statistics.
  void add_frame(double frame_ms);
  // Switches from statistics to help, from help to nothing, and back to statistics.
  void next_page();
  // Shows a message for kNoticeSeconds, starting at `now_s` of the clock given to panels().
  void notify(Subject subject, std::string text, double now_s);
  // Shows a message until key_pressed().
  void notify_until_key(Subject subject, std::string text);
  void key_pressed();

  // Text at `now_s` seconds. The statistics are those of the last tick.
  std::vector<render::TextPanel> panels(const scene::Scene& scene, const HudFacts& facts,
                                        double now_s) const;
  // Text without notices, for saved images.
  std::vector<render::TextPanel> lasting_panels(const scene::Scene& scene,
                                                const HudFacts& facts) const;

 private:
  enum class Page : std::uint8_t { kFigures, kHelp, kNothing };
  struct Notice {
    std::string text;
    double end_s = 0;  // +inf: until a key is pressed
  };
  std::vector<render::TextLine> figures(const scene::Scene& scene, const HudFacts& facts) const;

  static constexpr std::size_t kFrames = 60;
  std::array<double, kFrames> frame_ms_{};
  std::size_t count_ = 0;
  Page page_ = Page::kFigures;
  std::array<Notice, static_cast<std::size_t>(Subject::kCount)> notices_;
};

// A key of a window and its function.
struct KeyHelp {
  std::string_view keys, meaning;
};

// One list for the help on the screen and for the documentation (docs/cli.md). Implemented in
// controls.cpp and platform/fly_camera.cpp.
inline constexpr std::array kKeyHelp{
    KeyHelp{"W A S D", "fly forward, left, back, right"},
    KeyHelp{"E Q", "fly up, down"},
    KeyHelp{"arrows", "turn"},
    KeyHelp{"mouse", "look around, with the right button"},
    KeyHelp{"wheel", "faster, slower"},
    KeyHelp{"Shift", "5 times as fast, while held"},
    KeyHelp{"Ctrl", "a fifth as fast, while held"},
    KeyHelp{"F1", "statistics, help, nothing"},
    KeyHelp{"F2", "next view, with its legend"},
    KeyHelp{"F3", "next preset"},
    KeyHelp{"P", "pause or continue"},
    KeyHelp{"F11", "toggle full screen"},
    KeyHelp{"F12", "save a screenshot"},
    KeyHelp{"Esc", "quit"},
};

}  // namespace psygen::app
