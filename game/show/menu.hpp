// The menu pages: title, pause, settings, map, photo mode and credits. Drawn with Dear ImGui, used
// by keyboard, mouse or gamepad. The menu changes settings and returns the player's choice; the
// caller acts on it.
#pragma once

#include <optional>
#include <string>

#include "engine/app/session.hpp"
#include "engine/input/control.hpp"
#include "game/play/play.hpp"
#include "game/show/controls.hpp"
#include "game/show/settings.hpp"

namespace cairns {

enum class Page : std::uint8_t { kTitle, kNone, kPause, kSettings, kMap, kPhoto, kCredits };
// The player's choice. For kNew the seed is Menu::seed.
enum class Choice : std::uint8_t {
  kNothing,
  kContinue,
  kNew,
  kToTitle,
  kSave,
  kPicture,
  kQuit,
  kAbandon
};

// Settings of the photo mode.
struct Photo {
  float hour = 12, fov_deg = 60;
  int filter = 0;  // index into kFilters
};
struct Filter {
  const char* name;
  glm::vec4 colour;  // blended over the image
};
inline constexpr std::array<Filter, 4> kFilters{{{"none", {0, 0, 0, 0}},
                                                 {"warm", {1.0F, 0.62F, 0.25F, 0.14F}},
                                                 {"cold", {0.25F, 0.5F, 0.9F, 0.14F}},
                                                 {"old", {0.48F, 0.38F, 0.24F, 0.32F}}}};

class Menu {
 public:
  Page page = Page::kTitle;
  std::string seed;     // as typed
  std::string message;  // error message, until another page opens
  Photo photo;
  bool can_continue = false, busy = false;  // a save exists; a land is being created
  bool cannot_save = false;                 // the pause page offers to quit without saving
  bool settings_changed = false;

  // Draws the page and returns the player's choice. `play` may be null.
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

  Page drawn_ = Page::kNone;    // page of the last frame
  Page before_ = Page::kTitle;  // page to return to from settings and credits
  std::optional<input::BindingCapture> capture_;
  std::size_t captured_ = 0;
  bool enter_ = false;  // Enter went down in this frame
  float text_ = 1;      // Settings::text
};

}  // namespace cairns
