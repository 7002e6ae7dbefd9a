// The main loop, from the first pose to the end of the flight. In a window it continues after the
// path has ended.
#include "engine/app/flight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "engine/app/plugin_call.hpp"
#include "engine/app/virtual_frame.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/image/image_io.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/platform/window.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/telemetry/marks.hpp"
#include "engine/telemetry/own_figures.hpp"
#include "engine/telemetry/progress_bar.hpp"
#include "engine/world/files/path_file.hpp"
#include "engine/world/world.hpp"

namespace psygen::app {
namespace {

constexpr double kDefaultSeconds = 27.0;  // the paper's walk
constexpr double kMinFrameMs = 1e-3;      // for a frame in which the clock went back
constexpr double kEyeHeightM = 1.7;       // the user flies at least this high above the ground

// On the virtual clock a flight must not depend on the GPU. Results of the GPU path arrive some
// frames late, and a window follows the wall clock.
core::Result<void> fit_virtual_clock(SessionOptions& options) {
  if (!has_virtual_frames(options)) return {};
  if (options.render_path == render::RenderPath::kGpu) {
    return core::invalid_argument(
        "the virtual clock needs the render path cpu: results of the path gpu "
        "arrive some frames late");
  }
  options.render_path = render::RenderPath::kCpu;
  if (!options.preset) options.preset = render::Preset::kLow;
  return {};
}

// Removes times that the virtual clock does not measure. Images take no time on it and exclude no
// frame.
void forget_real_times(telemetry::FrameRecord& record) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  record.main_cpu_ms = record.device_wait_ms = record.acquire_ms = record.present_ms = kUnknown;
  record.record_ms = kUnknown;
  record.apart = telemetry::Apart::kNo;
  record.device_bytes.reset();
}

}  // namespace

core::Result<std::unique_ptr<Flight>> Flight::create(FlightOptions options) {
  std::unique_ptr<Flight> flight(new Flight(std::move(options)));
  const auto opened =
      core::catch_out_of_memory("starting the flight", [&flight] { return flight->open(); });
  if (!opened) return tl::unexpected(opened.error());
  return flight;
}

core::Result<void> Flight::open() {
  if (!options_.out_folder.empty()) {
    auto folder = telemetry::OutputFolder::open(options_.out_folder);
    if (!folder) return tl::unexpected(folder.error());
    out_.emplace(std::move(*folder));
    for (const char* name : kFlightFiles) {
      if (auto ok = core::check_replaceable(options_.out_folder / name); !ok) return ok;
    }
  }
  if (!options_.path_file.empty()) {
    auto path = world::load_camera_path(options_.path_file);
    if (!path) return tl::unexpected(path.error());
    path_ = std::move(*path);
  }
  if (auto ok = fit_virtual_clock(options_.session); !ok) return ok;
  options_.session.trace = true;
  auto session = Session::create(options_.session);
  if (!session) return tl::unexpected(session.error());
  session_ = std::move(*session);
  const double view_m = options_.session.scene.view_distance_m;
  const world::World& world = session_->scene().world();
  if (path_ && !path_->comes_within(view_m, world))
    return core::invalid_argument(
        fmt::format("{}: the world {} is never in view: every point is "
                    "more than the view distance, {:g} m, outside the world",
                    options_.path_file.string(), world.name, view_m));
  open_log();
  return {};
}

void Flight::open_log() {
  scene::Scene& scene = session_->scene();
  const std::span<const telemetry::FigureInfo> figures = scene.figures().infos();
  log_ = std::make_unique<telemetry::FrameLog>(
      scene.system_names(), telemetry::FrameLog::kMaxFrames,
      std::vector<telemetry::FigureInfo>(figures.begin(), figures.end()),
      std::vector<std::string>(render::kPassNames.begin(), render::kPassNames.end()));
  telemetry::TraceLog& trace = *session_->trace();
  for (const telemetry::FigureInfo& figure : figures)
    own_counters_.push_back(trace.add_counter(
        fmt::format("{}{}{}", figure.name, figure.unit.empty() ? "" : " in ", figure.unit)));
  marks_track_ = trace.add_track("marks");
}

