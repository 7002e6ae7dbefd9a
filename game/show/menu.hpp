// The pages over the picture: title, pause, settings, map, photo, credits. Drawn with Dear ImGui,
// by keyboard, mouse or pad. It changes settings and says what was chosen; it does nothing itself.
#pragma once

#include <optional>
#include <string>

#include "engine/app/session.hpp"
#include "engine/input/binding_capture.hpp"
#include "game/play/play.hpp"
#include "game/show/controls.hpp"
#include "game/show/settings.hpp"

namespace cairns {

enum class Page : std::uint8_t { kTitle, kNone, kPause, kSettings, kMap, kPhoto, kCredits };
// What the player chose; for kNew the seed is Menu::seed.
enum class Choice : std::uint8_t { kNothing, kContinue, kNew, kToTitle, kSave, kPicture, kQuit };

// How a photo is taken.
struct Photo {
  float hour = 12, fov_deg = 60;
  int filter = 0;  // of kFilters
};
struct Filter {
  const char* name;
  glm::vec4 colour;  // laid over the picture
};
inline constexpr std::array<Filter, 4> kFilters{{{"none", {0, 0, 0, 0}},
                                                 {"warm", {1.0F, 0.62F, 0.25F, 0.14F}},
                                                 {"cold", {0.25F, 0.5F, 0.9F, 0.14F}},
                                                 {"old", {0.48F, 0.38F, 0.24F, 0.32F}}}};

class Menu {
 public:
  Page page = Page::kTitle;
  std::string seed;     // as typed
  std::string message;  // of what went wrong, until another page is opened
  Photo photo;
  bool can_continue = false, busy = false;  // a game was saved; a land is being made
  bool settings_changed = false;

  // Draws the page. `play` may be null.
  Choice draw(app::Session& session, const Play* play, Settings& settings);

 private:
  Choice draw_title();
  Choice draw_pause();
  void draw_settings(app::Session& session, Settings& settings);
  void draw_keys(app::Session& session);
  void draw_map(const Play& play, const app::Session& session);
  Choice draw_photo();
  void draw_credits();
  void open(Page next);
  bool goes_back(const platform::InputState& input) const;
  void heading(const char* words, float size) const;
  bool button(const char* label);

  Page drawn_ = Page::kNone;    // in the last frame
  Page before_ = Page::kTitle;  // to which settings and credits go back
  std::optional<input::BindingCapture> capture_;
  std::size_t captured_ = 0;
  float text_ = 1;  // Settings::text
};

}  // namespace cairns
