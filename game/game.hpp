// Cairns in a session: title screen, game, menu pages, sounds and saves. The rules are in play/,
// the presentation in show/; this class connects both with a session of the engine. The loop is in
// main.cpp and also runs without a window. Main thread only; a second thread creates new lands.
#pragma once

#include <future>
#include <memory>
#include <optional>

#include "engine/app/session.hpp"
#include "engine/input/recording.hpp"
#include "game/pilot/pilot.hpp"
#include "game/play/saved.hpp"
#include "game/show/hud.hpp"
#include "game/show/menu.hpp"
#include "game/show/scenery.hpp"
#include "game/show/sounds.hpp"

namespace cairns {

struct GameOptions {
  std::string seed;       // land to start in; empty: show the title screen
  bool autoplay = false;  // the autopilot plays
  bool headless = false;
  std::filesystem::path folder;          // saves and settings; empty: the user's folders
  std::filesystem::path record, replay;  // input recordings; empty: none
  std::optional<render::Preset> preset;  // overrides the settings
  core::Extent size{1280, 720};
  bool sound = true, virtual_time = false;
  unsigned modelers = 0;
};

class Game {
 public:
  explicit Game(GameOptions options) : options_(std::move(options)) {}

  // Returns the options of a session that runs this game. The game must outlive the session. Fails
  // if a folder cannot be created or the land cannot be read.
  core::Result<app::SessionOptions> session_options();
  // Call once, before the first frame. Fails if the land named in the options cannot be loaded.
  core::Result<void> start(app::Session& session);
  // Call before every tick. Updates pages, HUD and sounds, and returns the camera pose. `dt_s`:
  // real seconds since the last frame.
  core::CameraPose frame(app::Session& session, double dt_s);
  // Call when the session is over. Returns true if the program may end: the game is saved, there is
  // none, or the player wants to quit without saving. Otherwise keeps the session open, and the
  // pause page asks.
  bool may_end(app::Session& session);
  // Call after the last frame. Saves the game and writes the input recording. Fails like
  // Saved::put(), with the seconds that are lost, or if the recording cannot be written.
  core::Result<void> end();

  Page page() const { return menu_.page; }
  const Play* play() const { return lands_ ? lands_->play.get() : nullptr; }

 private:
  // A land with its game, created on a worker thread.
  struct Loaded {
    std::unique_ptr<Land> land;  // outlives the game
    std::unique_ptr<Play> play;
  };
  // Tries up to `tries` consecutive seeds until a land has a route for all cairns.
  static core::Result<Loaded> load(std::uint64_t seed, int tries = 1);
  void load_later(std::uint64_t seed, int tries);
  core::Result<void> begin(app::Session& session, Loaded loaded);
  void step(app::Session& session, double dt);
  void sync_presentation(app::Session& session, double dt_s);
  void choose(app::Session& session, Choice choice);
  void open_page(app::Session& session, Page page);
  void take_keys(app::Session& session);
  void apply_settings(app::Session& session);
  core::Result<void> save();
  void note_outcome(const core::Result<void>& outcome);
  core::Result<void> save_now();
  bool save_and_leave();
  core::CameraPose playing(app::Session& session, double dt_s);
  void take_picture(app::Session& session);
  core::CameraPose title_camera(app::Session& session, double dt_s);

  GameOptions options_;
  std::filesystem::path saves_, config_;
  std::uint64_t seed_ = 0;
  Settings settings_;
  Menu menu_;
  Hud hud_;
  Scenery scenery_;
  std::optional<Sounds> sounds_;
  std::optional<Loaded> lands_;
  std::optional<Saved> saved_;
  std::optional<Pilot> pilot_;
  std::future<core::Result<Loaded>> loading_;
  std::vector<std::future<core::Result<Loaded>>> dropped_;  // abandoned loads
  std::optional<input::Recording> recording_;
  std::shared_ptr<const models::EditLayer> shown_edits_;
  Page shown_page_ = Page::kTitle;
  double unsaved_s_ = 0,
         unsaved_at_put_s_ = 0;  // playing time since the last save; at Saved::put()
  double until_save_s_ = 0, title_s_ = 0, title_height_m_ = 0;
  int picture_in_ = 0;   // frames until a screenshot is saved; 0: none pending
  int quiet_steps_ = 0;  // steps that ignore presses, because they closed a page
  bool zoom_ = false, settings_broken_ = false;
  bool is_settled_ = false;  // the game is saved for the end, or given up
  glm::dvec2 photo_turn_{0.0};
  std::optional<query::World> title_query_;  // of the land behind the title screen
  core::WorldPosition title_place_;
};

}  // namespace cairns