bool Flight::wants_more() const {
  if (session_->over()) return false;
  if (!recorded_) return true;
  if (options_.frames > 0 && frames_ >= options_.frames) return false;
  const double now_s = session_->now_s();
  if (options_.seconds > 0) return now_s < options_.seconds;
  if (options_.frames > 0 || user_flies_) return true;
  if (path_ && !options_.loop) return now_s < path_->duration_seconds();
  return session_->window() != nullptr || now_s < kDefaultSeconds;
}

// A window stays open if only the path has ended.
bool Flight::stays_open() const {
  const bool limited = options_.frames > 0 || options_.seconds > 0;
  return session_->window() != nullptr && !limited && !session_->over();
}

core::CameraPose Flight::next_pose(double dt_s) {
  const double now_s = session_->now_s();
  const world::World& world = session_->scene().world();
  if (options_.camera) {
    pose_ = options_.camera(*session_, dt_s);
  } else if (user_flies_) {
    pose_ = fly_camera_.update(pose_, session_->input(), dt_s);
    pose_.position = core::normalised(pose_.position, world.block_size_m());
    const glm::dvec3& local = pose_.position.local;
    const double ground_m =
        models::ground_height_m(world.terrain, pose_.position.block, local.x, local.z);
    pose_.position.local.y = std::max(local.y, ground_m + kEyeHeightM);
  } else if (path_) {
    const double end_s = path_->duration_seconds();
    const bool again = options_.loop && end_s > 0;
    pose_ = path_->pose_at(again ? std::fmod(now_s, end_s) : std::min(now_s, end_s), world);
  } else {
    pose_ = session_->home();
    pose_.yaw += 2 * std::numbers::pi * now_s / kDefaultSeconds;
  }
  return pose_;
}

bool Flight::saves_picture() const {
  return recorded_ && !session_->paused() && !pictures_failed_ && options_.images_every > 0 &&
         frames_ % options_.images_every == 0;
}

core::Result<void> Flight::fly_frame(double dt_s) {
  scene::Scene& scene = session_->scene();
  if (session_->window() != nullptr) write_over_picture();
  const double now_s = session_->now_s();
  const double start_s = core::monotonic_seconds();
  const double cpu_start_s = core::thread_cpu_seconds(), asleep_s = core::suspended_seconds();
  if (auto ok = session_->tick(next_pose(session_->paused() ? 0 : dt_s), dt_s); !ok) return ok;
  // The flight's clock continues while an image waits for the GPU, as if the next frames had
  // waited.
  if (saves_picture()) session_->renderer().wait_idle();
  const double frame_ms = (core::monotonic_seconds() - start_s) * 1000.0;
  telemetry::FrameRecord& record = record_;
  record = scene.record();
  const auto saved = session_->take_saved();  // by plugins
  report_.files.insert(report_.files.end(), saved.begin(), saved.end());
  if (!saved.empty() || saves_picture()) record.apart = telemetry::Apart::kPicture;
  record.has_picture = saves_picture();
  record.index = frames_;
  record.time_s = now_s;
  record.frame_ms = std::max(frame_ms, kMinFrameMs);
  // A frame with an image waits for the GPU and the disk, however long they take.
  if (record.apart != telemetry::Apart::kPicture &&
      is_gap(frame_ms, usual_ms_, core::suspended_seconds() - asleep_s))
    record.apart = telemetry::Apart::kGap;
  record.main_cpu_ms = (core::thread_cpu_seconds() - cpu_start_s) * 1000.0;
  if (has_virtual_frames(options_.session)) {
    record.frame_ms = scene.input().frame_ms;
    forget_real_times(record);
  }
  measure_presents();
  take_own();
  if (recorded_ && !session_->paused()) log_frame();
  const bool like_others = record.apart == telemetry::Apart::kNo;
  if (like_others) usual_ms_ = record.frame_ms;
  if (like_others) hud_.add_frame(record.frame_ms);
  if (!like_others) scene.input().frame_ms = 0;  // an excluded frame must not affect the governor
  return {};
}

