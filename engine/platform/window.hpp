// A window with keyboard and mouse, over GLFW, which stays hidden here and is initialised only when
// a window is created: headless runs never touch a window system. Vulkan is known as opaque
// handles only. Main thread.
#pragma once

#include <memory>
#include <string>

#include "engine/core/surface_provider.hpp"
#include "engine/platform/input.hpp"

namespace psygen::platform {

struct WindowSettings {
  std::string title = "psygen";
  core::Extent size{1280, 720};  // in screen coordinates, each at least 1
  bool visible = true;
};

class Window final : public core::SurfaceProvider {
 public:
  // Fails with kNoDevice when there is no display, in one sentence.
  static core::Result<std::unique_ptr<Window>> create(const WindowSettings& settings);
  ~Window() override;  // surfaces made from it must be gone
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  std::vector<std::string> required_instance_extensions() const override;
  core::Result<std::uint64_t> create_surface(void* instance) override;
  core::Extent framebuffer_size() const override;

  // Handles everything that happened and tells what it was. Call once per frame.
  InputState poll();
  // Handles everything that happened, for while the program is busy; the next poll() tells what it
  // was.
  void keep_alive();
  // Sleeps until something happens, at most `timeout_s` seconds; the next poll() tells what it was.
  // For windows that are minimised, so that they do not spin.
  void wait_events(double timeout_s);

  // The person asked to close the window, or request_close() did.
  bool should_close() const;
  void request_close();
  bool minimised() const;

  // Covers the monitor that shows most of the window, in the monitor's present mode; leaving that
  // brings the window back to its size and place. Fails with kNoDevice where the window system has
  // no monitor; then the window stays as it is.
  core::Result<void> set_fullscreen(bool fullscreen);
  bool fullscreen() const;
  // Pixels per unit that text and controls are drawn with: 1 on usual displays, 2 on fine ones.
  float content_scale() const;

  void set_title(const std::string& title);
  void set_size(core::Extent size);  // in screen coordinates
  void minimise();
  void restore();

 private:
  struct Implementation;
  explicit Window(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace psygen::platform
