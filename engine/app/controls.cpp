// What a person does with a window: its keys (keys.hpp), its size, and the words over the picture.
#include <fmt/format.h>

#include <utility>

#include "engine/app/app.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "engine/render/preset.hpp"

namespace psygen::app {
namespace {

constexpr double kMinimisedWaitSeconds = 0.1;  // between looks at a minimised window

// Whether the person wants to fly rather than watch.
bool moves_camera(const platform::InputState& input) {
  using enum platform::Key;
  for (const platform::Key key : {kW, kA, kS, kD, kQ, kE, kUp, kDown, kLeft, kRight}) {
    if (input.is_held(key)) return true;
  }
  return input.looking && (input.look_px.x != 0 || input.look_px.y != 0);
}

}  // namespace

void App::handle_window() {
  input_ = window_->poll();
  if (input_.resized) {
    if (auto ok = renderer_->resize(window_->framebuffer_size()); !ok) {
      core::log_error(ok.error().message);
      closed_ = true;
    }
  }
  if (window_->should_close() || input_.was_pressed(platform::Key::kEscape)) closed_ = true;
  handle_keys();
  if (user_flies_ || !moves_camera(input_)) return;
  user_flies_ = true;  // from here on the path is left
  if (path_) {
    hud_.notify(Hud::Subject::kFlight, "You fly now; the path is left.", core::monotonic_seconds());
  }
}

// Keys that the application itself knows; everything else belongs to the camera.
void App::handle_keys() {
  using enum platform::Key;
  const double now_s = core::monotonic_seconds();
  if (input_.went_down.any()) hud_.key_pressed();
  if (input_.was_pressed(kF1)) hud_.next_page();
  if (input_.was_pressed(kF2)) {
    render::View& view = scene_->state().input.view;
    view = render::next_view(view);
  }
  if (input_.was_pressed(kF3)) {
    wanted_preset_ = render::next_preset(wanted_preset_.value_or(renderer_->preset()));
    hud_.notify(Hud::Subject::kPreset,
                fmt::format("preparing preset {} ...", render::to_string(*wanted_preset_)), now_s);
  }
  if (input_.was_pressed(kF11)) {
    if (auto ok = window_->set_fullscreen(!window_->fullscreen()); !ok)
      hud_.notify(Hud::Subject::kScreen, ok.error().message, now_s);
  }
  if (input_.was_pressed(kF12)) photograph_ = true;
}

void App::wait_while_minimised() {
  while (picture_size() == core::Extent{} && !closed_) {
    window_->wait_events(kMinimisedWaitSeconds);
    handle_window();
    if (stopped()) return;
  }
}

// Pictures that the user takes have no notices, which are about other pictures.
void App::write_over_picture() {
  scene::State& state = scene_->state();
  const HudFacts facts{renderer_->device(), renderer_->preset(), fly_camera_.speed_m_s()};
  state.input.panels = photograph_ ? hud_.lasting_panels(state, facts)
                                   : hud_.panels(state, facts, core::monotonic_seconds());
  state.input.text_scale = text_scale(window_->content_scale(), picture_size());
}

// A picture for the user: the first free name, and no part of the run's hash.
void App::save_screenshot() {
  photograph_ = false;
  std::filesystem::path file;
  std::error_code ignored;
  for (int number = 0; file.empty() || std::filesystem::exists(file, ignored); ++number) {
    file = options_.out_folder / fmt::format("screenshot_{:04}.png", number);
  }
  const auto image = last_picture();
  const auto written =
      image ? write_picture(file, *image) : core::Result<void>(tl::unexpected(image.error()));
  const std::string text = written ? fmt::format("wrote {}", file.string())
                                   : "no picture was written: " + written.error().message;
  if (written) {
    core::log_info(text);
  } else {
    core::log_error(text);
  }
  hud_.notify(Hud::Subject::kPicture, text, core::monotonic_seconds());
}

void App::change_preset() {
  const render::Preset preset = *std::exchange(wanted_preset_, std::nullopt);
  const auto changed = renderer_->set_preset(preset, [this](double) {
    window_->keep_alive();
    return !window_->should_close() && !stopped();
  });
  if (window_->should_close() || stopped()) return;
  if (!changed) core::log_error(changed.error().message);
  if (changed) scene_->take_over_preset();
  hud_.notify(Hud::Subject::kPreset,
              changed ? fmt::format("preset {}", render::to_string(preset))
                      : fmt::format("preset {} cannot be had: {}", render::to_string(preset),
                                    changed.error().message),
              core::monotonic_seconds());
}

void App::tell_end(const FlightReport& report) {
  std::string text =
      fmt::format("The flight has ended after {:.1f} s and {} frames. ", flight_s_, frames_);
  if (!report.failures.empty()) {
    text += report.failures.front().message;
  } else if (options_.out_folder.empty()) {
    text += "Its figures are on the terminal.";
  } else {
    text += fmt::format("Its figures are in {}.", (options_.out_folder / "report.html").string());
  }
  hud_.notify_until_key(Hud::Subject::kFlight, text + " Fly on, or press Esc to leave.");
}

}  // namespace psygen::app
