// Handles the keys of a flight's window (kKeyHelp) and lays out the text over the image.
#include <fmt/format.h>

#include <utility>

#include "engine/app/flight.hpp"
#include "engine/app/loading.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "engine/platform/window.hpp"
#include "engine/render/preset.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/scene.hpp"

namespace psygen::app {
namespace {

// True if the user presses a key or moves the mouse to fly.
bool moves_camera(const platform::InputState& input) {
  using enum platform::Key;
  for (const platform::Key key : {kW, kA, kS, kD, kQ, kE, kUp, kDown, kLeft, kRight}) {
    if (input.is_held(key)) return true;
  }
  return input.looking && (input.look_px.x != 0 || input.look_px.y != 0);
}

}  // namespace

// Handles the keys of the flight. All others belong to the camera.
void Flight::handle_keys() {
  using enum platform::Key;
  const platform::InputState& input = session_->input();
  const double now_s = core::monotonic_seconds();
  if (input.was_pressed(kEscape)) session_->close();
  if (input.went_down.any()) hud_.key_pressed();
  if (input.was_pressed(kF1)) hud_.next_page();
  if (input.was_pressed(kF2)) {
    render::View& view = session_->scene().input().view;
    view = render::next_view(view);
  }
  if (input.was_pressed(kF3)) {
    wanted_preset_ = render::next_preset(wanted_preset_.value_or(session_->renderer().preset()));
    hud_.notify(Hud::Subject::kPreset,
                fmt::format("preparing preset {} ...", render::to_string(*wanted_preset_)), now_s);
  }
  if (input.was_pressed(kF11)) {
    platform::Window& window = *session_->window();
    if (auto ok = window.set_fullscreen(!window.fullscreen()); !ok)
      hud_.notify(Hud::Subject::kScreen, ok.error().message, now_s);
  }
  if (input.was_pressed(kF12)) photograph_ = true;
  if (input.was_pressed(kP) || input.was_pressed(kPause)) session_->set_paused(!session_->paused());
  if (user_flies_ || !moves_camera(input)) return;
  user_flies_ = true;  // the flight leaves the path here
  if (path_)
    hud_.notify(Hud::Subject::kFlight, "You are flying now; the path is no longer followed.",
                now_s);
}

// Screenshots show no notices, which are about other images.
void Flight::write_over_picture() {
  scene::Scene& scene = session_->scene();
  HudFacts facts;
  facts.device = session_->renderer().device();
  facts.preset = session_->renderer().preset();
  facts.key_speed_m_s = fly_camera_.speed_m_s();
  facts.record = record_;
  scene.input().panels = photograph_ ? hud_.lasting_panels(scene, facts)
                                     : hud_.panels(scene, facts, core::monotonic_seconds());
  if (session_->paused() && !photograph_)
    scene.input().panels.push_back({render::Anchor::kMiddle, {{"paused; press P to continue"}}});
  scene.input().text_scale =
      text_scale(session_->window()->content_scale(), session_->picture_size());
}

// Saves a screenshot under the first free name. It does not enter the run's hash.
void Flight::save_screenshot() {
  photograph_ = false;
  std::filesystem::path file;
  std::error_code ignored;
  for (int number = 0; file.empty() || std::filesystem::exists(file, ignored); ++number) {
    file = options_.out_folder / fmt::format("screenshot_{:04}.png", number);
  }
  const auto image = session_->picture();
  const auto written = image ? session_->write_picture(file, *image)
                             : core::Result<void>(tl::unexpected(image.error()));
  const std::string text = written ? fmt::format("wrote {}", file.string())
                                   : "cannot save the screenshot: " + written.error().message;
  if (written) {
    core::log_info(text);
  } else {
    core::log_error(text);
  }
  hud_.notify(Hud::Subject::kPicture, text, core::monotonic_seconds());
}

void Flight::change_preset() {
  const render::Preset preset = *std::exchange(wanted_preset_, std::nullopt);
  const auto changed = session_->set_preset(preset);
  if (session_->window()->should_close() || session_->stopped()) return;
  if (!changed) core::log_error(changed.error().message);
  hud_.notify(Hud::Subject::kPreset,
              changed ? fmt::format("preset {}", render::to_string(preset))
                      : fmt::format("preset {} is not available: {}", render::to_string(preset),
                                    changed.error().message),
              core::monotonic_seconds());
}

void Flight::tell_end(const FlightReport& report) {
  std::string text = fmt::format("The flight has ended after {:.1f} s and {} frames. ",
                                 session_->now_s(), frames_);
  if (!report.failures.empty()) {
    text += report.failures.front().message;
  } else if (options_.out_folder.empty()) {
    text += "The terminal shows its summary.";
  } else {
    text += fmt::format("The report is in {}.", (options_.out_folder / "report.html").string());
  }
  hud_.notify_until_key(Hud::Subject::kFlight, text + " Continue flying, or press Esc to quit.");
}

}  // namespace psygen::app
