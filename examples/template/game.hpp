// The game without window and loop: main.cpp plays it, frame_test.cpp flies through it. A walker in
// the world of world.toml, with a counter of the distance walked.
#pragma once

#include <optional>

#include "engine/app/session.hpp"
#include "engine/input/actions.hpp"
#include "engine/physics/world.hpp"
#include "engine/query/world.hpp"
#include "engine/telemetry/own_figures.hpp"

class Game {
 public:
  // Returns the options of a session that runs this game. The game must outlive the session.
  psygen::core::Result<psygen::app::SessionOptions> options();
  // Call once, before the first frame.
  psygen::core::Result<void> start(psygen::app::Session& session);

  // Returns the walker's eyes, interpolated between the last two steps; `share` is 0 to 1.
  psygen::core::CameraPose eyes(double share) const;
  // Call once per frame. Updates the HUD, and opens the menu when Escape is pressed.
  void write_hud(psygen::app::Session& session);

 private:
  psygen::core::Result<void> add_figures(psygen::scene::Systems& systems);
  psygen::core::Result<void> add_actions(psygen::input::Actions& actions);
  void step(psygen::app::Session& session, double step_s);
  void draw_menu(psygen::app::Session& session);
  void open_menu(psygen::app::Session& session, bool open);

  std::optional<psygen::query::World> query_;
  std::optional<psygen::physics::World> physics_;
  psygen::physics::CharacterId walker_;
  glm::dvec3 moved_{0.0};  // metres, in the last step
  double yaw_ = 0, pitch_ = 0, way_m_ = 0;
  float mouse_ = 1;  // mouse sensitivity, set in the menu
  bool menu_ = false;
  psygen::telemetry::OwnFigure physics_ms_;  // in frames.csv, reports and budgets
  bool landed_ = false;                      // the walker begins in the air
  psygen::input::ActionId ahead_ = 0, aside_ = 0, run_ = 0, jump_ = 0, look_x_ = 0, look_y_ = 0;
};
