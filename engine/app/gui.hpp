// Dear ImGui in a session: menus and tools that a game draws over the image, in a window or
// headless. Owns one ImGui context; the renderer's overlay draws it. Drawing code includes imgui.h
// itself and runs in draw() (Session calls it). Main thread only; costs nothing if unused.
#pragma once

#include <functional>
#include <string>

#include "engine/core/error.hpp"
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

  // `atlas` belongs to the renderer. `window` provides the clipboard and may be null. Both outlive
  // this.
  Gui(ImFontAtlas& atlas, platform::Window* window);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  // Begins a frame: makes the context current and passes the user's input. `scale` applies to text
  // and controls; dt_s is the real time in seconds since the last frame.
  void begin(const platform::InputState& input, core::Extent picture, float scale, double dt_s);
  // Runs drawing code between begin() and end(). Fails with kInternal if the code leaves something
  // open (the message names the missing call), or if an assertion of ImGui, or of the code, aborts:
  // the code then ends there without its destructors, and stderr has the assertion. After an error
  // or an exception, which passes through, all is closed and the frame has ended without draw data.
  // After an abort the context may be beyond repair: draw no more with it.
  core::Result<void> draw(const std::function<void()>& code);
  // Ends the frame. The draw data is valid until the next begin().
  const ImDrawData* end();

  // True if ImGui uses the keyboard and text, or the mouse, of the next input: a text field has the
  // keyboard focus, or the pointer is over a window.
  bool takes_keyboard() const;
  bool takes_mouse() const;
  // For programs with another ImGui library instance: ImGui::SetCurrentContext().
  ImGuiContext* context() { return context_; }

 private:
  static const char* read_clipboard(void* self);
  static void write_clipboard(void* self, const char* text);

  ImGuiContext* context_;
  platform::Window* window_;
  std::string clipboard_;   // last text read by ImGui
  float styled_scale_ = 0;  // scale of the current style
};

}  // namespace psygen::app
