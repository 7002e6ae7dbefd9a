#include "engine/app/loading.hpp"

#include <algorithm>

#include "engine/app/loading_picture.hpp"
#include "engine/core/clock.hpp"

namespace psygen::app {
namespace {

constexpr float kHeightOfScaleOne = 1080;  // image height for text scale 1

}  // namespace

float text_scale(float content_scale, core::Extent picture) {
  return std::max(content_scale, static_cast<float>(picture.height) / kHeightOfScaleOne);
}

Loading::Loading(std::string title, platform::Window* window, const std::atomic<bool>* stop)
    : title_(std::move(title)), window_(window), stop_(stop) {}

bool Loading::update(std::string_view label, double fraction, render::Renderer* renderer) {
  if (!bar_ || label != label_) {
    label_ = label;
    fraction_ = 0;
    bar_ = std::make_unique<telemetry::ProgressBar>(telemetry::stderr_terminal(), label_, 1.0);
  }
  fraction_ = std::max(fraction_, fraction);
  bar_->update(fraction_);
  if (window_ != nullptr) watch_window(renderer);
  return !closed_ && (stop_ == nullptr || !stop_->load());
}

void Loading::watch_window(render::Renderer* renderer) {
  const platform::InputState input = window_->poll();
  if (window_->should_close() || input.was_pressed(platform::Key::kEscape)) closed_ = true;
  if (input.was_pressed(platform::Key::kF11)) (void)window_->set_fullscreen(!window_->fullscreen());
  const double now_s = core::monotonic_seconds();
  if (closed_ || renderer == nullptr || !pace_.is_due(now_s)) return;
  // Errors of this image are reported by the first frame.
  (void)renderer->show({}, 1,
                       loading_picture(title_, label_, fraction_, window_->framebuffer_size()));
  pace_.drawn(now_s, core::monotonic_seconds());
}

}  // namespace psygen::app
