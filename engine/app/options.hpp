// What a program chooses about a session and about a flight. Values only: a game fills a
// SessionOptions, the command line of `psygen fly` a FlightOptions.
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

namespace psygen::scene {
struct Systems;
}

namespace psygen::synthesis {
class RemoteModelers;
}

namespace psygen::world {
class FilesBeside;
}

namespace psygen::app {

class Session;
struct FlightReport;

// Code that a game adds. Every member but the name may be empty. An exception of any of them ends
// the session with an error that names the plugin.
struct Plugin {
  std::string name = {};
  // Registers model types before the world file is read.
  std::function<core::Result<void>(models::Registry&)> register_models = {};
  // Adds components, resources, events and systems. Once, before the cache is filled.
  std::function<core::Result<void>(scene::Systems&)> add_systems = {};
  // Called once before the first tick.
  std::function<void(Session&)> on_start = {};
  // Called at the end of every fixed step of the simulation, with its length in seconds.
  std::function<void(Session&, double)> on_step = {};
  // Called after every tick with its time step in seconds.
  std::function<void(Session&, double)> on_frame = {};
  // Called once when a flight has ended and its outputs are written. A window may stay open.
  std::function<void(Session&, const FlightReport&)> on_end = {};
  // Draws windows of Dear ImGui over the picture, once a tick, before the systems run
  // (docs/hud.md). Input that ImGui takes does not reach Session::input().
  std::function<void(Session&)> on_gui = {};
};

// Lets plugins register their model types, in order. Fails as the first that does, also by an
// exception; the error names the plugin.
core::Result<void> register_models(const std::vector<Plugin>& plugins, models::Registry& registry);

// Options of a session.
struct SessionOptions {
  std::filesystem::path world_file;
  // The world in place of what the file has, of which only the name is used then: in messages, and
  // for the folder of its pictures.
  std::optional<std::string> world_text;
  // What reads the files beside it; null: handmade::files().
  std::shared_ptr<const world::FilesBeside> files;
  core::Extent size{1280, 720};
  bool headless = false;
  // Draws into a window of the program's own, as of an editor; outlives the session, which opens
  // none itself and takes no input then. Null: a window, unless headless.
  core::SurfaceProvider* surface = nullptr;
  bool validation = false;
  bool fullscreen = false;               // windows only: cover the monitor from the start on
  bool vsync = true;                     // windows only
  std::string device_name;               // part of a name; empty: the best device
  std::optional<render::Preset> preset;  // none: what suits the device
  render::RenderPath render_path = render::RenderPath::kAuto;
  render::View view = render::View::kNormal;
  std::optional<double> start_hour;  // of the day, 0 to 24; the world must have one
  // Frames a second that are held by fewer pixels and a larger error of levels of detail; 0: both
  // are fixed.
  // Not set: 60 in a window, 0 headless. At most 10^6.
  std::optional<double> target_hz;
  bool prefill = true;  // fill the cache for the first pose before the first tick
  bool trace = false;   // record spans of systems and modelers (Session::trace())
  scene::Settings scene;
  // Modelers of other processes, as of a cluster (docs/cluster.md). They serve this session only,
  // and outlive it. Null: none.
  synthesis::RemoteModelers* remote = nullptr;
  std::vector<Plugin> plugins;
  // Set from anywhere (a signal handler, another thread) to end the session after this tick.
  const std::atomic<bool>* stop = nullptr;
};

// Options of a flight.
struct FlightOptions {
  SessionOptions session;
  std::filesystem::path path_file;  // empty: the camera stands and turns, or the user flies
  // Who holds the camera in place of all that, such as a game: called for each frame with the
  // seconds since the last one.
  std::function<core::CameraPose(Session&, double)> camera;
  std::filesystem::path out_folder;  // empty: only pictures, here
  // Both 0: as long as the path; without one 27 s headless, else until the window is closed. Where
  // one is given a window closes at the end of the flight, otherwise it stays.
  double seconds = 0;
  std::uint64_t frames = 0;
  double fixed_step_hz = 0;        // 0: the flight follows the wall clock
  std::uint64_t images_every = 0;  // every Nth frame as a PNG; 0: none
  bool loop = false;               // the path again and again
  double warmup_seconds = 1;       // left out of all figures
  bool hash_world = true;          // hash.world of the summary (some 50 ms)
};

}  // namespace psygen::app
