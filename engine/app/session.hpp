// A running engine: window or headless, input, renderer and scene. A program with its own loop
// drives one:
// while (session.poll()) session.tick(pose, dt_s);
// A session handles closing, resizing and minimising of its window, but no keys. A Flight adds a
// path and measurements. Main thread only.
#pragma once

#include <atomic>
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

// Include the headers of the types that you use; most programs need none (docs/package.md).
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
class ResourceLoader;
struct World;
}  // namespace psygen::world

namespace psygen::app {

class Gui;
class Loading;
class PluginSystems;

class Session {
 public:
  // Reads the world, opens device and window, and starts the modelers. Fails with kParse for files,
  // kNoDevice for a missing GPU or display, kOverBudget, kInvalidArgument, kIo, and kInterrupted if
  // the window was closed during start-up.
  static core::Result<std::unique_ptr<Session>> create(SessionOptions options);
  ~Session();

  // Prepares the first tick with this pose according to the paradigm: fills the cache, or
  // amplifies. Ends early once SessionOptions::stop is set. Fails with kInterrupted if the window
  // was closed, and with kInvalidArgument for an invalid pose (core::is_valid).
  core::Result<void> prepare(const core::CameraPose& first);

  // Processes the events of the window: input(), its size, its end. Blocks while it is minimised.
  // For the program's own surface (SessionOptions::surface), only follows the size and never
  // blocks. Returns false once the session is over: close(), a closed window, or
  // SessionOptions::stop.
  bool poll();
  // Runs one frame with a pose: runs the systems, draws and presents, then advances the clock by
  // `dt_s` and calls the plugins. Its duration controls the detail of the next frames
  // (SessionOptions::target_hz). Fails with kInvalidArgument for a time outside 0 to
  // 10^6 s, and if the clock would pass 10^9 s, where a double no longer counts microseconds.
  // After any other error, such as kDeviceLost or an exception of a plugin's hook or system
  // (kInternal or kOutOfMemory; the message names both), the session is over: further ticks return
  // that error again.
  core::Result<void> tick(const core::CameraPose& pose, double dt_s);
  // Makes the next poll() return false.
  void close() { closed_ = true; }
  // Cancels close() and the closing of the window, for example to ask the player first. The next
  // poll() returns true unless a tick has failed or SessionOptions::stop is set.
  void keep_open();
  bool over() const { return closed_ || failure_ || stopped(); }
  // True if SessionOptions::stop is set.
  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  // The user's input between the last two polls, without input used by ImGui. Empty when headless.
  const platform::InputState& input() const { return input_; }
  // The actions of a game (docs/input.md). poll() feeds them, and every fixed step of the
  // simulation begins with their states. A resource of all systems: input::Actions.
  input::Actions& actions() { return actions_; }
  // From the next fixed step on, action states come from a recording, until its end.
  void replay(input::Replay replay) { replay_ = std::move(replay); }
  bool replays() const { return replay_.has_value(); }

  // While a session is paused, ticks draw, but the clock stands still and plugins receive a time
  // step of zero. Pausing also stops actions; input() continues.
  void set_paused(bool paused) { paused_ = paused; }
  bool paused() const { return paused_; }

  // The HUD of the next frames. It persists until the game changes it (docs/hud.md).
  render::HudDrawing& hud();
  // The ImGui of the plugins' on_gui, created on first use.
  Gui& gui();
  // Clock in seconds at which the next tick is drawn. Times beyond ±10^9 s are ignored.
  double now_s() const;
  void set_now(double now_s);
  // Pixels of the next frame; {0, 0} while the window is minimised.
  core::Extent picture_size() const;

  // The image of the last tick.
  core::Result<image::Image> picture();
  // Saves the image of the last tick as a PNG; the name must end in .png.
  core::Result<void> save_picture(const std::filesystem::path& file);
  core::Result<void> write_picture(const std::filesystem::path& file, const image::Image& image);
  // Files written by save_picture() since the last call.
  std::vector<std::filesystem::path> take_saved() { return std::exchange(saved_, {}); }

  // Replaces the world by that of a text, as Scene::set_world(): for editors. Fails like
  // world::parse_world(). Also fails with kInvalidArgument if the ground textures change
  // (Palette::images), which the renderer reads only at the start; nothing changes then.
  core::Result<void> set_world(std::string_view text);
  // Replaces the world in two steps: any thread may call the returned function while the session
  // lives, which includes the plugins' register_models; then the main thread calls show_world()
  // with its result. The function fails with kInterrupted soon after `cancelled` (may be null) is
  // set.
  std::function<core::Result<scene::PreparedWorld>()> prepare_world(
      std::string text, std::shared_ptr<const std::atomic<bool>> cancelled = nullptr) const;
  // Sets the loader of external resources for later worlds (SessionOptions::files).
  void set_files(std::shared_ptr<const world::ResourceLoader> files) {
    options_.files = std::move(files);
  }
  core::Result<void> show_world(scene::PreparedWorld prepared);

  // Draws with another preset from the next tick on. The window stays responsive during the change.
  // Fails like Renderer::set_preset(), also if the session ends during the change; the old preset
  // then stays.
  core::Result<void> set_preset(render::Preset preset);

  // Initial camera pose: above the ground in the centre of the world.
  core::CameraPose home() const;
  scene::Scene& scene() { return *scene_; }
  const scene::Scene& scene() const { return *scene_; }
  render::Renderer& renderer() { return *renderer_; }
  // Null when headless.
  platform::Window* window() { return window_.get(); }
  // Null without SessionOptions::trace.
  telemetry::TraceLog* trace() { return trace_.get(); }
  const SessionOptions& options() const { return options_; }

  // True if a model hangs and its modeler still writes. The program should then leave through
  // std::_Exit, because the modeler's memory must not be freed.
  bool has_hung_modelers() const;

 private:
  explicit Session(SessionOptions options);
  core::Result<void> open();
  core::Result<world::World> read_world_with_progress(models::Registry& registry) const;
  core::Result<world::World> read_world(std::optional<std::string_view> text,
                                        models::Registry& registry,
                                        const world::ResourceLoader* files) const;
  core::Result<void> open_window(const std::string& title);
  core::Result<void> open_renderer(GroundPictures ground, Loading& loading);
  core::Result<void> open_scene(world::World world, models::Registry registry, Loading& loading);
  void take_events();
  void follow_surface();
  void resize(core::Extent size);
  core::Result<void> draw_frame(const core::CameraPose& pose, double dt_s);
  core::Result<void> draw_gui(double dt_s);
  void tell_governor(double tick_ms, bool took_pictures);
  core::Result<void> add_systems();
  void step_actions(input::Actions& actions);
  core::Result<void> start();

  SessionOptions options_;
  // Destroyed in reverse order: the scene returns its memory to the renderer.
  std::unique_ptr<platform::Window> window_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<telemetry::TraceLog> trace_;
  input::Actions actions_;
  std::optional<input::Replay> replay_;
  std::unique_ptr<PluginSystems> plugin_systems_;
  std::optional<core::Error> failure_;  // of a tick; the session is over
  std::unique_ptr<scene::Scene> scene_;
  std::unique_ptr<Gui> gui_;                // null until it is used
  platform::InputState all_input_, input_;  // the latter without input used by ImGui
  platform::InputFilter filter_;
  core::Extent surface_size_;  // at the last poll
  bool paused_ = false;
  bool closed_ = false;
  bool started_ = false;
  std::vector<std::filesystem::path> saved_;
};

}  // namespace psygen::app
