// A window with keyboard, mouse and gamepads, over GLFW. Only this file's source includes GLFW, and
// it initialises GLFW only when a window is created: headless runs never use a window system.
// Vulkan appears only as opaque handles. Not a renderer. Main thread.
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

// Owns its window; the last window terminates GLFW.
class Window final : public core::SurfaceProvider {
 public:
  // Opens a window. Fails with kNoDevice if there is no display.
  static core::Result<std::unique_ptr<Window>> create(const WindowSettings& settings);
  // Closes the window. Surfaces created from it must already be destroyed.
  ~Window() override;
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  // See SurfaceProvider. The names are empty if GLFW finds no Vulkan; create_surface then fails
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

  // Hides the pointer and confines it to the window: edges do not stop movement, and
  // InputState::captured and looking are set. Released by capture_cursor(false), not by any key.
  void capture_cursor(bool captured);
  bool cursor_captured() const;
  // Lets gamepads act while another window has the focus; off by default.
  void set_background_gamepads(bool listens);
  // Reports a captured mouse's motion without the desktop's acceleration, where the system supports
  // it; on by default.
  void set_raw_mouse_motion(bool raw);
  // Adds mappings of gamepads in SDL's format (gamecontrollerdb.txt), one per line, for all
  // windows. Returns false for a text with errors. create() adds those of the environment variable
  // SDL_GAMECONTROLLERCONFIG.
  static bool add_gamepad_mappings(const std::string& text);
  // Lets the right button look around while it is held (InputState::looking), for the fly camera;
  // on by default. Games that use the button otherwise switch this off.
  void set_right_button_looks(bool looks);

  // The label on a key's cap in the user's layout: "Z" for Key::kY on a German keyboard. The key's
  // name if the layout has no label for it.
  std::string label_of(Key key) const;
  // The name of the gamepad in a slot of InputState::pads; empty without one.
  std::string gamepad_name(std::size_t slot) const;
  // The text of the clipboard, UTF-8; empty if there is none.
  std::string clipboard() const;
  void set_clipboard(const std::string& text);

  // True if the user asked to close the window, or request_close() was called.
  bool should_close() const;
  void request_close();
  // Forgets a request to close.
  void cancel_close();
  // True if the window is minimised.
  bool minimised() const;

  // Covers the monitor that shows the largest part of the window, in the monitor's current mode;
  // leaving full screen restores size and position. Fails with kNoDevice, without a change, if the
  // window system has no monitor.
  core::Result<void> set_fullscreen(bool fullscreen);
  // True if the window covers a monitor.
  bool fullscreen() const;
  // Pixels per unit of text and controls: 1 on standard displays, 2 on high-density ones.
  float content_scale() const;

  // Set the title (UTF-8) and the size (in screen coordinates, each at least 1).
  void set_title(const std::string& title);
  void set_size(core::Extent size);
  // Minimises the window; restores it.
  void minimise();
  void restore();

 private:
  struct Implementation;
  explicit Window(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace psygen::platform
