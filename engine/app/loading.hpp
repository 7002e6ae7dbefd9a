// Progress of long tasks before the first frame: a bar on the terminal, none if stderr is not a
// terminal, and an image in a window (loading_picture). Keeps the window responsive and detects
// when it is closed. Main thread.
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>
#include <string_view>

#include "engine/core/surface_provider.hpp"
#include "engine/platform/window.hpp"
#include "engine/render/hud_drawing.hpp"
#include "engine/render/renderer.hpp"
#include "engine/telemetry/progress_bar.hpp"

namespace psygen::app {

// Limits how often the image is drawn: at most twenty times a second, and at most a fifth of the
// time.
class PicturePace {
 public:
  bool is_due(double now_s) const { return now_s >= next_s_; }
  void drawn(double start_s, double end_s) {
    next_s_ =
        end_s + std::max(kPauseSeconds - (end_s - start_s), kPausePerPicture * (end_s - start_s));
  }

 private:
  static constexpr double kPauseSeconds = 0.05, kPausePerPicture = 4;
  double next_s_ = 0;
};

class Loading {
 public:
  // `title` is the name of the world. `window` and `stop` may be null, and outlive this.
  Loading(std::string title, platform::Window* window, const std::atomic<bool>* stop);

  // Shows progress as a fraction in [0, 1], which never decreases under one label. `renderer` draws
  // the image and is null until it exists. Returns false, to cancel the task, once the window was
  // closed or `stop` was set.
  bool update(std::string_view label, double fraction, render::Renderer* renderer);
  double fraction() const { return fraction_; }  // as shown
  // True once the user has closed the window.
  bool closed() const { return closed_; }
  // Removes the bar from the terminal.
  void finish() { bar_.reset(); }

 private:
  void watch_window(render::Renderer* renderer);

  std::string title_;
  platform::Window* window_;
  const std::atomic<bool>* stop_;
  std::string label_;
  double fraction_ = 0;
  std::unique_ptr<telemetry::ProgressBar> bar_;
  PicturePace pace_;
  bool closed_ = false;
};

// Scale of text for readability: that of the display, or by the image's size, whichever is larger.
float text_scale(float content_scale, core::Extent picture);

// The image of a window while its world loads: hills in the evening, the name of the world, a bar
// and the current task. `fraction` in [0, 1]. The name determines the hills; sizes scale with the
// image's height. Pure; any thread.
render::HudDrawing loading_picture(std::string_view world, std::string_view label, double fraction,
                                   core::Extent picture);

}  // namespace psygen::app
