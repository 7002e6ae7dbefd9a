// The surface of a Qt window, for the engine's renderer: Vulkan over X11. Draws nothing and holds
// no Vulkan objects. Main thread.
#pragma once

#include <string>
#include <vector>

#include "engine/core/surface_provider.hpp"

class QWindow;

namespace psygen::editor {

class WindowSurface final : public core::SurfaceProvider {
 public:
  // The window has the surface type VulkanSurface, and outlives this.
  explicit WindowSurface(QWindow& window) : window_(window) {}

  std::vector<std::string> required_instance_extensions() const override;
  // Fails with kNoDevice where Qt does not draw through X11, or the driver makes no surface.
  core::Result<std::uint64_t> create_surface(void* instance) override;
  // In device pixels; 0 × 0 while nobody can see the window.
  core::Extent framebuffer_size() const override;

 private:
  QWindow& window_;
};

}  // namespace psygen::editor
