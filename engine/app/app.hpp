// An application: window or headless, a scene, a camera that flies a path or obeys the user, the
// main loop, and what a run writes. Games use it with plugins; `psygen fly` is one with none. Main
// thread only.
#pragma once

#include <memory>
#include <optional>

#include "engine/app/options.hpp"
#include "engine/app/overlay.hpp"
#include "engine/platform/fly_camera.hpp"
#include "engine/platform/window.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/scene.hpp"
#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/summary.hpp"
#include "engine/telemetry/trace_log.hpp"
#include "engine/world/camera_path.hpp"

namespace psygen::app {

struct FlightReport {
  telemetry::Summary summary;
  std::vector<std::filesystem::path> files;  // what was written
  std::vector<std::string> validation_messages;
};

class App {
 public:
  // Reads the files, opens device and window, starts the modelers. Every failure is a sentence:
  // kParse for files, kNoDevice for a missing device or display, kOverBudget, kInvalidArgument,
  // kIo.
  static core::Result<std::unique_ptr<App>> create(Options options);
  ~App();

  // Flies until the path, the time or the user ends it, then writes the outputs.
  core::Result<FlightReport> run();

  // One frame with a pose, for programs that have a loop of their own.
  core::Result<void> frame(const core::CameraPose& pose, double dt_s);
  // The last frame as a PNG.
  core::Result<void> save_picture(const std::filesystem::path& file);

  // A model hangs and its modeler still writes: a program in this state should leave through
  // std::_Exit, because the modeler's memory must not be torn down.
  bool has_hung_modelers() const;

  // Where the camera stands when nobody has moved it: above the ground in the middle of the world.
  core::CameraPose home() const;
  scene::Scene& scene() { return *scene_; }
  render::Renderer& renderer() { return *renderer_; }
  const Options& options() const { return options_; }

 private:
  explicit App(Options options);
  core::Result<void> open();
  core::Result<void> prepare(const core::CameraPose& first);
  core::Result<void> loop();
  core::Result<void> fly_frame(std::uint64_t index, double flight_s, double dt_s);
  bool saves_picture(std::uint64_t frame) const;
  void wait_while_minimised();
  core::Extent picture_size() const;
  void save_screenshot();
  bool wants_more(double flight_s, std::uint64_t frames) const;
  core::CameraPose next_pose(double flight_s, double dt_s);
  void handle_window();
  core::Result<void> save_numbered_picture(std::uint64_t frame);
  double governed_ms(double frame_ms) const;
  void log_frame();
  telemetry::RunFacts run_facts();
  core::Result<void> write_outputs(const telemetry::Summary& summary);

  Options options_;
  std::unique_ptr<platform::Window> window_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<telemetry::TraceLog> trace_;
  std::unique_ptr<scene::Scene> scene_;
  std::optional<world::CameraPath> path_;
  std::unique_ptr<telemetry::FrameLog> log_;
  platform::FlyCamera fly_camera_;
  platform::InputState input_;
  core::CameraPose pose_;
  bool user_flies_ = false;
  bool overlay_ = true;
  bool closed_ = false;
  bool pictured_ = false;  // the frame that goes on, by a plugin
  Overlay overlay_figures_;
  std::uint64_t last_image_hash_ = 0;
  std::uint64_t images_hash_ = 0;  // of the numbered pictures, in order
  std::uint64_t images_ = 0;
  std::vector<std::filesystem::path> files_;
};

}  // namespace psygen::app
