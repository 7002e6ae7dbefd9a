// A creator of Vulkan surfaces, declared without Vulkan. Platform implements it over GLFW, the
// editor over its own window system; headless rendering has none. The interface between platform
// and render. Main thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::core {

// A size in pixels.
struct Extent {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  friend bool operator==(const Extent&, const Extent&) = default;
};

// Must outlive the surfaces that it created.
class SurfaceProvider {
 public:
  // The surfaces must be destroyed before their provider.
  virtual ~SurfaceProvider() = default;
  // Names of the Vulkan instance extensions that create_surface() needs.
  virtual std::vector<std::string> required_instance_extensions() const = 0;
  // Creates a surface for `instance`, a VkInstance with these extensions. Returns a VkSurfaceKHR
  // that the caller owns.
  virtual Result<std::uint64_t> create_surface(void* instance) = 0;
  // Current size in pixels; 0 × 0 while minimised.
  virtual Extent framebuffer_size() const = 0;
};

}  // namespace psygen::core
