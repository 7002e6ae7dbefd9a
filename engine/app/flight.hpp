// A flight through a world along a path, or where the user flies, with its log and its outputs. In
// a window it obeys the keys of keys.hpp. `psygen fly` runs one. Games drive a Session themselves.
// Main thread only.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/app/hud.hpp"
#include "engine/app/session.hpp"
#include "engine/platform/fly_camera.hpp"
#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/summary.hpp"
#include "engine/world/camera_path.hpp"

namespace psygen::app {

// The result of a flight.
struct FlightReport {
  telemetry::Summary summary;
  std::vector<std::filesystem::path> files;  // what was written
  // What could not be written: each file with the reason. The flight went on, without any more
  // pictures after the first one that failed.
  std::vector<core::Error> failures;
  std::vector<std::string> validation_messages;
};

// One flight. Owns its session.
class Flight {
 public:
  // Creates the output folder, reads the path and creates the session; fails as Session::create(),
  // and with kParse or kIo for the path and the folder.
  static core::Result<std::unique_ptr<Flight>> create(FlightOptions options);

  // Flies until the path, the time or the user ends it, then writes the outputs: each that can be.
  // Where the path has ended in a window, the user flies on until the window is closed; the report
  // is that of the flight alone. Fails with kInterrupted where the window was closed before the
  // first frame. Once.
  core::Result<FlightReport> run();
  // Whether what happens now belongs to the report. False before the flight, and after its end.
  bool is_recorded() const { return recorded_; }

  // The session that it stands on; lives as long as the flight.
  Session& session() { return *session_; }
  // The rows of the frames so far.
  const telemetry::FrameLog& log() const { return *log_; }

 private:
  explicit Flight(FlightOptions options) : options_(std::move(options)) {}
  core::Result<void> open();

  core::Result<void> loop();
  core::Result<void> fly_frame(double dt_s);
  core::CameraPose next_pose(double dt_s);
  bool wants_more() const;
  bool stays_open() const;
  bool saves_picture() const;
  core::Result<void> save_numbered_picture();
  void log_frame();
  FlightReport land(bool whole);

  void handle_keys();
  void write_over_picture();
  void save_screenshot();
  void change_preset();
  void tell_end(const FlightReport& report);

  telemetry::RunFacts run_facts(bool whole);
  void write_outputs(const telemetry::Summary& summary);
  void note_written(const std::filesystem::path& file, const core::Result<void>& result);

  FlightOptions options_;
  std::unique_ptr<Session> session_;
  std::optional<world::CameraPath> path_;
  std::unique_ptr<telemetry::FrameLog> log_;
  platform::FlyCamera fly_camera_;
  core::CameraPose pose_;
  std::uint64_t frames_ = 0;
  double usual_ms_ = 0;  // of the last frame that nothing sets apart
  bool recorded_ = false;
  bool user_flies_ = false;
  Hud hud_;
  bool photograph_ = false;                      // the next frame, for the user
  std::optional<render::Preset> wanted_preset_;  // after the next frame
  std::uint64_t images_hash_ = 0;                // of the numbered pictures, in order
  std::uint64_t images_ = 0;
  std::vector<std::filesystem::path> files_;
  std::vector<core::Error> failures_;
  bool pictures_failed_ = false;
};

}  // namespace psygen::app
