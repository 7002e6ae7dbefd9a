// An application: window or headless, a scene, a camera that flies a path or obeys the user, the
// main loop, and what a run writes. Games use it with plugins; `psygen fly` is one with none. Main
// thread only.
#pragma once

#include <memory>
#include <optional>

#include "engine/app/hud.hpp"
#include "engine/app/loading.hpp"
#include "engine/app/options.hpp"
#include "engine/image/image.hpp"
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
  // What could not be written: each file with the reason. The flight went on, without any more
  // pictures after the first one that failed.
  std::vector<core::Error> failures;
  std::vector<std::string> validation_messages;
};

class App {
 public:
  // Reads the files, opens device and window, starts the modelers. Every failure is a sentence:
  // kParse for files, kNoDevice for a missing device or display, kOverBudget, kInvalidArgument,
  // kIo; kInterrupted where the window was closed meanwhile.
  static core::Result<std::unique_ptr<App>> create(Options options);
  ~App();

  // Flies until the path, the time or the user ends it, then writes the outputs: each that can be.
  // Where the path has ended in a window, the user flies on until the window is closed; the report
  // is that of the flight alone. Fails with kInterrupted where the window was closed before the
  // first frame.
  core::Result<FlightReport> run();
  // Whether what happens now belongs to the flight of run().
  bool flying() const { return flying_; }

  // Makes what the first frame with this pose needs, as the paradigm says: fills the cache, or
  // amplifies. Ends early once Options::stop is set; kInterrupted once the window was closed.
  core::Result<void> prepare(const core::CameraPose& first);
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
  core::Result<void> open_window(const std::string& title);
  core::Result<void> open_renderer(Loading& loading);
  core::Result<void> open_scene(world::World world, models::Registry registry, Loading& loading);
  core::Extent picture_size() const;

  core::Result<void> loop();
  core::Result<void> fly_frame(double dt_s);
  core::CameraPose next_pose(double dt_s);
  bool wants_more() const;
  bool stays_open() const;
  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }
  bool saves_picture() const;
  core::Result<void> save_numbered_picture();
  FlightReport land(bool whole);

  void handle_window();
  void handle_keys();
  void wait_while_minimised();
  void write_over_picture();
  void save_screenshot();
  void change_preset();
  void tell_end(const FlightReport& report);

  core::Result<image::Image> last_picture();
  core::Result<void> write_picture(const std::filesystem::path& file, const image::Image& image);
  double governed_ms(double frame_ms) const;
  void log_frame();
  telemetry::RunFacts run_facts(bool whole);
  void write_outputs(const telemetry::Summary& summary);
  void note_written(const std::filesystem::path& file, const core::Result<void>& result);

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
  double flight_s_ = 0;  // the flight's clock, which goes on after its end
  std::uint64_t frames_ = 0;
  bool flying_ = false;
  bool user_flies_ = false;
  bool closed_ = false;
  Hud hud_;
  bool pictured_ = false;                        // the frame that goes on, by a plugin
  bool photograph_ = false;                      // the next frame, for the user
  std::optional<render::Preset> wanted_preset_;  // after the next frame
  std::uint64_t images_hash_ = 0;                // of the numbered pictures, in order
  std::uint64_t images_ = 0;
  std::vector<std::filesystem::path> files_;
  std::vector<core::Error> failures_;
  bool pictures_failed_ = false;
};

}  // namespace psygen::app
