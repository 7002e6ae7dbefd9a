// The Vulkan surface of a Qt window for the engine's renderer, on Wayland and X11. Draws nothing
// and owns no Vulkan objects. Main thread.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/core/surface_provider.hpp"

class QWindow;

namespace psygen::editor {

// Fails with kNoDevice unless Qt will use Wayland or X11 and its display can be opened: otherwise
// QApplication aborts, or the view cannot draw. Chooses Wayland, then X11, if the user has chosen
// no platform. To be called before QApplication, with the arguments of the program. Keep the result
// until QApplication has connected: some servers (Xvfb) reset when their last client leaves, and
// refuse new ones meanwhile.
core::Result<std::shared_ptr<void>> require_display(std::span<const char* const> arguments);

// True if QApplication runs on Wayland. There, Qt destroys its side of a surface when it hides the
// window, and presenting with vertical sync blocks while the compositor does not show the window.
bool runs_on_wayland();

class WindowSurface final : public core::SurfaceProvider {
 public:
  // The window has the surface type VulkanSurface, and outlives this.
  explicit WindowSurface(QWindow& window) : window_(window) {}

  std::vector<std::string> required_instance_extensions() const override;
  // Fails with kNoDevice if Qt runs on another platform or the driver cannot create the surface.
  core::Result<std::uint64_t> create_surface(void* instance) override;
  // In device pixels; 0 × 0 while the window is hidden.
  core::Extent framebuffer_size() const override;

 private:
  QWindow& window_;
};

}  // namespace psygen::editor
