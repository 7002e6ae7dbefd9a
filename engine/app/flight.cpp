// The main loop: from the first pose to the end of the flight.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "engine/app/app.hpp"
#include "engine/app/overlay.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "engine/models/terrain.hpp"
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
  if (path_) return flight_s < path_->duration_seconds();
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
    pose_ = path_->pose_at(std::min(flight_s, path_->duration_seconds()), world);
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
  if (input_.was_pressed(platform::Key::kF12)) {
    const auto folder =
        options_.out_folder.empty() ? std::filesystem::path(".") : options_.out_folder;
    const auto file = folder / fmt::format("screenshot_{:04}.png", images_);
    if (auto ok = save_picture(file); ok) {
      core::log_info(fmt::format("wrote {}", file.string()));
    } else {
      core::log_error(ok.error().message);
    }
  }
  if (moves_camera(input_)) user_flies_ = true;  // from here on the path is left
}

core::Result<void> App::loop() {
  telemetry::ProgressBar bar(window_ ? telemetry::Terminal{} : telemetry::stderr_terminal(),
                             "flying",
                             options_.seconds > 0 ? options_.seconds
                             : path_              ? path_->duration_seconds()
                                                  : kDefaultSeconds);
  Overlay overlay;
  const bool fixed = options_.fixed_step_hz > 0;
  double flight_s = 0, dt_s = fixed ? 1.0 / options_.fixed_step_hz : 1.0 / 60.0;
  double frame_start_s = core::monotonic_seconds();
  double cpu_start_s = core::thread_cpu_seconds();
  for (std::uint64_t frames = 0; wants_more(flight_s, frames); ++frames) {
    if (window_) {
      handle_window();
      while (window_->minimised() && !closed_) {
        window_->wait_events(kMinimisedWaitSeconds);
        handle_window();
        frame_start_s = core::monotonic_seconds();
        if (options_.stop != nullptr && options_.stop->load()) break;
      }
    }
    scene::State& state = scene_->state();
    state.clock.now_s = flight_s;
    if (window_ && overlay_) {
      state.input.overlay_lines = overlay.lines(state, renderer_->device());
    } else {
      state.input.overlay_lines.clear();
    }
    if (auto ok = frame(next_pose(flight_s, dt_s), dt_s); !ok) return ok;

    const double end_s = core::monotonic_seconds();
    const double cpu_end_s = core::thread_cpu_seconds();
    record_frame(frames, flight_s, (end_s - frame_start_s) * 1000.0,
                 (cpu_end_s - cpu_start_s) * 1000.0);
    overlay.add_frame((end_s - frame_start_s) * 1000.0);
    bar.update(flight_s);
    if (!fixed) dt_s = end_s - frame_start_s;
    flight_s += dt_s;
    // What follows is not part of the flight: the clock stands still while pictures are written.
    if (options_.images_every > 0 && frames % options_.images_every == 0) {
      if (auto ok = save_numbered_picture(frames); !ok) return ok;
    }
    frame_start_s = core::monotonic_seconds();
    cpu_start_s = core::thread_cpu_seconds();
  }
  return {};
}

core::Result<void> App::save_numbered_picture(std::uint64_t frame) {
  const auto folder =
      options_.out_folder.empty() ? std::filesystem::path(".") : options_.out_folder;
  return save_picture(folder / fmt::format("frame_{:05}.png", frame));
}

void App::record_frame(std::uint64_t index, double flight_s, double frame_ms, double cpu_ms) {
  scene::State& state = scene_->state();
  telemetry::FrameRecord record = state.record;
  record.index = index;
  record.time_s = flight_s;
  record.frame_ms = frame_ms;
  record.main_cpu_ms = cpu_ms;
  log_->add(record);
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
  if (auto ok = loop(); !ok) return tl::unexpected(ok.error());

  FlightReport report;
  report.summary = telemetry::summarise(*log_, run_facts(), options_.warmup_seconds);
  if (auto ok = write_outputs(report.summary); !ok) return tl::unexpected(ok.error());
  report.files = files_;
  report.validation_messages = renderer_->validation_messages();
  return report;
}

}  // namespace psygen::app
