// What a person sees while something long goes on before the first frame: a bar on the terminal,
// nothing where stderr is none, and in a window a picture of its own (loading_picture.hpp). Keeps
// the window alive and notices when it is closed. Main thread.
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>
#include <string_view>

#include "engine/platform/window.hpp"
#include "engine/render/renderer.hpp"
#include "engine/telemetry/progress_bar.hpp"

namespace psygen::app {

// When the next picture may be drawn: at most twenty a second, and however long they take, at most
// a fifth of the time.
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

  // How far something has come, a fraction in [0, 1]; what goes back is shown as it was. `renderer`
  // draws the picture, null until there is one. False, to end what is going on, once the window was
  // closed or `stop` set.
  bool update(std::string_view label, double fraction, render::Renderer* renderer);
  double fraction() const { return fraction_; }  // as it is shown
  // The person closed the window.
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

// So large that it can be read: by the display's scale, and by the picture's size where that is
// more.
float text_scale(float content_scale, core::Extent picture);

}  // namespace psygen::app