core::Result<void> Flight::loop() {
  const double expected_s = options_.seconds > 0 ? options_.seconds
                            : path_              ? path_->duration_seconds()
                                                 : kDefaultSeconds;
  const bool in_window = session_->window() != nullptr;
  telemetry::ProgressBar bar(in_window ? telemetry::Terminal{} : telemetry::stderr_terminal(),
                             "flying", expected_s);
  const double hz = recorded_ ? options_.fixed_step_hz : 0;
  double dt_s = hz > 0 ? 1.0 / hz : 1.0 / 60.0;
  // The flight's clock stands still while the window is minimised and while images are written.
  while (wants_more() && session_->poll()) {
    if (in_window) handle_keys();
    if (session_->over()) break;
    const double start_s = core::monotonic_seconds(), now_s = session_->now_s();
    if (auto ok = fly_frame(dt_s); !ok) return ok;
    if (hz <= 0) {
      const double passed_s = core::monotonic_seconds() - start_s;
      if (has_virtual_frames(options_.session)) {
        dt_s = record_.frame_ms * 1e-3;
      } else if (!is_gap(passed_s * 1000, usual_ms_, 0)) {
        dt_s = passed_s;  // the flight does not jump over a gap
      }
    }
    bar.update(now_s);
    if (saves_picture()) {
      if (auto ok = save_numbered_picture(); !ok) return ok;
    }
    if (photograph_) save_screenshot();
    if (wanted_preset_) change_preset();
    if (session_->paused()) {
      session_->set_now(now_s);
      continue;
    }
    ++frames_;
    session_->set_now(hz > 0 ? static_cast<double>(frames_) / hz : now_s + dt_s);
  }
  return {};
}

// A window that is being resized may have no image in this frame, which is not a failure. A file
// that cannot be written is a failure, but it does not end the flight.
core::Result<void> Flight::save_numbered_picture() {
  const auto file = options_.out_folder / telemetry::picture_name(frames_);
  const auto image = session_->picture();
  if (!image) {
    if (session_->window() == nullptr) return tl::unexpected(image.error());
    core::log_warning(fmt::format("no image of frame {}: {}", frames_, image.error().message));
    return {};
  }
  const auto written = session_->write_picture(file, *image);
  note_written(file, written);
  if (written) {
    images_hash_ = core::combine(images_hash_, image::hash(*image));
    ++images_;
  } else {
    pictures_failed_ = true;
    core::log_warning(fmt::format("no further images are written: {}", written.error().message));
  }
  return {};
}

// Measures the time since the frame before was handed over, and the animation error as PresentMon 2
// defines it (docs/summary.md). Both need two frames in turn that timing statistics include.
void Flight::measure_presents() {
  telemetry::FrameRecord& r = record_;
  const bool counts = recorded_ && !session_->paused() && r.handed_over_s > 0 &&
                      r.apart == telemetry::Apart::kNo && !has_virtual_frames(options_.session);
  const auto before = std::exchange(
      presented_, counts ? std::optional(Presented{r.handed_over_s, r.time_s}) : std::nullopt);
  if (!counts || !before) return;
  r.between_presents_ms = (r.handed_over_s - before->handed_over_s) * 1000.0;
  if (options_.fixed_step_hz > 0) return;
  r.animation_error_ms = (r.time_s - before->time_s) * 1000.0 - *r.between_presents_ms;
}

