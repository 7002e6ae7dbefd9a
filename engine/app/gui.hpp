// Dear ImGui in a session: menus and tools that a game draws over the picture, in a window or
// headless. Owns one ImGui context; drawing is the renderer's overlay. Code that draws includes
// imgui.h itself, between begin() and end() (Session does both). Main thread only; costs nothing
// while nobody draws.
#pragma once

#include <string>

#include "engine/core/surface_provider.hpp"
#include "engine/platform/input.hpp"

struct ImDrawData;
struct ImFontAtlas;
struct ImGuiContext;

namespace psygen::platform {
class Window;
}

namespace psygen::app {

class Gui {
 public:
  static constexpr float kTextPx = 16;  // at scale 1

  // `atlas` is the renderer's, `window`, for the clipboard, may be null; both outlive this.
  Gui(ImFontAtlas& atlas, platform::Window* window);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  // Begins a frame: makes the context the current one and gives it what the user did. `scale` is
  // that of text and controls, dt_s the real seconds since the last frame.
  void begin(const platform::InputState& input, core::Extent picture, float scale, double dt_s);
  // Ends it. The draw data is valid until the next begin().
  const ImDrawData* end();

  // Whether ImGui takes keyboard and text, or the mouse, of the next input: a text field has the
  // keyboard, or the pointer is over a window.
  bool takes_keyboard() const;
  bool takes_mouse() const;
  // For programs with an ImGui of their own, in another library: ImGui::SetCurrentContext().
  ImGuiContext* context() { return context_; }

 private:
  static const char* read_clipboard(void* self);
  static void write_clipboard(void* self, const char* text);

  ImGuiContext* context_;
  platform::Window* window_;
  std::string clipboard_;   // what ImGui read last
  float styled_scale_ = 0;  // the style was made for it
};

}  // namespace psygen::app
