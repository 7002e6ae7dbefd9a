// A window with keyboard, mouse and gamepads, over GLFW. GLFW stays hidden here and is initialised
// only when a window is created: headless runs never touch a window system. Vulkan appears only as
// opaque handles. Not a renderer. Main thread.
#pragma once

#include <memory>
#include <string>

#include "engine/core/surface_provider.hpp"
#include "engine/platform/input.hpp"

namespace psygen::platform {

// The window to create.
struct WindowSettings {
  std::string title = "psygen";
  core::Extent size{1280, 720};  // in screen coordinates, each at least 1
  bool visible = true;
};

// Owns its window; the last window ends GLFW.
class Window final : public core::SurfaceProvider {
 public:
  // Opens a window. Fails with kNoDevice when there is no display.
  static core::Result<std::unique_ptr<Window>> create(const WindowSettings& settings);
  // Closes the window. Surfaces created from it must be destroyed before.
  ~Window() override;
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  // As in SurfaceProvider. The names are empty where GLFW finds no Vulkan; create_surface fails
  // with kNoDevice.
  std::vector<std::string> required_instance_extensions() const override;
  core::Result<std::uint64_t> create_surface(void* instance) override;
  core::Extent framebuffer_size() const override;

  // Handles all pending events and returns the input since the last poll. Call it once per frame.
  InputState poll();
  // Handles all pending events while the program is busy; the next poll() returns their input.
  void keep_alive();
  // Sleeps until an event arrives, at most `timeout_s` seconds; the next poll() returns the input.
  // For minimised windows, which must not busy-wait. Returns at once unless timeout_s is finite and
  // above 0.
  void wait_events(double timeout_s);

  // Hides the pointer and keeps it in the window: movement is not stopped by an edge, and
  // InputState::captured and looking are set. Released by capture_cursor(false), not by any key.
  void capture_cursor(bool captured);
  bool cursor_captured() const;
  // Whether the right button looks around while it is held (InputState::looking), as the fly camera
  // wants it; on at first. Games that use the button for something else switch it off.
  void set_right_button_looks(bool looks);

  // What a key's cap shows in the user's layout: "Z" for Key::kY on a German keyboard. The key's
  // name where the layout has none for it.
  std::string label_of(Key key) const;
  // The name of a gamepad in a slot of InputState::pads; empty without one.
  std::string gamepad_name(std::size_t slot) const;
  // The text of the clipboard, UTF-8; empty where there is none.
  std::string clipboard() const;
  void set_clipboard(const std::string& text);

  // True when the user asked to close the window, or request_close() did.
  bool should_close() const;
  void request_close();
  // Whether the window is minimised.
  bool minimised() const;

  // Covers the monitor that shows most of the window, in the monitor's current mode; leaving full
  // screen restores size and place. Fails with kNoDevice when the window system has no monitor; the
  // window then stays as it is.
  core::Result<void> set_fullscreen(bool fullscreen);
  // Whether the window covers a monitor.
  bool fullscreen() const;
  // Pixels per unit of text and controls: 1 on usual displays, 2 on high-density ones.
  float content_scale() const;

  // Set the title (UTF-8) and the size (in screen coordinates, each at least 1).
  void set_title(const std::string& title);
  void set_size(core::Extent size);
  // Minimise the window, and bring it back.
  void minimise();
  void restore();

 private:
  struct Implementation;
  explicit Window(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace psygen::platform
