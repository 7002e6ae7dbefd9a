// The main loop: from the first pose to the end of the flight.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/app/app.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "engine/models/terrain.hpp"
#include "engine/render/preset.hpp"
#include "engine/telemetry/progress_bar.hpp"

namespace psygen::app {
namespace {

constexpr double kDefaultSeconds = 27.0;       // the paper's walk
constexpr double kEyeHeightM = 1.7;            // a flying user stays above the ground
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

bool App::wants_more(double flight_s, std::uint64_t frames) const {
  if (closed_ || (options_.stop != nullptr && options_.stop->load())) return false;
  if (options_.frames > 0 && frames >= options_.frames) return false;
  if (options_.seconds > 0) return flight_s < options_.seconds;
  if (options_.frames > 0 || user_flies_) return true;
  if (path_ && !options_.loop) return flight_s < path_->duration_seconds();
  return window_ != nullptr || flight_s < kDefaultSeconds;
}

core::CameraPose App::next_pose(double flight_s, double dt_s) {
  const world::World& world = scene_->state().facts.world;
  if (user_flies_) {
    pose_ = fly_camera_.update(pose_, input_, dt_s);
    pose_.position = core::normalised(pose_.position, world.block_size_m());
    const glm::dvec3& local = pose_.position.local;
    const double ground_m =
        models::ground_height_m(world.terrain, pose_.position.block, local.x, local.z);
    pose_.position.local.y = std::max(local.y, ground_m + kEyeHeightM);
  } else if (path_) {
    const double end_s = path_->duration_seconds();
    const bool again = options_.loop && end_s > 0;
    pose_ = path_->pose_at(again ? std::fmod(flight_s, end_s) : std::min(flight_s, end_s), world);
  } else {
    pose_ = home();
    pose_.yaw += 2 * std::numbers::pi * flight_s / kDefaultSeconds;
  }
  return pose_;
}

// Keys that the application itself knows; everything else belongs to the camera.
void App::handle_window() {
  input_ = window_->poll();
  if (input_.resized) {
    if (auto ok = renderer_->resize(window_->framebuffer_size()); !ok) {
      core::log_error(ok.error().message);
      closed_ = true;
    }
  }
  if (window_->should_close() || input_.was_pressed(platform::Key::kEscape)) closed_ = true;
  if (input_.was_pressed(platform::Key::kF1)) overlay_ = !overlay_;
  if (input_.was_pressed(platform::Key::kF2)) {
    render::View& view = scene_->state().input.view;
    view = render::next_view(view);
  }
  if (input_.was_pressed(platform::Key::kF12)) save_screenshot();
  if (moves_camera(input_)) user_flies_ = true;  // from here on the path is left
}

// A picture for the user: the first free name, and no part of the run's hash.
void App::save_screenshot() {
  std::filesystem::path file;
  std::error_code ignored;
  for (int number = 0; file.empty() || std::filesystem::exists(file, ignored); ++number) {
    file = options_.out_folder / fmt::format("screenshot_{:04}.png", number);
  }
  if (auto ok = save_picture(file); !ok) core::log_error(ok.error().message);
}

void App::wait_while_minimised() {
  while (picture_size() == core::Extent{} && !closed_) {
    window_->wait_events(kMinimisedWaitSeconds);
    handle_window();
    if (options_.stop != nullptr && options_.stop->load()) return;
  }
}

bool App::saves_picture(std::uint64_t frame) const {
  return options_.images_every > 0 && frame % options_.images_every == 0;
}

core::Result<void> App::fly_frame(std::uint64_t index, double flight_s, double dt_s) {
  scene::State& state = scene_->state();
  state.clock.now_s = flight_s;
  state.input.overlay_lines.clear();
  if (window_ && overlay_) {
    state.input.overlay_lines = overlay_figures_.lines(state, renderer_->device());
  }
  pictured_ = false;
  const double start_s = core::monotonic_seconds();
  const double cpu_start_s = core::thread_cpu_seconds();
  if (auto ok = frame(next_pose(flight_s, dt_s), dt_s); !ok) return ok;
  // The flight's clock goes on while a picture waits for the device, as if the next frames had.
  if (saves_picture(index)) renderer_->wait_idle();
  const double frame_ms = (core::monotonic_seconds() - start_s) * 1000.0;
  telemetry::FrameRecord& record = state.record;
  if (pictured_ || saves_picture(index)) record.apart = telemetry::Apart::kPicture;
  record.index = index;
  record.time_s = flight_s;
  record.frame_ms = frame_ms;
  record.main_cpu_ms = (core::thread_cpu_seconds() - cpu_start_s) * 1000.0;
  log_frame();
  const bool like_others = record.apart == telemetry::Apart::kNo;
  if (like_others) overlay_figures_.add_frame(frame_ms);
  state.input.frame_ms = like_others ? governed_ms(frame_ms) : 0.0;
  // On a device of its own the time is that of some frames before.
  state.input.frame_triangles = static_cast<double>(state.counters.frame.triangles);
  return {};
}

// What the error of levels of detail is governed by. The device's time counts where it is the
// longer one; waiting, for it or a display, does not. A software device's time is this machine's
// own.
double App::governed_ms(double frame_ms) const {
  const render::FrameResult& drawn = scene_->state().counters.frame;
  if (renderer_->device().software) return frame_ms - drawn.acquire.ms;
  return std::max(frame_ms - drawn.wait_ms(), drawn.gpu ? drawn.gpu->ms : 0.0);
}

core::Result<void> App::loop() {
  const double expected_s = options_.seconds > 0 ? options_.seconds
                            : path_              ? path_->duration_seconds()
                                                 : kDefaultSeconds;
  telemetry::ProgressBar bar(window_ ? telemetry::Terminal{} : telemetry::stderr_terminal(),
                             "flying", expected_s);
  const double hz = options_.fixed_step_hz;
  double flight_s = 0, dt_s = hz > 0 ? 1.0 / hz : 1.0 / 60.0;
  for (std::uint64_t frames = 0; wants_more(flight_s, frames);) {
    // The flight's clock stands still while the window is minimised and while pictures are written.
    if (window_) {
      handle_window();
      wait_while_minimised();
      if (closed_) break;
    }
    const double start_s = core::monotonic_seconds();
    if (auto ok = fly_frame(frames, flight_s, dt_s); !ok) return ok;
    if (hz <= 0) dt_s = core::monotonic_seconds() - start_s;
    bar.update(flight_s);
    if (saves_picture(frames)) {
      if (auto ok = save_numbered_picture(frames); !ok) return ok;
    }
    ++frames;
    flight_s = hz > 0 ? static_cast<double>(frames) / hz : flight_s + dt_s;
  }
  return {};
}

// A window that is being resized may have no picture in this frame; that is no failure.
core::Result<void> App::save_numbered_picture(std::uint64_t frame) {
  auto saved = save_picture(options_.out_folder / fmt::format("frame_{:05}.png", frame));
  if (saved) {
    images_hash_ = core::combine(images_hash_, last_image_hash_);
    ++images_;
  } else if (window_ && saved.error().code != core::ErrorCode::kIo) {
    core::log_warning(fmt::format("no picture of frame {}: {}", frame, saved.error().message));
    return {};
  }
  return saved;
}

// The last frame, and what is known now of earlier ones.
void App::log_frame() {
  const scene::State& state = scene_->state();
  const double flight_s = state.record.time_s;
  log_->add(state.record);
  if (const auto& gpu = state.counters.frame.gpu)
    log_->set_gpu_ms(gpu->frame, gpu->ms, gpu->shadows_ms);
  for (const float ms : state.counters.time_to_visible_ms)
    log_->add_time_to_visible(flight_s, ms);
  for (const auto& cost : state.counters.costs) {
    log_->add_cost_error(flight_s, cost.predicted_s, cost.actual_s);
  }
}

core::Result<FlightReport> App::run() {
  const world::World& world = scene_->state().facts.world;
  pose_ = path_ ? path_->pose_at(0, world) : home();
  if (auto ok = prepare(pose_); !ok) return tl::unexpected(ok.error());
  for (const Plugin& plugin : options_.plugins) {
    if (plugin.on_start) plugin.on_start(*this);
  }
  // What was measured is written also when the flight ended early.
  const auto flown = loop();
  FlightReport report;
  report.summary = telemetry::summarise(*log_, run_facts(), options_.warmup_seconds);
  if (auto ok = write_outputs(report.summary); !ok) return tl::unexpected(ok.error());
  if (!flown) return tl::unexpected(flown.error());
  report.files = files_;
  report.validation_messages = renderer_->validation_messages();
  return report;
}

}  // namespace psygen::app
