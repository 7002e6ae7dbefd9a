// The game without its window and its loop: main.cpp plays it, frame_test.cpp flies through it. One
// walker in the world of world.toml, who counts his way.
#pragma once

#include <optional>

#include "engine/app/session.hpp"
#include "engine/input/actions.hpp"
#include "engine/physics/world.hpp"
#include "engine/query/world.hpp"

class Game {
 public:
  // The options of a session with this game in it, which must outlive the session.
  psygen::core::Result<psygen::app::SessionOptions> options();
  // Once, before the first frame.
  psygen::core::Result<void> start(psygen::app::Session& session);

  // The eyes of the walker, `share` of a step after the last but one. Camera of the next frame.
  psygen::core::CameraPose eyes(double share) const;
  // Writes over the next picture, and opens the menu when Escape was pressed. Once a frame.
  void write_hud(psygen::app::Session& session);

 private:
  psygen::core::Result<void> add_actions(psygen::input::Actions& actions);
  void step(psygen::app::Session& session, double step_s);
  void draw_menu(psygen::app::Session& session);
  void open_menu(psygen::app::Session& session, bool open);

  std::optional<psygen::query::World> query_;
  std::optional<psygen::physics::World> physics_;
  psygen::physics::CharacterId walker_;
  psygen::core::WorldPosition feet_, feet_before_;  // of the last step and the one before
  double yaw_ = 0, pitch_ = 0, way_m_ = 0;
  float mouse_ = 1;  // how fast the view turns, from the menu
  bool menu_ = false;
  psygen::input::ActionId ahead_ = 0, aside_ = 0, run_ = 0, jump_ = 0, look_x_ = 0, look_y_ = 0;
};
