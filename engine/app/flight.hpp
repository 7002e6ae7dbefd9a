// A flight through a world along a path or under user control, with its log and its outputs. In a
// window it responds to the keys of kKeyHelp. `psygen fly` runs one. Games drive a Session
// themselves. Main thread only.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "engine/app/hud.hpp"
#include "engine/app/session.hpp"
#include "engine/platform/fly_camera.hpp"
#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/output_file.hpp"
#include "engine/telemetry/summary.hpp"
#include "engine/telemetry/trace_log.hpp"
#include "engine/world/camera_path.hpp"

namespace psygen::app {

// Files of the output folder, which exist after the flight.
inline constexpr std::array kFlightFiles{"summary.json", "report.html", "frames.csv", "trace.json"};

// The result of a flight.
struct FlightReport {
  telemetry::Summary summary;
  std::vector<std::filesystem::path> files;  // files written
  // Files that could not be written, with the reason. The flight continues, but writes no images
  // after the first failure.
  std::vector<core::Error> failures;
  std::vector<std::string> validation_messages;
};

// One flight. Owns its session.
class Flight {
 public:
  // Creates the output folder, reads the path and creates the session. Fails like
  // Session::create(), and with kParse or kIo for the path and the folder.
  static core::Result<std::unique_ptr<Flight>> create(FlightOptions options);

  // Flies until the path, the time or the user ends it, then writes all possible outputs. If the
  // path ends in a window, the user continues to fly until the window is closed; the report covers
  // only the flight. Fails with kInterrupted if the window is closed before the first frame. Call
  // once.
  core::Result<FlightReport> run();
  // True while frames belong to the report: false before the flight and after its end.
  bool is_recorded() const { return recorded_; }

  // The session of the flight; lives as long as the flight.
  Session& session() { return *session_; }
  // Rows of the frames so far.
  const telemetry::FrameLog& log() const { return *log_; }

 private:
  explicit Flight(FlightOptions options) : options_(std::move(options)) {}
  core::Result<void> open();
  void open_log();

  core::Result<void> loop();
  core::Result<void> fly_frame(double dt_s);
  core::CameraPose next_pose(double dt_s);
  bool wants_more() const;
  bool stays_open() const;
  bool saves_picture() const;
  core::Result<void> save_numbered_picture();
  void log_frame();
  void measure_presents();
  void take_own();
  void log_marks();
  FlightReport land(bool whole);

  void handle_keys();
  void write_over_picture();
  void save_screenshot();
  void change_preset();
  void tell_end(const FlightReport& report);

  telemetry::RunFacts run_facts(bool whole);
  void measure_reference_load();
  telemetry::ReferenceLoad reference_load();
  void write_outputs(const telemetry::Summary& summary);
  void note_written(const std::filesystem::path& file, const core::Result<void>& result);

  FlightOptions options_;
  std::optional<telemetry::OutputFolder> out_;  // of options_.out_folder
  std::unique_ptr<Session> session_;
  std::optional<world::CameraPath> path_;
  std::unique_ptr<telemetry::FrameLog> log_;
  std::optional<telemetry::LoadMeter> load_;  // of the recorded flight
  std::optional<telemetry::ReferenceLoad> reference_before_;
  telemetry::Count peak_before_bytes_;  // of resident memory, before the reference load
  platform::FlyCamera fly_camera_;
  core::CameraPose pose_;
  std::uint64_t frames_ = 0;
  telemetry::FrameRecord record_;                         // of the last frame, completed
  double usual_ms_ = 0;                                   // of the last frame that is not excluded
  std::vector<double> own_;                               // the game's figures in the last frame
  std::vector<telemetry::TraceLog::Track> own_counters_;  // of the trace, one for each figure
  telemetry::TraceLog::Track marks_track_ = 0;            // of the trace
  std::size_t timed_marks_ = 0;                           // of options_.marks that were set
  // The frame before, if its time can be compared with the next one's.
  struct Presented {
    double handed_over_s = 0, time_s = 0;
  };
  std::optional<Presented> presented_;
  bool recorded_ = false;
  bool user_flies_ = false;
  Hud hud_;
  bool photograph_ = false;                      // the next frame, for a screenshot
  std::optional<render::Preset> wanted_preset_;  // set after the next frame
  std::uint64_t images_hash_ = 0;                // of the numbered images, in order
  std::uint64_t images_ = 0;
  FlightReport report_;
  bool pictures_failed_ = false;
};

}  // namespace psygen::app
