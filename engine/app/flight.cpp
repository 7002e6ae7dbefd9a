// The main loop: from the first pose to the end of the flight, and on in a window.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/app/app.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/image/image_io.hpp"
#include "engine/models/terrain/terrain.hpp"

namespace psygen::app {
namespace {

constexpr double kDefaultSeconds = 27.0;  // the paper's walk
constexpr double kEyeHeightM = 1.7;       // a flying user stays above the ground

}  // namespace

bool App::wants_more() const {
  if (closed_ || stopped()) return false;
  if (!flying_) return true;
  if (options_.frames > 0 && frames_ >= options_.frames) return false;
  if (options_.seconds > 0) return flight_s_ < options_.seconds;
  if (options_.frames > 0 || user_flies_) return true;
  if (path_ && !options_.loop) return flight_s_ < path_->duration_seconds();
  return window_ != nullptr || flight_s_ < kDefaultSeconds;
}

// Where only the path has ended the user goes on.
bool App::stays_open() const {
  const bool limited = options_.frames > 0 || options_.seconds > 0;
  return window_ != nullptr && !limited && !closed_ && !stopped();
}

core::CameraPose App::next_pose(double dt_s) {
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
    pose_ = path_->pose_at(again ? std::fmod(flight_s_, end_s) : std::min(flight_s_, end_s), world);
  } else {
    pose_ = home();
    pose_.yaw += 2 * std::numbers::pi * flight_s_ / kDefaultSeconds;
  }
  return pose_;
}

bool App::saves_picture() const {
  return flying_ && !pictures_failed_ && options_.images_every > 0 &&
         frames_ % options_.images_every == 0;
}

core::Result<void> App::fly_frame(double dt_s) {
  scene::State& state = scene_->state();
  state.clock.now_s = flight_s_;
  if (window_) write_over_picture();
  pictured_ = false;
  const double start_s = core::monotonic_seconds();
  const double cpu_start_s = core::thread_cpu_seconds();
  if (auto ok = frame(next_pose(dt_s), dt_s); !ok) return ok;
  // The flight's clock goes on while a picture waits for the device, as if the next frames had.
  if (saves_picture()) renderer_->wait_idle();
  const double frame_ms = (core::monotonic_seconds() - start_s) * 1000.0;
  telemetry::FrameRecord& record = state.record;
  if (pictured_ || saves_picture()) record.apart = telemetry::Apart::kPicture;
  record.index = frames_;
  record.time_s = flight_s_;
  record.frame_ms = frame_ms;
  record.main_cpu_ms = (core::thread_cpu_seconds() - cpu_start_s) * 1000.0;
  if (flying_) log_frame();
  const bool like_others = record.apart == telemetry::Apart::kNo;
  if (like_others) hud_.add_frame(frame_ms);
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
  const double hz = flying_ ? options_.fixed_step_hz : 0;
  double dt_s = hz > 0 ? 1.0 / hz : 1.0 / 60.0;
  while (wants_more()) {
    // The flight's clock stands still while the window is minimised and while pictures are written.
    if (window_) {
      handle_window();
      wait_while_minimised();
      if (closed_) break;
    }
    const double start_s = core::monotonic_seconds();
    if (auto ok = fly_frame(dt_s); !ok) return ok;
    if (hz <= 0) dt_s = core::monotonic_seconds() - start_s;
    bar.update(flight_s_);
    if (saves_picture()) {
      if (auto ok = save_numbered_picture(); !ok) return ok;
    }
    if (photograph_) save_screenshot();
    if (wanted_preset_) change_preset();
    ++frames_;
    flight_s_ = hz > 0 ? static_cast<double>(frames_) / hz : flight_s_ + dt_s;
  }
  return {};
}

// A window that is being resized may have no picture in this frame; that is no failure. A file that
// cannot be written is one, but not the end of the flight.
core::Result<void> App::save_numbered_picture() {
  const auto file = options_.out_folder / fmt::format("frame_{:05}.png", frames_);
  const auto image = last_picture();
  if (!image) {
    if (!window_) return tl::unexpected(image.error());
    core::log_warning(fmt::format("no picture of frame {}: {}", frames_, image.error().message));
    return {};
  }
  const auto written = write_picture(file, *image);
  note_written(file, written);
  if (written) {
    images_hash_ = core::combine(images_hash_, image::hash(*image));
    ++images_;
  } else {
    pictures_failed_ = true;
    core::log_warning(fmt::format("no more pictures are written: {}", written.error().message));
  }
  return {};
}

// The last frame, and what is known now of earlier ones.
void App::log_frame() {
  const scene::State& state = scene_->state();
  log_->add(state.record);
  if (const auto& gpu = state.counters.frame.gpu)
    log_->set_gpu_ms(gpu->frame, gpu->ms, gpu->shadows_ms);
  for (const float ms : state.counters.time_to_visible_ms)
    log_->add_time_to_visible(flight_s_, ms);
  for (const auto& cost : state.counters.costs) {
    log_->add_cost_error(flight_s_, cost.predicted_s, cost.actual_s);
  }
}

// The end of the flight: what was measured is written down, also when it ended early.
FlightReport App::land(bool whole) {
  flying_ = false;
  FlightReport report;
  const auto written =
      core::within_memory("the outputs of the flight", [&]() -> core::Result<void> {
        report.summary = telemetry::summarise(*log_, run_facts(whole), options_.warmup_seconds);
        write_outputs(report.summary);
        return {};
      });
  if (!written) failures_.push_back(written.error());
  scene_->state().trace.log = nullptr;  // what comes now is none of the flight
  report.files = files_;
  report.failures = failures_;
  report.validation_messages = renderer_->validation_messages();
  return report;
}

core::Result<FlightReport> App::run() {
  const world::World& world = scene_->state().facts.world;
  pose_ = path_ ? path_->pose_at(0, world) : home();
  const auto prepared =
      core::within_memory("what is seen first", [this] { return prepare(pose_); });
  if (!prepared) return tl::unexpected(prepared.error());
  for (const Plugin& plugin : options_.plugins) {
    if (plugin.on_start) plugin.on_start(*this);
  }
  frames_ = 0;
  flight_s_ = 0;
  flying_ = true;
  const auto flown = core::within_memory("the flight", [this] { return loop(); });
  FlightReport report = land(flown.has_value());
  if (!flown) {
    for (const core::Error& failure : failures_)
      core::log_error(failure.message);
    return tl::unexpected(flown.error());
  }
  for (const Plugin& plugin : options_.plugins) {
    if (plugin.on_end) plugin.on_end(*this, report);
  }
  if (!stays_open()) return report;
  tell_end(report);
  user_flies_ = true;
  const auto flown_on = core::within_memory("the flight", [this] { return loop(); });
  if (!flown_on) return tl::unexpected(flown_on.error());
  report.validation_messages = renderer_->validation_messages();
  return report;
}

}  // namespace psygen::app
