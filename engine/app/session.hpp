// A running engine: window or headless, input, renderer and scene. A program with a loop of its own
// drives one:
//   while (session.poll()) session.tick(pose, dt_s);
// A session handles closing, resizing and minimising of its window, and knows no keys. It flies no
// path and writes no figures: that is a Flight. Main thread only.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/app/ground_pictures.hpp"
#include "engine/app/options.hpp"
#include "engine/image/image.hpp"
#include "engine/input/recording.hpp"
#include "engine/platform/input.hpp"

// Include the header of what you use of these: most programs need none (docs/package.md).
namespace psygen::platform {
class Window;
}
namespace psygen::render {
class Renderer;
struct HudDrawing;
}  // namespace psygen::render
namespace psygen::scene {
class Scene;
struct PreparedWorld;
}  // namespace psygen::scene
namespace psygen::telemetry {
class TraceLog;
}
namespace psygen::world {
class FilesBeside;
struct World;
}  // namespace psygen::world

namespace psygen::app {

class Gui;
class Loading;

class Session {
 public:
  // Reads the world, opens device and window, starts the modelers. Every failure is a sentence:
  // kParse for files, kNoDevice for a missing device or display, kOverBudget, kInvalidArgument,
  // kIo; kInterrupted where the window was closed meanwhile.
  static core::Result<std::unique_ptr<Session>> create(SessionOptions options);
  ~Session();

  // Makes what the first tick with this pose needs, as the paradigm says: fills the cache, or
  // amplifies. Ends early once SessionOptions::stop is set; kInterrupted once the window was
  // closed, kInvalidArgument for a pose that is none (core::is_valid).
  core::Result<void> prepare(const core::CameraPose& first);

  // Takes the events of the window: input(), its size, its end. Waits while it is minimised. Of a
  // surface of the program's own (SessionOptions::surface) it takes the size, and never waits.
  // False once the session is over: close(), a closed window, or SessionOptions::stop.
  bool poll();
  // One frame with a pose: runs the systems, draws and presents. Then moves the clock on by `dt_s`
  // and calls the plugins. What it took governs how fine the next pictures are
  // (SessionOptions::target_hz). Fails with kInvalidArgument for a time that is negative or not
  // finite; with kDeviceLost and the like the session is over.
  core::Result<void> tick(const core::CameraPose& pose, double dt_s);
  // The next poll() is the last.
  void close() { closed_ = true; }
  bool over() const { return closed_ || stopped(); }
  // Whether SessionOptions::stop is set.
  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  // What the user did since the last poll but one, without what ImGui takes. Nothing when headless.
  const platform::InputState& input() const { return input_; }
  // The actions of a game (docs/input.md). poll() feeds them, and every fixed step of the
  // simulation begins with theirs. A resource of all systems: input::Actions.
  input::Actions& actions() { return actions_; }
  // From the next fixed step on the states come from a recording, until its end.
  void replay(input::Replay replay) { replay_ = std::move(replay); }
  bool replays() const { return replay_.has_value(); }

  // While a session is paused, ticks draw, but the clock stands still and plugins are told that no
  // time has passed. The same for what the user does: input() goes on.
  void set_paused(bool paused) { paused_ = paused; }
  bool paused() const { return paused_; }

  // What the game writes over the next pictures, until it writes something else (docs/hud.md).
  render::HudDrawing& hud();
  // The ImGui of the plugins' on_gui; it is made when it is first asked for.
  Gui& gui();
  // The clock: seconds, at which the next tick is drawn. Times that are not finite are ignored.
  double now_s() const;
  void set_now(double now_s);
  // Pixels of the next picture; {0, 0} while the window is minimised.
  core::Extent picture_size() const;

  // The picture of the last tick.
  core::Result<image::Image> picture();
  // The same as a PNG; the name must end in .png.
  core::Result<void> save_picture(const std::filesystem::path& file);
  core::Result<void> write_picture(const std::filesystem::path& file, const image::Image& image);
  // What save_picture() has written since the last call.
  std::vector<std::filesystem::path> take_saved() { return std::exchange(saved_, {}); }

  // Replaces the world by that of a text, as Scene::set_world(): for editors. Fails as
  // world::parse_world(), and with kInvalidArgument for other pictures of the ground
  // (Palette::images), which the renderer takes only at the start; nothing has changed then.
  core::Result<void> set_world(std::string_view text);
  // The same in two steps: any thread may call what this returns, while the session lives, also
  // the plugins' register_models; then the main thread shows the world that it has made.
  std::function<core::Result<scene::PreparedWorld>()> prepare_world(std::string text) const;
  // The files beside the worlds of the next texts (SessionOptions::files).
  void set_files(std::shared_ptr<const world::FilesBeside> files) {
    options_.files = std::move(files);
  }
  core::Result<void> show_world(scene::PreparedWorld prepared);

  // Draws with another preset from the next tick on. The window stays alive meanwhile. Fails as
  // Renderer::set_preset(), also where the session ended meanwhile; the old one stays then.
  core::Result<void> set_preset(render::Preset preset);

  // Where the camera stands when nobody has moved it: above the ground in the middle of the world.
  core::CameraPose home() const;
  scene::Scene& scene() { return *scene_; }
  const scene::Scene& scene() const { return *scene_; }
  render::Renderer& renderer() { return *renderer_; }
  // Null when headless.
  platform::Window* window() { return window_.get(); }
  // Null without SessionOptions::trace.
  telemetry::TraceLog* trace() { return trace_.get(); }
  const SessionOptions& options() const { return options_; }

  // A model hangs and its modeler still writes: a program in this state should leave through
  // std::_Exit, because the modeler's memory must not be torn down.
  bool has_hung_modelers() const;

 private:
  explicit Session(SessionOptions options);
  core::Result<void> open();
  core::Result<world::World> read_world(std::optional<std::string_view> text,
                                        models::Registry& registry,
                                        const world::FilesBeside* files) const;
  core::Result<void> open_window(const std::string& title);
  core::Result<void> open_renderer(GroundPictures ground, Loading& loading);
  core::Result<void> open_scene(world::World world, models::Registry registry, Loading& loading);
  void take_events();
  void follow_surface();
  void resize(core::Extent size);
  core::Result<void> draw_gui(double dt_s);
  void tell_governor(double tick_ms, bool took_pictures);
  core::Result<void> add_systems();
  void step_actions(input::Actions& actions);
  core::Result<void> start();

  SessionOptions options_;
  // Destroyed in the opposite order: the scene gives its memory back to the renderer.
  std::unique_ptr<platform::Window> window_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<telemetry::TraceLog> trace_;
  input::Actions actions_;
  std::optional<input::Replay> replay_;
  std::unique_ptr<scene::Scene> scene_;
  std::unique_ptr<Gui> gui_;                // null until it is needed
  platform::InputState all_input_, input_;  // the latter without what ImGui takes
  platform::InputFilter filter_;
  core::Extent surface_size_;  // when it was last looked at
  bool paused_ = false;
  bool closed_ = false;
  bool started_ = false;
  std::vector<std::filesystem::path> saved_;
};

}  // namespace psygen::app
