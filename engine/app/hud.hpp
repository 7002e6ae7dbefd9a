// The text over the picture in a window: figures or help in one corner, the legend of the view in
// another, notices at the bottom. Makes text from values; the renderer draws it. Has no clock. Main
// thread.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/render/text_panel.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/state.hpp"

namespace psygen::app {

// What the figures show beyond the state of the scene.
struct HudFacts {
  render::DeviceInfo device;
  render::Preset preset = render::Preset::kLow;
  double key_speed_m_s = 0;  // at which the keys move the camera
};

// Shows figures at first.
class Hud {
 public:
  static constexpr double kNoticeSeconds = 5;
  // What a notice is about; a new one takes the place of the last about the same.
  enum class Subject : std::uint8_t { kFlight, kPreset, kScreen, kPicture, kCount };

  // The time of a frame in milliseconds, for the figures.
  void add_frame(double frame_ms);
  // Switches from figures to help, from help to nothing, and from nothing to figures.
  void next_page();
  // Shows a sentence for kNoticeSeconds, starting at `now_s` of the clock that panels() gets.
  void notify(Subject subject, std::string text, double now_s);
  // Shows a sentence until key_pressed().
  void notify_until_key(Subject subject, std::string text);
  void key_pressed();

  // The text at `now_s` seconds. The figures are those of the last tick.
  std::vector<render::TextPanel> panels(const scene::State& state, const HudFacts& facts,
                                        double now_s) const;
  // The same without notices, for pictures that are kept.
  std::vector<render::TextPanel> lasting_panels(const scene::State& state,
                                                const HudFacts& facts) const;

 private:
  enum class Page : std::uint8_t { kFigures, kHelp, kNothing };
  struct Notice {
    std::string text;
    double end_s = 0;  // +inf: until a key is pressed
  };
  std::vector<render::TextLine> figures(const scene::State& state, const HudFacts& facts) const;

  static constexpr std::size_t kFrames = 60;
  std::array<double, kFrames> frame_ms_{};
  std::size_t count_ = 0;
  Page page_ = Page::kFigures;
  std::array<Notice, static_cast<std::size_t>(Subject::kCount)> notices_;
};

}  // namespace psygen::app
