// Where pictures are shown: something that can create a Vulkan surface, without this header knowing
// Vulkan. platform implements it over GLFW, an editor over its own window system; headless
// rendering has none. The interface between platform and render. Main thread.
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
  // Its surfaces must be destroyed before.
  virtual ~SurfaceProvider() = default;
  // Names of the Vulkan instance extensions that create_surface needs.
  virtual std::vector<std::string> required_instance_extensions() const = 0;
  // `instance` is a VkInstance with these extensions. The result is a VkSurfaceKHR that the caller
  // owns.
  virtual Result<std::uint64_t> create_surface(void* instance) = 0;
  // The present size in pixels; 0 × 0 while minimised.
  virtual Extent framebuffer_size() const = 0;
};

}  // namespace psygen::core
