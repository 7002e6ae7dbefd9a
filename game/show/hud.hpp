// The HUD: compass, available action, inventory, and messages of the story. Reads the game. Main
// thread only.
#pragma once

#include <string>

#include "engine/app/session.hpp"
#include "engine/render/hud_drawing.hpp"
#include "game/play/play.hpp"
#include "game/show/settings.hpp"

namespace cairns {

class Hud {
 public:
  // Shows a message for some seconds. The next message replaces it.
  void say(std::string line, std::string help = {}, double seconds = 3);
  void tell(const Happening& happening);
  // Call once a frame. `zoom`: the spyglass is in use.
  render::HudDrawing draw(const Play& play, app::Session& session, const Settings& settings,
                          bool zoom, double dt_s);

 private:
  void draw_compass(const Play& play, bool zoom);
  void draw_doing(const Play& play, app::Session& session);
  void draw_line(double dt_s);
  void write(std::string text, const render::HudPlace& at, float size_px, float opacity = 1,
             render::HudAlign align = render::HudAlign::kCentre);
  void bar(const render::HudPlace& at, double share);

  render::HudDrawing drawing_;
  std::string line_, help_;
  double left_s_ = 0;
  float size_ = 1;
  glm::vec4 mark_{1.0F};
};

}  // namespace cairns
