// Cairns in a session: title, a game, pages over it, sounds, saves. The rules are in play/, what is
// seen and heard in show/; this joins them with a session of the engine. main.cpp has the loop,
// which also drives it without a window. Main thread; a new land is found in another.
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
  std::string seed;       // of a game that begins at once; empty: the title
  bool autoplay = false;  // the pilot plays
  bool headless = false;
  std::filesystem::path folder;          // of saves and settings; empty: those of the user
  std::filesystem::path record, replay;  // files of input; empty: none
  std::optional<render::Preset> preset;  // else as the settings say
  core::Extent size{1280, 720};
  bool sound = true, virtual_time = false;
  unsigned modelers = 0;
};

class Game {
 public:
  explicit Game(GameOptions options) : options_(std::move(options)) {}

  // The options of a session with this game in it, which must outlive the session. Fails for
  // folders that cannot be made and for a land that cannot be read.
  core::Result<app::SessionOptions> session_options();
  // Once, before the first frame. Fails where a game that begins at once cannot be loaded.
  core::Result<void> start(app::Session& session);
  // Before every tick: pages, what is drawn over the picture, sounds. Returns the camera. `dt_s`:
  // real seconds since the last frame.
  core::CameraPose frame(app::Session& session, double dt_s);
  // After the last: saves, and writes what was recorded. Fails as Saved::put(), and for a recording
  // that cannot be written.
  core::Result<void> end();

  Page page() const { return menu_.page; }
  const Play* play() const { return lands_ ? lands_->play.get() : nullptr; }

 private:
  // A land with a game in it, made in a thread of its own.
  struct Loaded {
    std::unique_ptr<Land> land;  // outlives the game
    std::unique_ptr<Play> play;
  };
  // With more than one try, a seed whose land has no way for cairns gives way to the next.
  static core::Result<Loaded> load(std::uint64_t seed, int tries = 1);
  void load_later(std::uint64_t seed, int tries);
  core::Result<void> begin(app::Session& session, Loaded loaded);
  void step(app::Session& session, double dt);
  void keep_up(app::Session& session, double dt_s);
  void choose(app::Session& session, Choice choice);
  void open_page(app::Session& session, Page page);
  void take_keys(app::Session& session);
  void apply_settings(app::Session& session);
  core::Result<void> save();
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
  std::vector<std::future<core::Result<Loaded>>> dropped_;  // lands that nobody waits for
  std::optional<input::Recording> recording_;
  std::shared_ptr<const models::EditLayer> shown_edits_;
  Page shown_page_ = Page::kTitle;
  double until_save_s_ = 0, title_s_ = 0, title_height_m_ = 0;
  int picture_in_ = 0;   // frames until a picture is taken; 0: none is
  int quiet_steps_ = 0;  // in which a press that closed a page is not one of the game
  bool zoom_ = false, settings_broken_ = false;
  glm::dvec2 photo_turn_{0.0};
  std::optional<query::World> title_query_;  // of the land behind the title
  core::WorldPosition title_place_;
};

}  // namespace cairns
