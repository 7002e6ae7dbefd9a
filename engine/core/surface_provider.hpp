// Where pictures go: something that can make a Vulkan surface without this header knowing Vulkan.
// platform implements it over GLFW, an editor over its own window system; headless rendering has
// none. Seam between platform and render. Main thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::core {

struct Extent {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  friend bool operator==(const Extent&, const Extent&) = default;
};

class SurfaceProvider {
 public:
  virtual ~SurfaceProvider() = default;
  virtual std::vector<std::string> required_instance_extensions() const = 0;
  // `instance` is a VkInstance; the result is a VkSurfaceKHR, owned by the caller.
  virtual Result<std::uint64_t> create_surface(void* instance) = 0;
  // Size in pixels; 0 × 0 while minimised.
  virtual Extent framebuffer_size() const = 0;
};

}  // namespace psygen::core