// Ends the frame of the game's figures. Real durations have no place on the virtual clock.
void Flight::take_own() {
  telemetry::OwnFigures& figures = session_->scene().figures();
  figures.take(own_);
  if (!has_virtual_frames(options_.session)) return;
  for (std::size_t i = 0; i < own_.size(); ++i)
    if (figures.infos()[i].kind == telemetry::FigureKind::kDuration)
      own_[i] = std::numeric_limits<double>::quiet_NaN();
}

// Adds the game's figures of the last frame to the trace, and its marks to the log and the trace.
void Flight::log_marks() {
  telemetry::TraceLog& trace = *session_->trace();
  const double end_s = core::monotonic_seconds();
  for (std::size_t i = 0; i < own_.size(); ++i)
    trace.add_value(own_counters_[i], end_s, own_[i]);
  telemetry::Marks& marks = session_->scene().marks();
  while (timed_marks_ < options_.marks.size() &&
         options_.marks[timed_marks_].time_s <= record_.time_s)
    marks.set(options_.marks[timed_marks_++].name);
  for (std::string& name : marks.take()) {
    trace.add_span(marks_track_, trace.intern(name), end_s - record_.frame_ms * 1e-3, end_s,
                   record_.index);
    log_->add_mark(std::move(name));
  }
}

// Logs the last frame, and late results of earlier frames.
void Flight::log_frame() {
  const scene::Scene& scene = session_->scene();
  if (has_virtual_frames(options_.session)) {
    log_->add(record_, {}, own_);
  } else {
    log_->add(record_, scene.system_ms(), own_);
  }
  log_marks();
  if (const auto& gpu = scene.drawn().gpu; gpu && !has_virtual_frames(options_.session))
    log_->set_gpu_ms(
        gpu->frame, gpu->ms, gpu->shadows_ms,
        session_->renderer().device().pass_times ? gpu->pass_ms : std::span<const double>());
  const scene::Statistics statistics = scene.statistics();
  for (const float ms : statistics.meshes.time_to_visible_ms)
    log_->add_time_to_visible(record_.time_s, ms);
  for (const auto& cost : statistics.meshes.costs) {
    log_->add_cost_error(record_.time_s, cost.predicted_s, cost.actual_s);
  }
}

// Ends the flight and writes its measurements, also if it ended early.
FlightReport Flight::land(bool whole) {
  recorded_ = false;
  const auto written =
      core::catch_out_of_memory("the outputs of the flight", [&]() -> core::Result<void> {
        report_.summary = telemetry::summarise(*log_, run_facts(whole), options_.warmup_seconds);
        write_outputs(report_.summary);
        return {};
      });
  if (!written) report_.failures.push_back(written.error());
  session_->scene().end_trace();  // the flight is over
  report_.validation_messages = session_->renderer().validation_messages();
  return report_;
}

core::Result<FlightReport> Flight::run() {
  const world::World& world = session_->scene().world();
  pose_ = path_ ? path_->pose_at(0, world) : session_->home();
  const auto prepared = core::catch_out_of_memory("preparing the first view",
                                                  [this] { return session_->prepare(pose_); });
  if (!prepared) return tl::unexpected(prepared.error());
  if (options_.reference_load) measure_reference_load();
  session_->set_now(0);
  recorded_ = true;
  load_.emplace();
  const auto flown = core::catch_out_of_memory("the flight", [this] { return loop(); });
  FlightReport report = land(flown.has_value());
  if (!flown) {
    for (const core::Error& failure : report.failures)
      core::log_error(failure.message);
    return tl::unexpected(flown.error());
  }
  const auto told =
      call_plugins(options_.session.plugins, &Plugin::on_end, "on_end", *session_, report);
  if (!told) return tl::unexpected(told.error());
  if (!stays_open()) return report;
  tell_end(report);
  user_flies_ = true;
  const auto flown_on = core::catch_out_of_memory("the flight", [this] { return loop(); });
  if (!flown_on) return tl::unexpected(flown_on.error());
  report.validation_messages = session_->renderer().validation_messages();
  return report;
}

}  // namespace psygen::app
