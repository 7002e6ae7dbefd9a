// Options of a session and of a flight. Plain values: a game fills a SessionOptions, the command
// line of `psygen fly` a FlightOptions.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/surface_provider.hpp"
#include "engine/models/registry.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/settings.hpp"
#include "engine/telemetry/marks.hpp"

namespace psygen::scene {
struct Systems;
}

namespace psygen::synthesis {
class RemoteModelers;
}

namespace psygen::world {
class ResourceLoader;
}

namespace psygen::app {

class Session;
struct FlightReport;

// Code that a game adds. All members except the name are optional. An exception of any type in one
// of them becomes an error that names plugin and member, and ends the session.
struct Plugin {
  std::string name = {};
  // Registers model types before the world file is read.
  std::function<core::Result<void>(models::Registry&)> register_models = {};
  // Adds components, resources, events and systems. Called once, before the cache is filled.
  std::function<core::Result<void>(scene::Systems&)> add_systems = {};
  // Called once before the first tick.
  std::function<void(Session&)> on_start = {};
  // Called at the end of every fixed step of the simulation, with its length in seconds.
  std::function<void(Session&, double)> on_step = {};
  // Called after every tick with its time step in seconds.
  std::function<void(Session&, double)> on_frame = {};
  // Called once after a flight has ended and written its outputs. A window may stay open.
  std::function<void(Session&, const FlightReport&)> on_end = {};
  // Draws Dear ImGui windows over the image, once per tick, before the systems run (docs/hud.md).
  // Session::input() excludes input that ImGui uses. A call without its partner (End, PopID) fails
  // like an exception.
  std::function<void(Session&)> on_gui = {};
};

// Lets plugins register their model types, in order. Fails with the first error or exception; the
// message names the plugin.
core::Result<void> register_models(const std::vector<Plugin>& plugins, models::Registry& registry);

// Options of a session.
struct SessionOptions {
  std::filesystem::path world_file;
  // Text of the world, instead of the file's content. The file's name then appears only in messages
  // and locates the folder of its images.
  std::optional<std::string> world_text;
  // Loads the external resources of the world; null: handmade::files().
  std::shared_ptr<const world::ResourceLoader> files;
  core::Extent size{1280, 720};
  bool headless = false;
  // Draws into the program's own window, such as an editor's. It outlives the session, which then
  // opens no window and takes no input. Null: the session opens a window unless headless.
  core::SurfaceProvider* surface = nullptr;
  bool validation = false;
  bool fullscreen = false;               // windows only: start in full screen
  bool vsync = true;                     // windows only
  std::string device_name;               // index, UUID or part of the name; empty: the best device
  std::optional<render::Preset> preset;  // none: chosen by GPU
  render::RenderPath render_path = render::RenderPath::kAuto;
  render::View view = render::View::kNormal;
  std::optional<double> start_hour;  // of the day, 0 to 24; the world must have one
  // Frame rate held by a lower resolution and a larger screen-space error; 0: both are fixed.
  // Default: 60 in a window, 0 headless. At most 10^6.
  std::optional<double> target_hz;
  bool prefill = true;             // fill the cache for the first pose before the first tick
  std::optional<bool> pass_times;  // RendererOptions::pass_times
  bool trace = false;              // record spans of systems and modelers (Session::trace())
  scene::SceneSettings scene;
  // Remote modelers of other processes (docs/cluster.md). They serve only this session and outlive
  // it. Null: none.
  synthesis::RemoteModelers* remote = nullptr;
  std::vector<Plugin> plugins;
  // Set by any thread or a signal handler to end the session after the current tick.
  const std::atomic<bool>* stop = nullptr;
};

// A mark that a flight sets by itself, in the first frame at this time or later.
struct TimedMark {
  std::string name;
  double time_s = 0;  // on the flight's clock
};

// Options of a flight.
struct FlightOptions {
  SessionOptions session;
  std::filesystem::path path_file;  // empty: the camera turns in place, or the user flies
  // Provides the camera instead, for example a game's: called for each frame with the seconds since
  // the last one.
  std::function<core::CameraPose(Session&, double)> camera;
  std::filesystem::path out_folder;  // empty: writes only images, to the current folder
  // If both are 0, the flight lasts as long as the path; without a path 27 s headless, otherwise
  // until the window is closed. If one is set, the window closes at the end of the flight.
  double seconds = 0;
  std::uint64_t frames = 0;
  double fixed_step_hz = 0;        // 0: the flight follows the wall clock
  std::uint64_t images_every = 0;  // every Nth frame as a PNG; 0: none
  bool loop = false;               // repeats the path
  double warmup_seconds = 1;       // excluded from all statistics
  bool hash_world = true;          // computes hash.world of the summary (about 50 ms)
  bool reference_load = false;     // measures it before and after the flight (seconds)
  std::vector<TimedMark> marks;    // in the order of time
  std::vector<telemetry::SectionRange> sections;  // of the summary, with other names each
};

}  // namespace psygen::app
